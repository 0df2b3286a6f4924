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
fn a_character_without_clips_is_shaken_and_notes_are_told() {
    let folder = Folder::new("page-shaken");
    if !folder.fetch("vrm1-springbone/swing_springbone_stiffness_0p2.vrm", "swing.vrm") {
        return;
    }
    folder.good("bake swing.vrm -o swing.sinew --report page");
    let page = page(&folder);
    assert!(page.contains("In motion: built-in shake") && page.contains("It has no clips"), "it is shaken");
    assert!(page.contains("<h2>Notes</h2>") && page.contains("VRM spring bones"), "what the recipe noted");
}

#[test]
fn a_character_without_flesh_has_a_page_too() {
    let folder = Folder::new("page-rigid");
    if !folder.fox() {
        return;
    }
    folder.write("rigid.toml", "softness = 0.0");
    folder.good("bake fox.glb -o p.sinew --recipe rigid.toml --report page");
    let page = page(&folder);
    assert!(page.contains("No flesh was found"), "the summary says so");
    let texts = page.split("base64,").map(|part| part.split_once('"').map_or(part, |(_, rest)| rest));
    let texts: String = texts.collect();
    assert!(!texts.contains("NaN") && !texts.contains("inf%") && !texts.contains(">inf<"), "{texts}");
}
