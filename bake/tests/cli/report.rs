//! The page of `bake --report`.

use crate::support::Folder;

fn page(folder: &Folder) -> String {
    String::from_utf8(folder.read("page/index.html")).expect("text")
}

#[test]
fn a_page_shows_motion_places_regions_and_sizes_and_loads_nothing() {
    let folder = Folder::new("page");
    if !folder.fox() {
        return;
    }
    folder.good("bake fox.glb -o fox.sinew --report page");
    let page = page(&folder);
    for heading in
        ["<h1>fox</h1>", "In motion: Walk", "Where the flesh is", "Regions", "What the asset holds"]
    {
        assert!(page.contains(heading), "{heading} is missing");
    }
    assert_eq!(page.matches("data:image/gif;base64,").count(), 1, "one moving picture");
    assert_eq!(page.matches("data:image/png;base64,").count(), 3 + 3 + 3, "moments, softness, regions");
    assert_eq!(page.matches("<svg").count(), 3, "offsets, softness, responses");
    for clip in ["Survey", "Walk", "Run"] {
        assert!(page.contains(&format!("<td>{clip}</td>")), "{clip} is in the table of clips");
    }
    let rest = page.replace("http://www.w3.org/2000/svg", "");
    for outside in ["http", "<script", "<link", "url(", "@import"] {
        assert!(!rest.contains(outside), "the page loads nothing: {outside}");
    }
    let hash = folder.good("inspect fox.sinew --json").json()["hash"].as_str().expect("a hash").to_owned();
    assert!(page.contains(&hash), "the page tells which asset it is about");
}

#[test]
fn characters_without_clips_and_without_flesh_have_a_page_too() {
    let folder = Folder::new("page-bare");
    if !folder.fetch("godette-vrm/Godette_vrm_v4.vrm", "g.vrm") {
        return;
    }
    folder.good("bake g.vrm -o g.sinew --report page");
    let shaken = page(&folder);
    assert!(shaken.contains("In motion: built-in shake") && shaken.contains("VRM spring bones"), "a note");
    folder.write("rigid.toml", "softness = 0.0");
    folder.good("bake builtin -o p.sinew --recipe rigid.toml --report page");
    let rigid = page(&folder);
    assert!(rigid.contains("No flesh was found"), "the summary says so");
    let texts = rigid.split("base64,").map(|part| part.split_once('"').map_or(part, |(_, rest)| rest));
    let texts: String = texts.collect();
    assert!(!texts.contains("NaN") && !texts.contains("inf%") && !texts.contains(">inf"), "{texts}");
}
