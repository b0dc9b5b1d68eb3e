//! `zeroset fit-ao`.

use crate::run::Folder;

const SCENE: &str = "show(sphere(1).move(y = 1))\nshow(plane())\ncamera(eye = (0, 2.2, 6.5), target = (0, 0.9, 0), fov = 36)
render(ao = quilez(steps = 5, step = 0.4, scale = 3))\n";

/// Fitted numbers are nearer, what is printed is what was measured, and the scene with them is as near as was said.
#[test]
fn fitted_numbers_are_nearer() {
    let folder = Folder::with(SCENE);
    let asked = "fit-ao scene.star --size 40x30 --rays 64";
    let json = folder.good(&format!("{asked} --json -o sheet.png")).json();
    let methods = json["methods"].as_array().unwrap();
    let of = |name: &str| methods.iter().find(|m| m["method"] == name).unwrap();
    let rmse = |figures: &serde_json::Value| figures["rmse"].as_f64().unwrap();
    for name in ["quilez", "bent", "evans", "upward"] {
        let (before, after) = (rmse(&of(name)["before"]), rmse(&of(name)["after"]));
        assert!(
            after <= before && after < rmse(&of("none")["before"]),
            "{name}: {before}, {after}"
        );
    }
    // the scene's own numbers are far too strong
    let quilez = of("quilez");
    assert_eq!(
        quilez["before"]["settings"],
        "quilez(steps = 5, step = 0.4, scale = 3)"
    );
    assert!(
        rmse(&quilez["after"]) < 0.5 * rmse(&quilez["before"]),
        "{quilez}"
    );
    assert!(rmse(&of("cones")["before"]) < rmse(&quilez["after"]));
    assert!(json["reference_noise"].as_f64().unwrap() < 0.05);
    // what was found is what it begins with, and is found again
    let settings = quilez["after"]["settings"].as_str().unwrap();
    let stated = quilez["before"]["settings"].as_str().unwrap();
    folder.write("fitted.star", SCENE.replace(stated, settings));
    let json = folder
        .good("fit-ao fitted.star --size 40x30 --rays 64 --json")
        .json();
    let again = json["methods"]
        .as_array()
        .unwrap()
        .iter()
        .find(|m| m["method"] == "quilez");
    let again = rmse(&again.unwrap()["before"]);
    assert!((again - rmse(&quilez["after"])).abs() < 1e-9, "{json}");
    let text = folder.good(&format!("{asked} --ao upward")).out;
    assert!(
        text.contains("upward(scale =") && text.contains("render(ao = upward("),
        "{text}"
    );
    assert!(folder.names().contains(&"sheet.png".to_owned()));
    let away = "show(sphere(1))\ncamera(eye = (0, 0, 3), target = (0, 0, 9))\n";
    folder.write("empty.star", away);
    folder.bad("fit-ao empty.star", 3, &["nothing that could be occluded"]);
}
