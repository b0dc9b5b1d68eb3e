//! What a person is told: one case for each kind of mistake.

use miette::{GraphicalReportHandler, GraphicalTheme};
use std::fmt::Write;
use zeroset_language::limits::Limits;
use zeroset_language::load::{Language, Options, load_text};

fn told(text: &str, language: Language, options: &Options) -> String {
    let name = if language == Language::Json {
        "scene.json"
    } else {
        "scene.star"
    };
    let failed = match load_text(name, text, language, None, options) {
        Ok(_) => panic!("this was loaded: {text}"),
        Err(failed) => failed,
    };
    let mut out = String::new();
    let handler =
        GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor()).with_width(100);
    handler.render_report(&mut out, &*failed.report).unwrap();
    // lines end without spaces, as editors like it
    out.lines()
        .fold(String::new(), |all, line| all + line.trim_end() + "\n")
}

#[track_caller]
fn cases(name: &str, language: Language, cases: &[(&str, &str)]) {
    let mut all = String::new();
    for (what, text) in cases {
        writeln!(
            all,
            "== {what}\n{}",
            told(text, language, &Options::default())
        )
        .unwrap();
    }
    insta::assert_snapshot!(name, all);
}

#[test]
fn names_and_arguments() {
    cases(
        "names_and_arguments",
        Language::Starlark,
        &[
            ("unknown function", "show(spere(1))"),
            (
                "unknown function, in a branch that never runs",
                "if False:\n    smoth_union([])\nshow(sphere())",
            ),
            ("unknown method", "show(sphere().twits(30))"),
            ("a primitive as a method", "show(box(1).sphere())"),
            ("unknown method of a list", "x = [1].push(2)"),
            ("unknown argument", "show(sphere(\n    radios = 2,\n))"),
            ("missing argument", "show(sphere().scale())"),
            ("too many arguments", "show(sphere(1, 2))"),
            ("argument given twice", "show(sphere(1, radius = 2))"),
            (
                "a number where a field is needed",
                "show(union([sphere(), 3]))",
            ),
            ("a function where a field is needed", "show(sphere)"),
            (
                "a text where a number is needed",
                "show(sphere(radius = \"big\"))",
            ),
            (
                "two numbers where three are needed",
                "show(sphere().move((1, 2)))",
            ),
            ("not a number", "show(sphere(1e308 * 10))"),
            ("out of range", "show(sphere(radius = -1))"),
            (
                "an operator between what does not fit",
                "show(sphere() + box(1))",
            ),
            ("a method without its call", "show(sphere().move)"),
            (
                "an argument of a script's own function",
                "def tower(height):\n    return box(height)\nshow(tower(hieght = 2))",
            ),
            (
                "inside of functions",
                "def leaf(r):\n    return sphere(r)\n\ndef tree():\n    return leaf(-1)\n\nshow(tree())",
            ),
            ("a field that does not fit", "show(plane().twist(30))"),
            ("a spacing too small", "show(sphere().repeat(1))"),
            (
                "a direction of no length",
                "sun(direction = (0, 0, 0))\nshow(sphere())",
            ),
            (
                "an unknown direction",
                "sun(direction = \"up\")\nshow(sphere())",
            ),
        ],
    );
}

#[test]
fn words_of_other_tools() {
    cases(
        "words_of_other_tools",
        Language::Starlark,
        &[
            ("translate", "show(sphere().translate((1, 0, 0)))"),
            ("rotate", "show(box().rotate(0.5, \"x\"))"),
            ("orient", "show(cylinder().orient(\"x\"))"),
            ("shell", "show(sphere().shell(0.1))"),
            ("dilate", "show(sphere().dilate(0.1))"),
            ("erode", "show(sphere().erode(0.1))"),
            ("circular_array", "show(sphere().circular_array(8))"),
            ("save", "sphere().save(\"out.stl\")"),
            ("light", "light(position = (1, 2, 3))"),
            ("background", "background(\"white\")"),
            ("cube", "show(cube(1))"),
            ("an axis", "show(box().turn(axis = X, angle = 30))"),
            ("sides one by one", "show(box(1, 2, 3))"),
            ("sides of a rectangle", "show(rectangle(1, 2).extrude(1))"),
            ("a scale for each axis", "show(sphere().scale((1, 2, 1)))"),
            (
                "k for a radius",
                "show(sphere().smooth_union(box(), k = 0.1))",
            ),
            ("r for a radius", "show(sphere(r = 2))"),
            ("a diameter", "show(sphere(d = 2))"),
            ("a centre", "show(sphere(1, center = (1, 0, 0)))"),
            ("a module", "x = math.sqrt(2)"),
            (
                "a function as a statement",
                "translate((1, 0, 0), sphere())",
            ),
            ("a power", "x = 2 ** 3"),
            ("a choice as in C", "x = 1 > 0 ? 2 : 3"),
            ("and as in C", "x = 1 && 2"),
            ("not as in C", "x = !1"),
            ("two comparisons", "x = 0 < 1 < 2"),
            ("a type", "float d = 1.0"),
            ("OpenSCAD", "translate([1, 0, 0]) cube(1)"),
        ],
    );
}

