//! `zeroset export`.

use crate::run::{BALL, Folder};

#[test]
fn a_scene_becomes_shader_text() {
    let folder = Folder::with(BALL);
    let ended = folder.run("export scene.star --glsl");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(
        ended
            .out
            .contains("void mainImage(out vec4 fragColor, in vec2 fragCoord)")
    );
    assert!(!ended.out.contains("#version") && !ended.out.contains("void main()"));

    let ended = folder.run("export scene.star --wgsl --size 320x200 -o ball.wgsl");
    assert_eq!(
        (ended.code, ended.out.as_str()),
        (Some(0), ""),
        "{}",
        ended.err
    );
    let text = String::from_utf8(folder.read("ball.wgsl")).unwrap();
    assert!(text.contains("@fragment") && text.contains("vec2f(320.0, 200.0)"));
}

#[test]
fn a_language_must_be_chosen() {
    let folder = Folder::with(BALL);
    for arguments in ["export scene.star", "export scene.star --wgsl --glsl"] {
        let ended = folder.run(arguments);
        assert_eq!(ended.code, Some(2));
        assert!(
            ended.err.contains("--wgsl") && ended.err.contains("--glsl"),
            "{}",
            ended.err
        );
    }
}

#[test]
fn a_scene_too_large_for_a_shader_is_refused() {
    let folder = Folder::with("show(union([sphere(0.1).move(x = i) for i in range(3000)]))\n");
    let ended = folder.run("export scene.star --glsl -o big.glsl");
    assert_eq!(ended.code, Some(3), "{}", ended.err);
    assert!(
        ended.err.contains("too large for one shader"),
        "{}",
        ended.err
    );
    assert_eq!(folder.names(), ["scene.star"]);
}

/// What moves and what is adjusted stays so in GLSL, as the formulas of the scene itself; what does not is said, also in the file.
#[test]
fn time_and_sliders_stay_in_glsl() {
    let folder = Folder::with(
        "bite = slider(\"bite\", 0.4, min = 0.0, max = 1.0)
style = choice(\"style\", [\"round\", \"sharp\"])
count = slider(\"count\", 2, 1, 4)
show(sphere(1) - sphere(0.5).move(x = 1.2 - bite, y = 0.1 * sin(tau * time())))
for i in range(int(count)):
    show(box(0.3).move(x = 2 + i))
",
    );
    let ended = folder.good("export scene.star --glsl --time 3");
    let has = |line: &str| assert!(ended.out.contains(line), "{line}\n{}", ended.out);
    has("uniform float slider_bite; // bite: 0 to 1, at first 0.4");
    has("const float slider_bite = 0.4; // bite: 0 to 1");
    has("animate(iTime, slider_bite);");
    has("= (1.2 + (-1.0 * input_b));");
    has("0.1 * sin(");
    let held = [
        "style: a choice stays as it is set",
        "count: what the scene is made of is not the same",
    ];
    let said = ended.err.split_whitespace().collect::<Vec<_>>().join(" ");
    for held in held {
        has(&format!("// Not carried: {held}"));
        assert!(said.replace("│ ", "").contains(held), "{said}");
    }
}

/// A shader has what its scene needs and little else.
#[test]
fn small_scenes_are_small_shaders() {
    let folder =
        Folder::with("show(sphere())\nrender(integrator = direct(), ao = none(), aa = none())\n");
    let ended = folder.good("export scene.star --glsl");
    assert!(ended.out.len() < 85_000, "{} bytes", ended.out.len());
}
