//! `zeroset import`.

use crate::run::Folder;

const DISC: &str = "x var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\nd add a b\ne add c d\nf sqrt e\nr const 0.5\nout sub f r\n";
const TREE: &str = r#"{"nodeType": "binaryOperator", "blendMode": "sub", "blendRadius": 0.1,
    "leftChild": {"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "color": [1, 0.5, 0]},
    "rightChild": {"nodeType": "primitive", "primitiveType": "cylinder", "radius": 0.2, "height": 2}}"#;

/// What is made of a list lies beside it and asks for it; elsewhere it could not be read.
#[test]
fn a_register_list_becomes_a_scene_that_loads_it() {
    let folder = Folder::empty();
    std::fs::create_dir(folder.path("parts")).unwrap();
    folder.write("parts/ball.vm", DISC);
    folder.good("import parts/ball.vm -o scene.star");
    let text = String::from_utf8(folder.read("scene.star")).unwrap();
    assert!(text.contains("load_vm(\"parts/ball.vm\")"), "{text}");
    let said = folder.good("check scene.star").out;
    assert!(said.contains("Proven"), "{said}");
    folder.good("render scene.star --size 16x16 -o ball.png");
    folder.bad(
        "import parts/ball.vm -o parts/../elsewhere/scene.star",
        4,
        &["elsewhere"],
    );
    std::fs::create_dir(folder.path("elsewhere")).unwrap();
    folder.bad(
        "import parts/ball.vm -o elsewhere/scene.star",
        2,
        &["its own folder", "parts/ball.star"],
    );
    folder.write("parts/wrong.vm", "a var-x\nb foo a\n");
    folder.bad("import parts/wrong.vm", 3, &["line 2", "`foo`", "wrong.vm"]);
}

#[test]
fn a_tree_becomes_a_scene() {
    let folder = Folder::empty();
    folder.write("tree.json", TREE);
    let printed = folder.good("import tree.json").out;
    folder.good("import tree.json -o tree.star");
    assert_eq!(folder.read("tree.star"), printed.as_bytes());
    folder.good("render tree.star --size 16x16 -o tree.png");
    // what stands there stays when the next one is wrong
    folder.write("tree.json", TREE.replace("sphere", "torus"));
    folder.bad(
        "import tree.json -o tree.star",
        3,
        &["leftChild", "`primitiveType`", "torus"],
    );
    assert_eq!(folder.read("tree.star"), printed.as_bytes());
    folder.write("tree.json", &TREE[..60]);
    folder.bad("import tree.json", 3, &["tree.json", "EOF"]);
    folder.bad("import tree.json -o tree.png", 2, &[".star"]);
    folder.bad("import tree.json --function map", 2, &["--function"]);
    folder.bad("import tree.obj", 2, &[".glsl", ".json", ".vm"]);
    folder.bad("import none.json", 4, &["cannot read", "none.json"]);
    folder.write("bytes.json", b"\xff\xfe");
    folder.bad("import bytes.json", 4, &["bytes.json", "UTF-8"]);
}

#[cfg(feature = "shaders")]
#[test]
fn a_shader_becomes_a_scene_or_is_told_where_it_does_not() {
    let folder = Folder::empty();
    let shader = "float ball(vec3 p, float r) { return length(p) - r; }\n\
                  vec2 map(in vec3 p) {\n  vec2 d = vec2(p.y, 1.0);\n  float b = ball(p - vec3(0, 0.5, 0), 0.4);\n  \
                  return b < d.x ? vec2(b, 2.0) : d;\n}\n\
                  void mainImage(out vec4 c, in vec2 f) { c = texture(iChannel0, f); }\n";
    folder.write("shader.glsl", shader);
    folder.good("import shader.glsl -o shader.star");
    let text = String::from_utf8(folder.read("shader.star")).unwrap();
    assert!(
        text.contains("def ball(p, r):\n    return length(p) - r\n"),
        "{text}"
    );
    let said = folder.good("check shader.star").out;
    assert!(
        said.contains("material 1") && said.contains("material 2"),
        "{said}"
    );
    folder.good("render shader.star --size 16x16 -o shader.png");
    folder.good("import shader.glsl --function map");
    folder.bad("import shader.glsl --function nap", 3, &["`nap`", "ball"]);
    folder.write(
        "shader.glsl",
        shader.replace("length(p) - r", "texture(iChannel1, p.xy).x"),
    );
    folder.bad(
        "import shader.glsl -o shader.star",
        3,
        &[
            "textures are not translated",
            "shader.glsl:1:46",
            "iChannel1",
        ],
    );
    assert_eq!(folder.read("shader.star"), text.as_bytes());
}

#[cfg(not(feature = "shaders"))]
#[test]
fn a_shader_needs_a_feature() {
    let folder = Folder::empty();
    folder.write(
        "shader.glsl",
        "float map(vec3 p) { return length(p) - 1.0; }",
    );
    folder.bad("import shader.glsl", 2, &["--features shaders"]);
}

/// Macros that name the next one twice: 2^40 numbers.
#[cfg(feature = "shaders")]
#[test]
fn macros_that_grow_without_end_are_given_up() {
    let folder = Folder::empty();
    let macros: String = (0..40)
        .map(|k| format!("#define A{k} A{0} + A{0}\n", k + 1))
        .collect();
    let text =
        format!("{macros}#define A40 1.0\nfloat map(vec3 p) {{ return length(p) - (A0); }}\n");
    folder.write("grows.glsl", text);
    folder.bad(
        "import grows.glsl -o grows.star",
        3,
        &["longer than 5 s", "macros"],
    );
    assert!(!folder.path("grows.star").exists());
}