#[test]
fn formulas() {
    cases(
        "formulas",
        Language::Starlark,
        &[
            (
                "a number as a condition",
                "show(field(lambda p: p.x and p.y))",
            ),
            (
                "a vector as a condition",
                "show(field(lambda p: 1 if p > 0 else 2))",
            ),
            (
                "a condition for a loop",
                "show(field(lambda p: [c for c in p if c > 0][0]))",
            ),
            (
                "a list that changes in a branch",
                "def f(p):\n    l = []\n    if p.x > 0:\n        l.append(1)\n    return p.y\nshow(field(f))",
            ),
            (
                "a plane shape at a point of space",
                "c = circle()\nshow(field(lambda p: c(p)))",
            ),
            (
                "a deformation that gives a number",
                "show(sphere().map(lambda p: p.x))",
            ),
            (
                "a displacement of what has no end",
                "show(plane().displace(lambda p: noise(p)))",
            ),
            ("no value", "def f(p):\n    d = p.x\nshow(field(f))"),
            ("an easing function", "x = ease(0.5, \"in_cubik\")"),
            (
                "a sharp turn",
                "show(circle(1).sweep([(0, 0, 0), (1, 0, 0), (0.5, 0.1, 0)]))",
            ),
        ],
    );
}

#[test]
fn formulas_of_materials() {
    cases(
        "formulas_of_materials",
        Language::Starlark,
        &[
            (
                "a number where a colour is needed",
                "show(sphere(), material(color = lambda p: p.x))",
            ),
            (
                "a colour where a number is needed",
                "show(sphere(), material(\n    roughness = lambda p: p,\n))",
            ),
            (
                "a field where a colour is needed",
                "show(sphere(), material(color = lambda p: sphere()))",
            ),
            (
                "two numbers where a colour is needed",
                "show(sphere(), material(color = lambda p: p.xy))",
            ),
            (
                "nothing",
                "def colour(p):\n    p.x\nshow(sphere(), material(color = colour))",
            ),
            (
                "no colour",
                "show(sphere(), material(color = lambda p: mix(\"rad\", \"white\", p.x)))",
            ),
            (
                "colours of a choice, one of which is none",
                "show(sphere(), material(color = lambda p: \"red\" if p.x > 0 else \"whit\"))",
            ),
            (
                "a vector within a pattern",
                "show(sphere(), checker(lambda p: p.xy, \"red\"))",
            ),
            (
                "a number where heights are needed",
                "show(sphere(), material(bump = 3))",
            ),
        ],
    );
}

#[test]
fn scenes() {
    cases(
        "scenes",
        Language::Starlark,
        &[
            ("nothing is shown", "s = sphere()"),
            (
                "two cameras",
                "camera(fov = 40)\nshow(sphere())\ncamera(fov = 50)",
            ),
            (
                "two ways to look",
                "camera(direction = (1, 0, 0), turn = (0, 90, 0))\nshow(sphere())",
            ),
            (
                "a camera that looks at itself",
                "camera(eye = (1, 1, 1), target = (1, 1, 1))\nshow(sphere())",
            ),
            ("a bad colour", "show(sphere(), material(color = \"#12\"))"),
            (
                "a colour of large numbers",
                "show(sphere(), material(color = (255, 128, 0)))",
            ),
            (
                "an unknown choice",
                "c = choice(\"c\", [\"round\", \"square\"], \"squar\")\nshow(sphere())",
            ),
            (
                "an unknown word",
                "render(shading = \"fong\")\nshow(sphere())",
            ),
            (
                "a method of another kind",
                "render(march = soft(16))\nshow(sphere())",
            ),
            (
                "a picture too large",
                "render(size = (100000, 100000))\nshow(sphere())",
            ),
            (
                "a slider the wrong way round",
                "x = slider(\"x\", 1, min = 2, max = 0)\nshow(sphere())",
            ),
            (
                "two parameters of one name",
                "x = slider(\"x\", 1)\ny = toggle(\"x\")\nshow(sphere())",
            ),
            (
                "a file in a scene without a folder",
                "load(\"a.star\", \"a\")\nshow(sphere())",
            ),
            (
                "an image that is not there",
                "show(sphere(), triplanar(\"a.png\"))",
            ),
        ],
    );
}

