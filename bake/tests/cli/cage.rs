//! `sinew cage`.

use crate::support::Folder;
use serde_json::Value;

#[test]
fn a_cage_is_written_with_a_page_and_numbers() {
    let folder = Folder::new("cage");
    if !folder.fox() {
        return;
    }
    let ran = folder.good("cage fox.glb --vertices 600 -o cage.glb --report page --json");
    let json = ran.json();
    let number = |name: &str| json[name].as_u64().expect("a count");
    assert!((480..=600).contains(&number("nodes")) && number("components") == 1, "{json}");
    assert_eq!(number("fixed") + number("springs") + number("free"), number("nodes"));
    let page = String::from_utf8(folder.read("page/index.html")).expect("text");
    for heading in ["The cage of fox", "Skin and cage", "What follows the bones", "Skin weights"] {
        assert!(page.contains(heading), "{heading} is missing");
    }
    assert_eq!(page.matches("data:image/png;base64,").count(), 21, "pictures");
    let glb = folder.read("cage.glb");
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    let lines = &json["meshes"][1]["primitives"][0];
    assert_eq!(lines["mode"], 1, "edges are lines");
    let place = lines["attributes"]["POSITION"].to_string();
    assert_eq!(
        json.pointer(&format!("/accessors/{place}/count")),
        Some(&number("nodes").into()),
        "all nodes"
    );
}

#[test]
fn the_edge_can_be_chosen_and_bad_ones_are_refused() {
    let folder = Folder::new("cage-edge");
    if !folder.fox() {
        return;
    }
    let json = folder.good("cage fox.glb --size 6 --apart -o cage.glb --json").json();
    assert_eq!(json["edge"], 6.0);
    let fitted = folder.good("cage fox.glb --size 6 --fit -o cage.glb --json").json();
    assert!(fitted["volume"].as_f64() < json["volume"].as_f64(), "closer to the skin: {fitted}");
    folder.line("cage fox.glb --size 0.001 -o no.glb").refused(&["fox", "too small", "ask for an edge of"]);
    folder.line("cage fox.glb --vertices 5 -o no.glb").refused(&["fox", "no cage has 5 nodes"]);
    assert_eq!(folder.line("cage fox.glb --size 1 --vertices 5 -o no.glb").code, Some(2), "one of them");
    assert!(!folder.names().contains(&"no.glb".to_owned()));
}
