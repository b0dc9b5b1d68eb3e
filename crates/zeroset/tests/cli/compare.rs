//! `zeroset compare`, and planted changes that it must see.

use crate::run::{BALL, Folder};

#[test]
fn planted_changes_are_seen_and_repetitions_are_equal() {
    let folder = Folder::with(BALL);
    let render = |name: &str, scene: &str| {
        folder.write("scene.star", scene);
        folder.good(&format!("render scene.star --size 64x48 -o {name}.png"));
    };
    render("a", BALL);
    render("again", BALL);
    let equal = folder.good("compare a.png again.png --json").json();
    assert_eq!(
        (&equal["equal"], &equal["psnr"]),
        (&true.into(), &serde_json::Value::Null)
    );
    assert!(
        folder
            .good("compare a.png again.png")
            .out
            .contains("PSNR       equal")
    );
    render(
        "larger",
        "show(sphere(0.84))\ncamera(eye = (0, 0, 4), target = (0, 0, 0))\n",
    );
    render(
        "fixed",
        "show(sphere(0.8))\ncamera(eye = (0, 0, 4), target = (0, 0, 0))\n",
    );
    render(
        "moved",
        "show(sphere(0.8).move(x = 0.05))\ncamera(eye = (0, 0, 4), target = (0, 0, 0))\n",
    );
    render(
        "red",
        "show(sphere(0.8), material(color = \"#ff0000\"))\ncamera(eye = (0, 0, 4), target = (0, 0, 0))\n",
    );
    for mutant in ["larger", "moved", "red"] {
        let found = folder
            .good(&format!(
                "compare fixed.png {mutant}.png --json -o {mutant}-diff.png"
            ))
            .json();
        let number = |key: &str| found[key].as_f64().unwrap();
        assert!(
            number("rmse") > 0.002 && number("psnr") < 55.0,
            "{mutant}: {found}"
        );
        assert!(
            number("ssim") < 0.9999 && number("flip_mean") > 0.001,
            "{mutant}: {found}"
        );
        assert!(
            number("flip_p99") >= number("flip_mean"),
            "{mutant}: {found}"
        );
        assert!(folder.path(&format!("{mutant}-diff.png")).exists());
    }
}

#[test]
fn what_cannot_be_compared_is_said() {
    let folder = Folder::with(BALL);
    folder.good("render scene.star --size 8x8 -o a.png");
    folder.good("render scene.star --size 8x9 -o b.png");
    folder.bad("compare a.png b.png", 1, &["different sizes", "8x8", "8x9"]);
    folder.bad("compare a.png none.png", 4, &["none.png"]);
    folder.bad(
        "compare a.png scene.star",
        4,
        &["neither a PNG nor an OpenEXR"],
    );
    folder.write("cut.png", &folder.read("a.png")[..60]);
    folder.bad("compare a.png cut.png", 4, &["cut.png", "damaged"]);
    folder.bad("compare a.png a.png -o none/d.png", 4, &["does not exist"]);
}

#[test]
fn several_pictures_are_a_table() {
    let folder = Folder::with(BALL);
    folder.good("render scene.star --size 48x32 -o a.png");
    folder.good("render scene.star --size 48x32 -o b.png --ao none");
    let table = folder.good("compare a.png a.png b.png").out;
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 3, "{table}");
    assert!(lines[0].starts_with("RMSE") && lines[1].contains("equal"));
    assert!(lines[1].ends_with("a.png") && lines[2].ends_with("b.png"));
    let json = folder.good("compare a.png a.png b.png --json").out;
    let second: serde_json::Value = serde_json::from_str(json.lines().nth(1).unwrap()).unwrap();
    assert!(second["file"] == "b.png" && second["rmse"].as_f64().unwrap() > 0.0);
    folder.bad("compare a.png a.png b.png -o d.png", 2, &["one picture"]);
    folder.bad("compare a.png", 2, &["B"]);
}