#[test]
fn syntax() {
    cases(
        "syntax",
        Language::Starlark,
        &[
            ("an open bracket", "show(sphere("),
            ("a missing colon", "def f(x)\n    return x"),
            ("a keyword of Python", "while True:\n    pass"),
            ("an assignment to a call", "f() = 3"),
            ("a return outside of a function", "return 3"),
            ("nested too deeply", &format!("x = {}", "[".repeat(200))),
            (
                "too long an expression",
                &format!("x = 1{}", " + 1".repeat(5000)),
            ),
        ],
    );
}

#[test]
fn set_from_outside() {
    let text =
        "x = slider(\"bite\", 0.4)\nc = choice(\"look\", [\"gold\", \"glass\"])\nshow(sphere())";
    let mut all = String::new();
    for (name, value) in [
        ("bites", "0.5"),
        ("bite", "7"),
        ("bite", "much"),
        ("look", "glas"),
    ] {
        let set = [(name.to_string(), value.to_string())].into();
        let told = told(
            text,
            Language::Starlark,
            &Options {
                set,
                ..Options::default()
            },
        );
        writeln!(all, "== {name}={value}\n{told}").unwrap();
    }
    insta::assert_snapshot!("set_from_outside", all);
}

#[test]
fn limits() {
    let small = Limits {
        ticks: 1000,
        heap: 10_000,
        nodes: 20,
        calls: 10,
        objects: 2,
        ..Limits::default()
    };
    let mut all = String::new();
    for (what, text) in [
        ("ticks", "x = [i for i in range(1000000)]"),
        ("heap", "x = \"long\" * 100000"),
        ("nodes", "x = [sphere() for i in range(100)]"),
        (
            "nodes of a field used often",
            "s = sphere()\nfor i in range(8):\n    s = (s - s)\nshow(s)",
        ),
        ("calls", "def f(n):\n    return f(n + 1)\nf(0)"),
        ("objects", "show(sphere())\nshow(sphere())\nshow(sphere())"),
    ] {
        let told = told(
            text,
            Language::Starlark,
            &Options {
                limits: small,
                ..Options::default()
            },
        );
        writeln!(all, "== {what}\n{told}").unwrap();
    }
    insta::assert_snapshot!("limits", all);
}

#[test]
fn json() {
    let object = |field: &str| {
        format!("{{\n  \"zeroset\": 1,\n  \"objects\": [\n    {{ \"field\": {field} }}\n  ]\n}}")
    };
    let fields = [
        ("unknown field", object(r#"{"spere": {}}"#)),
        ("unknown parameter", object(r#"{"sphere": {"radios": 1}}"#)),
        ("wrong type", object(r#"{"sphere": {"radius": "big"}}"#)),
        ("out of range", object(r#"{"sphere": {"radius": -1}}"#)),
        ("no operand", object(r#"{"round": {"radius": 1}}"#)),
        (
            "a part that is not there",
            object(r#"{"union": {"of": [{"part": 3}]}}"#),
        ),
        ("two keys", object(r#"{"sphere": {}, "box": {}}"#)),
        (
            "not rigid",
            object(
                r#"{"place": {"rotation": [[1, 0, 0], [0, 1, 0], [0, 1, 1]], "of": {"sphere": {}}}}"#,
            ),
        ),
    ];
    let others = [
        ("syntax", "{\n  \"zeroset\": 1,\n  \"objects\": [,]\n}"),
        ("not a scene", "[1, 2]"),
        ("no version", "{}"),
        ("another version", "{\"zeroset\": 9}"),
        ("unknown member", "{\"zeroset\": 1, \"object\": []}"),
        ("no objects", "{\"zeroset\": 1, \"objects\": []}"),
        (
            "an unknown setting",
            "{\"zeroset\": 1, \"objects\": [{\"field\": {\"sphere\": {}}}],\n \"settings\": {\"siez\": [1, 2]}}",
        ),
        (
            "a setting out of range",
            "{\"zeroset\": 1, \"objects\": [{\"field\": {\"sphere\": {}}}],\n \"settings\": {\"max_steps\": 0}}",
        ),
        (
            "a bad colour",
            "{\"zeroset\": 1, \"objects\": [{\"field\": {\"sphere\": {}}}],\n \"sky\": {\"top\": \"bluish\"}}",
        ),
        (
            "a bad camera",
            "{\"zeroset\": 1, \"objects\": [{\"field\": {\"sphere\": {}}}],\n \"camera\": {\"fov\": 0}}",
        ),
    ];
    let all: Vec<(&str, &str)> = fields
        .iter()
        .map(|(w, t)| (*w, t.as_str()))
        .chain(others)
        .collect();
    cases("json", Language::Json, &all);
}
