//! `zeroset set`: values in the scene's own file.

use crate::run::Folder;

const SCENE: &str = "# a ball\nr = slider(\"r\", 0.5, 0.1, 1)  # its radius\ng = 0.5\ns = slider(\"s\", 2 * g)\nshow(sphere(r) | box(s))\n";

#[test]
fn values_are_written_and_nothing_else() {
    let folder = Folder::with(SCENE);
    let said = folder.good("set scene.star r=0.75");
    assert!(said.err.contains("`r`"), "{said:?}");
    let text = SCENE.replace("\"r\", 0.5", "\"r\", 0.75");
    assert_eq!(folder.read("scene.star"), text.as_bytes());
    assert!(
        folder
            .good("set scene.star --set r=0.75")
            .err
            .contains("already")
    );
    let printed = folder.good("set scene.star r=0.25 --print");
    assert_eq!(printed.out, SCENE.replace("\"r\", 0.5", "\"r\", 0.25"));
    assert_eq!(folder.read("scene.star"), text.as_bytes());
    assert_eq!(folder.names(), ["scene.star"]);
}

#[test]
fn what_cannot_be_written_is_said_and_the_rest_is_written() {
    let folder = Folder::with(SCENE);
    folder.bad(
        "set scene.star r=0.75 s=0.4",
        1,
        &["`s`", "`default` of slider()", "line 4"],
    );
    let text = SCENE.replace("\"r\", 0.5", "\"r\", 0.75");
    assert_eq!(folder.read("scene.star"), text.as_bytes());
    for (command, code, word) in [
        ("set scene.star", 2, "nothing is set"),
        ("set scene.star r=2", 3, "0.1 to 1"),
        ("set scene.star q=2", 3, "\"q\""),
        ("set missing.star r=1", 4, "missing.star"),
    ] {
        folder.bad(command, code, &[word]);
        assert_eq!(folder.read("scene.star"), text.as_bytes());
    }
}
