//! The language: what scene files may say and what comes out.

use glam::Vec3;
use zeroset_field::field::{Field, Node};
use zeroset_language::json::{expand, to_text};
use zeroset_language::load::{Control, Failed, Language, Loaded, Options, Setting, load_text};
use zeroset_scene::material::Pattern;
use zeroset_scene::methods::Choice;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{
    Antialias, Filter, Integrator, March, Normals, Occlusion, Shading, Shadow, Tone,
};

fn try_load(text: &str, options: &Options) -> Result<Loaded, Failed> {
    load_text("scene.star", text, Language::Starlark, None, options)
}

fn scene(text: &str) -> Loaded {
    match try_load(text, &Options::default()) {
        Ok(loaded) => loaded,
        Err(failed) => panic!("{:?}", miette::Report::new(*failed.report)),
    }
}

fn message(text: &str) -> String {
    match try_load(text, &Options::default()) {
        Ok(_) => panic!("this was loaded: {text}"),
        Err(failed) => failed.report.message().to_string(),
    }
}

/// What a script prints.
fn prints(text: &str) -> String {
    scene(&format!("{text}\nshow(sphere())")).log.join("\n")
}

/// Checks expressions: each line is `expression => printed`.
#[track_caller]
fn check(table: &str) {
    for line in table.lines().filter(|l| !l.trim().is_empty()) {
        let (expression, wanted) = line
            .split_once("=>")
            .expect("a line is `expression => printed`");
        assert_eq!(
            prints(&format!("print({expression})")),
            wanted.trim(),
            "{expression}"
        );
    }
}

fn first(loaded: &Loaded) -> &Field {
    &loaded.scene.objects()[0].field
}

#[test]
fn numbers() {
    check(
        "
        1 + 2 * 3 => 7
        7 / 2 => 3.5
        7 // 2 => 3
        -7 // 2 => -4
        -7 % 3 => 2
        7 % -3 => -2
        -5.5 % 3.0 => 0.5
        7.5 // 2 => 3.0
        1e3 => 1000.0
        0x10 + 0o10 + 0b10 => 26
        1 << 10 | 3 => 1027
        6 & 3 => 2
        6 ^ 3 => 5
        ~5 => -6
        1 == 1.0 => True
        9007199254740993 == 9007199254740992.0 => False
        9007199254740993 > 9007199254740992.0 => True
        1 < 2.5 => True
        int(-2.7) => -2
        int('12') + float('0.5') => 12.5
        round(2.6) => 3
        round(2.345, 2) => 2.35
        floor(-1.5), ceil(-1.5) => -2 -1
        abs(-3), abs(-3.5), sign(-2.0) => 3 3.5 -1
        min(3, 1, 2), max([3, 1, 2]) => 1 3
        pow(2, 10), hypot(3, 4), sqrt(16) => 1024.0 5.0 4.0
        sin(pi / 2), cos(pi), sin(0), sin(-pi / 2), cos(tau) => 1.0 -1.0 0.0 -1.0 1.0
        round(sin(pi / 6), 12), round(atan2(1, 1), 9), round(acos(0.5), 9), round(asin(1), 9), atan(0) => 0.5 0.785398163 1.047197551 1.570796327 0.0
        degrees(pi), radians(180) == pi => 180.0 True
        clamp(5, 0, 3), lerp(1, 3, 0.25) => 3.0 1.5
        lerp((0, 0), (2, 4)) => (1.0, 2.0)
        length((3, 4, 12)) => 13.0
        sum([1, 2, 3.5]) => 6.5
        random(1) == random(1), random(1) == random(2), 0 <= random(3) and random(3) < 1 => True False True
        random(0.0) == random(-0.0), random(1, 2) == random(2, 1) => True False
        ",
    );
}

