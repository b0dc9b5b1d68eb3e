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
