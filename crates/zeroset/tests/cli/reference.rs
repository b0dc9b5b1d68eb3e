//! `zeroset fields`.

use crate::run::Folder;

#[test]
fn every_name_is_listed_and_explained() {
    let folder = Folder::empty();
    let listing = folder.good("fields").out;
    let all = folder.good("fields --json").json();
    let all = all.as_array().unwrap();
    assert!(all.len() > 20);
    for entry in all {
        let name = entry["name"].as_str().unwrap();
        assert!(listing.contains(name), "{name}");
        assert!(!entry["doc"].as_str().unwrap().is_empty(), "{name}");
    }
    let page = folder.good("fields sphere").out;
    assert!(
        page.contains("radius") && page.contains("default 1") && page.contains("is exact"),
        "{page}"
    );
    assert_eq!(
        folder.good("fields sphere --json").json()["parameters"][0]["name"],
        "radius"
    );
    folder.bad("fields spere", 2, &["`spere`", "did you mean `sphere`?"]);
    folder.bad("fields --json zzzzzz", 2, &["`zzzzzz`"]);
}

#[test]
fn every_example_of_a_shape_is_a_scene() {
    let folder = Folder::empty();
    let all = folder.good("fields --json").json();
    let mut scene = String::new();
    for entry in all.as_array().unwrap() {
        let example = entry["example"].as_str().unwrap_or("...");
        if !example.contains("...") {
            scene += &format!("x = {example}\n");
        }
    }
    scene += "show(sphere())\n";
    folder.write("scene.star", scene);
    folder.good("check scene.star");
}

#[test]
fn methods_have_a_page_and_their_ranges() {
    let folder = Folder::empty();
    let page = folder.good("fields methods").out;
    for text in [
        "sphere (in scenes sphere_tracing)",
        "Keinert et al. 2014",
        "above 0 to 1, default 0.3",
        "mitchell",
    ] {
        assert!(page.contains(text), "no `{text}` in {page}");
    }
    let share = folder.good("fields enhanced --json").json()["parameters"][0].clone();
    assert_eq!(
        (&share["max"], &share["is_below"]),
        (&1.0.into(), &true.into())
    );
    let page = folder.good("fields supersample").out;
    assert!(
        page.contains("\"tent\" or \"mitchell\" or \"box\""),
        "{page}"
    );
}