#[test]
fn texts() {
    check(
        "
        'a' + 'b' * 3 => abbb
        'tower%d' % 3 => tower3
        '%s is %.2f' % ('x', 1.5) => x is 1.50
        '{} {1} {{}}'.format('a', 'b') => a b {}
        'abc'[1] + 'abc'[-1] => bc
        'héllo'[1:3] => él
        'abc'[::-1] => cba
        len('héllo') => 5
        'b' in 'abc' => True
        'a,b,c'.split(',') => [\"a\", \"b\", \"c\"]
        ' a b '.split() => [\"a\", \"b\"]
        '-'.join(['a', 'b']) => a-b
        'aXb'.replace('X', '..').upper() => A..B
        'abc'.find('c'), 'abc'.find('z'), 'aaa'.count('a') => 2 -1 3
        'abc'.startswith('ab'), 'abc'.endswith('ab') => True False
        'ab'.elems() => [\"a\", \"b\"]
        str(1.0) + str(None) + repr('q') => 1.0None\"q\"
        type(1), type('a'), type([]), type(sphere()) => int string list field
        ",
    );
    assert_eq!(prints("n = 3\nprint(f'tower{n} {n + 1}')"), "tower3 4");
}

#[test]
fn sequences() {
    check(
        "
        [1, 2] + [3] => [1, 2, 3]
        (1,) + (2,) => (1, 2)
        [0] * 3 => [0, 0, 0]
        [x * x for x in range(5) if x % 2 == 0] => [0, 4, 16]
        [(x, y) for x in range(2) for y in 'ab'.elems()] => [(0, \"a\"), (0, \"b\"), (1, \"a\"), (1, \"b\")]
        {x: x * x for x in range(3)} => {0: 0, 1: 1, 2: 4}
        {'a': 1} | {'b': 2} => {\"a\": 1, \"b\": 2}
        {'a': 1}.get('b', 7) => 7
        {1: 'x'}[1.0] => x
        list({'a': 1, 'b': 2}) => [\"a\", \"b\"]
        {'a': 1}.items() => [(\"a\", 1)]
        dict([('a', 1)]) => {\"a\": 1}
        list(range(10, 0, -3)) => [10, 7, 4, 1]
        range(10)[2:8:2], len(range(0, 10, 3)), 4 in range(0, 10, 2) => range(2, 8, 2) 4 True
        [1, 2, 3, 4][1:-1], (1, 2, 3)[::-1], [1, 2, 3][5:] => [2, 3] (3, 2, 1) []
        sorted([3, 1, 2]), sorted([1, 2, 3], reverse = True) => [1, 2, 3] [3, 2, 1]
        sorted(['bb', 'a'], key = len), sorted([(2, 1), (1, 9), (1, 2)]) => [\"a\", \"bb\"] [(1, 2), (1, 9), (2, 1)]
        reversed([1, 2]), list(enumerate(['a'], 1)), list(zip([1, 2], 'ab'.elems())) => [2, 1] [(1, \"a\")] [(1, \"a\"), (2, \"b\")]
        any([0, 1]), all([0, 1]), any([]), all([]) => True False False True
        2 in [1, 2], 2 not in [1, 2] => True False
        [1, [2]] == [1, [2]], (1, 2) < (1, 3) => True True
        1 if [] else 2 => 2
        None or 'x', 0 and fail() => x 0
        ",
    );
}

#[test]
fn statements() {
    assert_eq!(
        prints("l = [1]\nm = l\nl += [2]\nl.append(3)\nprint(m)"),
        "[1, 2, 3]"
    );
    assert_eq!(prints("x = 5\nx -= 2\nx *= 3\nx /= 2\nprint(x)"), "4.5");
    assert_eq!(prints("a, (b, c) = 1, (2, 3)\nprint(a + b + c)"), "6");
    assert_eq!(
        prints("d = {}\nd['a'] = 1\nd['a'] += 1\nprint(d)"),
        "{\"a\": 2}"
    );
    assert_eq!(
        prints(
            "s = 0\nfor i in range(10):\n    if i == 3:\n        continue\n    if i == 6:\n        break\n    s += i\nprint(s)"
        ),
        "12"
    );
    assert_eq!(
        prints("if False:\n    print(1)\nelif True:\n    print(2)\nelse:\n    print(3)"),
        "2"
    );
    assert_eq!(
        prints("l = [1, 2, 3]\nl.insert(1, 9)\nprint(l.pop(), l.pop(0), l, l.index(9))"),
        "3 1 [9, 2] 0"
    );
}

#[test]
fn functions() {
    assert_eq!(
        prints(
            "def f(a, b = 2, *rest, c, **named):\n    return (a, b, rest, c, named)\nprint(f(1, c = 3))"
        ),
        "(1, 2, (), 3, {})"
    );
    assert_eq!(
        prints(
            "def f(a, b = 2, *rest, c, **named):\n    return (a, b, rest, c, named)\nprint(f(1, 5, 6, 7, c = 3, d = 4))"
        ),
        "(1, 5, (6, 7), 3, {\"d\": 4})"
    );
    assert_eq!(
        prints("def f(*a):\n    return a\nprint(f(1, *(2, 3)))"),
        "(1, 2, 3)"
    );
    assert_eq!(
        prints("def f(x, y):\n    return x - y\nprint(f(**{'y': 1, 'x': 5}))"),
        "4"
    );
    // a function sees the variables around it, as they are when it runs
    assert_eq!(
        prints(
            "def add(n):\n    return lambda x: x + n\nf = add(2)\ng = add(5)\nprint(f(1), g(1))"
        ),
        "3 6"
    );
    assert_eq!(
        prints("fs = [lambda: i for i in range(3)]\nprint([f() for f in fs])"),
        "[2, 2, 2]"
    );
    assert_eq!(
        prints("def fact(n):\n    return 1 if n < 2 else n * fact(n - 1)\nprint(fact(10))"),
        "3628800"
    );
    assert_eq!(prints("def f():\n    pass\nprint(f())"), "None");
    assert_eq!(prints("m = [1].append\nprint(type(m))"), "function");
    // names of a comprehension end with it
    assert_eq!(
        prints("x = 7\ny = [x for x in range(3)]\nprint(x, y)"),
        "7 [0, 1, 2]"
    );
}

#[test]
fn mistakes_of_the_language() {
    assert!(message("x = 1 / 0").contains("division by zero"));
    assert!(message("x = [1][3]").contains("no item 3 among 1"));
    assert!(message("def f():\n    print(y)\n    y = 1\nf()").contains("no value yet"));
    assert!(message("x = 9223372036854775807 + 1").contains("too large"));
    assert!(message("l = [1]\nfor x in l:\n    l.append(x)").contains("while a loop runs over it"));
    assert!(message("x = {}[[]]").contains("cannot be a key"));
    assert!(message("x = {'a': 1}['b']").contains("no key \"b\""));
    assert!(message("x = 1 << 64").contains("allowed are 0 to 63"));
    assert!(message("a, b = 1, 2, 3").contains("2 names for 3 values"));
    assert!(message("x = sorted([1, 'a'])").contains("cannot be compared"));
    assert!(message("x = sqrt(-1)").contains("no value"));
    assert!(message("fail('my', 'reason')").contains("my reason"));
}

#[test]
fn a_scene_of_one_line() {
    let loaded = scene("show(sphere())");
    let scene = &loaded.scene;
    assert_eq!(
        (scene.name(), scene.objects().len(), scene.lights().len()),
        ("scene", 2, 3)
    );
    assert_eq!(scene.objects()[0].place, Some(("scene.star".into(), 1, 1)));
    // the ball stands in the middle of the picture and fills a good part of it
    let (origin, direction) = scene.camera().ray(256.0, 256.0, scene.settings().size);
    let nearest = origin - direction * origin.dot(direction);
    assert!(
        nearest.length() < 1e-4,
        "the middle ray misses the centre by {}",
        nearest.length()
    );
    let angle = (1.0 / origin.length()).asin() / (0.5 * 40_f32.to_radians());
    assert!(
        (0.4..0.9).contains(&angle),
        "the ball fills {angle} of the height"
    );
    assert!(!loaded.animated && loaded.parameters.is_empty() && loaded.files.is_empty());
}

#[test]
fn the_tour() {
    let text = r##"
bite  = slider("bite", 0.4, min = 0.0, max = 1.0)
body  = box(size = 1.0) & sphere(0.68)
cheese = body - sphere(0.5).move(x = bite)
knot  = sphere(0.6).twist(30).move(y = 1.2)

def ring(n, shape, radius):
    return union([shape.move(x = radius).turn(y = 360 * i / n) for i in range(n)])

gold  = material(color = "#e8b04a", metallic = 1, roughness = 0.25)
show(cheese.blend(knot, 0.2), gold)
show(ring(12, sphere(0.1), 1.5), material(color = hsv(time() * 60, 0.6, 0.9)))
show(plane(), material(color = "#888"), ao = quilez(steps = 5, scale = 1.0))

camera(eye = (3, 2, 4), target = (0, 0.5, 0), fov = 40)
sun(direction = (-1, -2, -1), shadow = soft(16))
sky(top = "#cfe3ff", ambient = 0.4)
render(size = (512, 512), march = auto(), aa = supersample(8))
"##;
    let loaded = scene(text);
    assert_eq!(
        (loaded.scene.objects().len(), loaded.scene.materials().len()),
        (3, 3)
    );
    assert!(loaded.animated);
    let bite = &loaded.parameters[0];
    assert_eq!(bite.control, Control::Slider { min: 0.0, max: 1.0 });
    assert_eq!(bite.value, Setting::Number(0.4));
    assert!(loaded.scene.field().is_ok_and(|f| f.is_some()));
}

#[test]
fn what_is_set_from_outside() {
    let text = "
x = slider('x', 0.5)
c = choice('c', ['red', 'green'])
t = toggle('t')
k = color('k', '#00f')
print(x, c, t, k, time())
show(sphere())";
    let set = |pairs: &[(&str, &str)]| {
        let set = pairs
            .iter()
            .map(|(k, v)| (k.to_string(), v.to_string()))
            .collect();
        try_load(
            text,
            &Options {
                set,
                time: 1.5,
                size: Some([64, 32]),
                ..Options::default()
            },
        )
    };
    let loaded = set(&[]).unwrap();
    assert_eq!(loaded.log, ["0.5 red False (0.0, 0.0, 1.0) 1.5"]);
    assert_eq!(loaded.scene.settings().size, [64, 32]);
    let loaded = set(&[("x", "0.75"), ("c", "green"), ("t", "on"), ("k", "#f00")]).unwrap();
    assert_eq!(loaded.log, ["0.75 green True (1.0, 0.0, 0.0) 1.5"]);
    assert_eq!(loaded.parameters[0].default, Setting::Number(0.5));
    for (name, value) in [
        ("x", "7"),
        ("x", "wide"),
        ("c", "blue"),
        ("t", "maybe"),
        ("k", "reddish"),
        ("y", "1"),
    ] {
        let failed = set(&[(name, value)]).unwrap_err();
        assert!(failed.report.message().contains(name), "{}", failed.report);
    }
}

#[test]
fn chains_of_operators_stay_flat() {
    let loaded =
        scene("s = sphere()\nfor i in range(2000):\n    s = s | sphere(0.5).move(x = i)\nshow(s)");
    assert_eq!(first(&loaded).facts().depth, 3);
    assert!(matches!(first(&loaded).node(), Node::Join { shapes, .. } if shapes.len() == 2001));
    // subtraction is no chain
    let loaded = scene("show(sphere(2) - sphere() - box(1))");
    assert_eq!(first(&loaded).facts().depth, 3);
}

#[test]
fn clones_are_shared() {
    let loaded = scene("s = sphere().move(x = 1)\nshow(s | s.turn(y = 90) | s)");
    let Node::Join { shapes, .. } = first(&loaded).node() else {
        panic!("a union")
    };
    assert_eq!(shapes[0].key(), shapes[2].key());
}

#[test]
fn joins_are_functions_and_methods() {
    for text in [
        "show(smooth_union([sphere(), box(1)], radius = 0.2))",
        "show(smooth_union([sphere(), box(1)], 0.2))",
        "show(smooth_union(sphere(), box(1), radius = 0.2))",
        "show(sphere().smooth_union(box(1), radius = 0.2))",
        "show(sphere().smooth_union(box(1), 0.2))",
        "show(sphere().blend(box(1), 0.2))",
    ] {
        let loaded = scene(text);
        let Node::Join {
            entry,
            params,
            shapes,
        } = first(&loaded).node()
        else {
            panic!("{text}")
        };
        assert_eq!(
            (entry.info.name, params.as_slice(), shapes.len()),
            ("smooth_union", &[0.2][..], 2),
            "{text}"
        );
    }
}

#[test]
fn turns() {
    let rotation = |text: &str| {
        let loaded = scene(&format!("show(sphere().{text})"));
        match first(&loaded).node() {
            Node::Place { placement, .. } => placement.rotation,
            _ => panic!("{text}"),
        }
    };
    let quarter = rotation("turn(y = 90)");
    for text in [
        "turn(axis = 'y', angle = 90)",
        "turn(quaternion = (0, 1, 0, 1))",
        "turn((0, 90, 0))",
        "turn(axis = (0, 2, 0), angle = 90)",
    ] {
        let other = rotation(text);
        for (a, b) in quarter.iter().flatten().zip(other.iter().flatten()) {
            assert!((a - b).abs() < 1e-12, "{text}: {other:?}");
        }
    }
    // x goes to -z
    assert!((quarter[2][0] + 1.0).abs() < 1e-12);
    assert!(message("show(sphere().turn(y = 1, axis = 'x', angle = 2))").contains("one turn"));
}

#[test]
fn painted_parts() {
    let loaded = scene(
        "show(sphere().paint('red') | box(1).paint(material(color = 'blue')) | sphere(2).paint('red'))\nsun()",
    );
    // red, blue and the object's own
    assert_eq!(loaded.scene.materials().len(), 3);
}

/// Every method of the registry, as a script writes it, is that method; as JSON too.
#[test]
fn every_method_can_be_written() {
    fn each<T: Choice>(write: fn(&str) -> String, found: fn(&Scene) -> T) {
        for (base, method) in T::all().iter().zip(T::METHODS) {
            let is_called = T::METHODS.iter().any(|m| !m.params.is_empty());
            let written = match is_called {
                true => format!("{}()", method.word),
                false => format!("\"{}\"", method.name),
            };
            let loaded = scene(&write(&written));
            assert_eq!(found(&loaded.scene), *base, "{written}");
            let json = to_text(&expand(&loaded.scene).expect("JSON"));
            let again = load_text("a.json", &json, Language::Json, None, &Options::default());
            let again = again.unwrap_or_else(|e| panic!("{}", e.report));
            assert_eq!(found(&again.scene), *base, "{json}");
        }
    }
    each::<March>(
        |m| format!("show(sphere())\nrender(march = {m})"),
        |s| s.settings().march,
    );
    each::<Normals>(
        |m| format!("show(sphere())\nrender(normals = {m})"),
        |s| s.settings().normals,
    );
    each::<Occlusion>(
        |m| format!("show(sphere(), ao = {m})"),
        |s| s.objects()[0].occlusion.expect("its own"),
    );
    each::<Occlusion>(
        |m| format!("show(sphere())\nrender(ao = {m})"),
        |s| s.settings().occlusion,
    );
    each::<Antialias>(
        |m| format!("show(sphere())\nrender(aa = {m})"),
        |s| s.settings().antialias,
    );
    each::<Shading>(
        |m| format!("show(sphere())\nrender(shading = {m})"),
        |s| s.settings().shading,
    );
    each::<Integrator>(
        |m| format!("show(sphere())\nrender(integrator = {m})"),
        |s| s.settings().integrator,
    );
    each::<Tone>(
        |m| format!("show(sphere())\nrender(tone = {m})"),
        |s| s.settings().tone,
    );
    each::<Shadow>(
        |m| format!("show(sphere())\nsun(shadow = {m})"),
        |s| s.lights()[0].shadow,
    );
    each::<Filter>(
        |m| format!("show(sphere())\nrender(aa = supersample(filter = {m}))"),
        |s| s.settings().antialias.filter().expect("a filter"),
    );
}

/// Materials of formulas are one where their formulas are, and others where not.
#[test]
fn formulas_tell_materials_apart() {
    let text = "s = sphere(2)
for k in (1, 1, 2):
    show(sphere().move(x = k), material(color = lambda p: vec3(k * p.x)))
    show(sphere().move(y = k), material(roughness = lambda p: s(k * p)))";
    let scene = scene(text).scene;
    // the last one is the floor of a scene that says nothing of light
    let numbers: Vec<u16> = scene.objects().iter().map(|o| o.material).collect();
    assert_eq!(numbers, [0, 1, 0, 1, 2, 3, 4]);
}

/// A formula gives colours as they are written everywhere else.
#[test]
fn a_formula_gives_srgb() {
    let one = |words: &str| {
        let text = format!("show(sphere(), material(color = {words}))");
        scene(&text).scene.materials()[0].pattern.clone()
    };
    for (colour, by_formula) in [
        ("(0.9, 0.7, 0.3)", "(0.9, 0.7, 0.3)"),
        // what depends on the point takes the curve in its steps
        ("(0.9, 0.7, 0.01)", "vec3(0.9, 0.7, 0.01) + 0 * p"),
        ("\"tomato\"", "\"tomato\""),
        ("\"tomato\"", "\"tomato\" if p.x < 1 else p"),
        ("rgb(0.2, 1, 0)", "rgb(0.2, 1, 0)"),
        ("hsv(200, 0.5, 0.7)", "hsv(200, 0.5, 0.7)"),
    ] {
        let Pattern::Solid { colour: plain } = one(colour) else {
            panic!("{colour} is a colour")
        };
        let Pattern::Formula { formula } = one(&format!("lambda p: {by_formula}")) else {
            panic!("{by_formula} is a formula")
        };
        let o = zeroset_number::F64(0.0);
        let found = formula
            .eval(zeroset_number::v3(o, o, o))
            .map(|c| c.0 as f32);
        let off = (Vec3::from(found) - plain).abs().max_element();
        assert!(off < 1e-6, "{by_formula}: {found:?} instead of {plain}");
    }
}

/// Glass without a colour of its own is clear; roughness and shininess follow from each other.
#[test]
fn materials_complete_what_is_left_out() {
    let one = |words: &str| {
        let text = format!("show(sphere(), material({words}))");
        scene(&text).scene.materials()[0].clone()
    };
    let colour = |words: &str| match one(words).pattern {
        Pattern::Solid { colour } => colour,
        other => panic!("{other:?}"),
    };
    assert_eq!(colour("transmission = 1"), Vec3::ONE);
    assert_ne!(colour("transmission = 0"), Vec3::ONE);
    assert!(colour("transmission = 1, color = \"red\"").y < 0.01);
    let half = one("tint = rgb(0.5, 1, 1), tint_depth = 2");
    // what is left after the way that was stated is the colour that was stated
    let left = (-half.attenuation * 2.0).exp();
    assert!((left.x - 0.214).abs() < 1e-3 && left.y == 1.0, "{left}");
    assert_eq!(one("").roughness, 0.5);
    assert_eq!(one("roughness = 0.2, shininess = 7").shininess, 7.0);
    let (smooth, rough) = (one("shininess = 500"), one("shininess = 5"));
    assert!(smooth.roughness < 0.3 && rough.roughness > 0.6);
    // there and back again
    let back = one(&format!("roughness = {}", smooth.roughness));
    assert!((back.shininess - 500.0).abs() < 1.0, "{}", back.shininess);
}
