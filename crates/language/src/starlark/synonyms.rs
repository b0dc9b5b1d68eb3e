//! What other tools call things, and what to write here: behind the messages about unknown names, methods and arguments, and the
//! page `docs/coming-from.md`.

use super::native::{Argument, spoken};
use super::value::Value;
use zeroset_catalogue::Kind;
use zeroset_catalogue::entries::catalogue;

/// A word of other tools.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Synonym {
    /// What it is called elsewhere.
    pub words: &'static [&'static str],
    /// What to write here.
    pub write: &'static str,
}

const fn says(words: &'static [&'static str], write: &'static str) -> Synonym {
    Synonym { words, write }
}

/// Functions, methods and names.
pub const SYNONYMS: &[Synonym] = &[
    says(
        &["translate", "opTranslate"],
        "shape.move(x = 1) or shape.move((1, 2, 3))",
    ),
    says(
        &["rotate", "rotate_x", "rotate_y", "rotate_z", "rotated"],
        "shape.turn(y = 30) or shape.turn(axis = (1, 1, 0), angle = 30), in degrees",
    ),
    says(
        &["orient", "look_at", "align"],
        "shape.turn(x = 90) or shape.turn(axis = \"z\", angle = 90), in degrees",
    ),
    says(
        &["scale3", "resize", "scale_x", "scale_y", "scale_z"],
        "shape.stretch((1, 2, 1)), or shape.scale(2) for all axes",
    ),
    says(
        &["shell", "opOnion", "hollow"],
        "shape.onion(thickness = 0.1)",
    ),
    says(
        &["dilate", "inflate", "expand", "grow", "minkowski"],
        "shape.offset(0.1), or shape.round(0.1) to add round edges",
    ),
    says(
        &["erode", "deflate", "inset", "shrink"],
        "shape.offset(-0.1)",
    ),
    says(
        &["circular_array", "radial_array", "pModPolar", "polar_array"],
        "shape.polar(12), around the y axis",
    ),
    says(
        &[
            "array",
            "tile",
            "opRep",
            "opRepetition",
            "pMod1",
            "pMod2",
            "pMod3",
            "domain_repeat",
        ],
        "shape.repeat(spacing = 2), or count = (5, 1, 5) for so many",
    ),
    says(
        &["opSymX", "opSymXZ", "mirror_x", "pMirror"],
        "shape.symmetry(), or shape.mirror(normal = \"x\")",
    ),
    says(
        &["save", "export_stl", "write_stl", "generate"],
        "show(shape), then on the command line: zeroset render scene.star, or zeroset bake scene.star for a volume",
    ),
    says(
        &["render_png", "display", "draw", "main"],
        "show(shape, material(color = \"tomato\"))",
    ),
    says(
        &["light", "directional_light", "sunlight", "lamp"],
        "sun(direction = (-1, -2, -1)) or point_light(position = (2, 3, 1), strength = 8)",
    ),
    says(
        &["background", "environment", "ambient", "bg"],
        "sky(color = \"white\"), or sky(top = \"#5f8fc7\", horizon = \"#e8dccb\", ambient = 0.5)",
    ),
    says(
        &["cube", "cuboid", "sdBox", "rect_prism"],
        "box(1) or box((1, 2, 3)): full sides",
    ),
    says(
        &["rounded_cube", "sdRoundBox"],
        "rounded_box(size = (1, 2, 3), radius = 0.1)",
    ),
    says(&["ball", "sdSphere", "uv_sphere"], "sphere(radius = 1)"),
    says(&["sdTorus", "donut"], "torus(radius = 0.75, tube = 0.25)"),
    says(
        &["sdCylinder", "sdCappedCylinder", "rod"],
        "cylinder(radius = 0.5, height = 2), upright along y",
    ),
    says(
        &["sdPlane", "floor_plane", "ground"],
        "plane(): everything below y = 0",
    ),
    says(
        &["sdCapsule", "line"],
        "capsule_between(start = (0, 0, 0), end = (1, 1, 0), radius = 0.1)",
    ),
    says(
        &["square", "rect", "sdBox2D"],
        "rectangle(size = (1, 2)), a plane shape",
    ),
    says(
        &["sdCircle", "disc", "disk"],
        "circle(radius = 1), a plane shape",
    ),
    says(
        &["hexagon", "pentagon", "octagon", "regular_polygon"],
        "ngon(sides = 6), a plane shape",
    ),
    says(
        &["linear_extrude", "extrude_to", "opExtrusion"],
        "plane_shape.extrude(height = 0.2)",
    ),
    says(
        &["rotate_extrude", "lathe", "opRevolution"],
        "plane_shape.revolve(offset = 1), about the y axis",
    ),
    says(
        &["difference", "subtract", "opSubtraction"],
        "a - b, or subtraction(a, b)",
    ),
    says(
        &["intersect", "opIntersection"],
        "a & b, or intersection(a, b)",
    ),
    says(
        &["opUnion", "add", "merge", "combine"],
        "a | b, or union([a, b, c])",
    ),
    says(
        &["k", "smooth", "opSmoothUnion", "soft_union", "fillet"],
        "a.smooth_union(b, radius = 0.2), and the same with _subtraction and _intersection",
    ),
    says(
        &["opSmoothSubtraction", "smooth_difference"],
        "a.smooth_subtraction(b, radius = 0.2)",
    ),
    says(
        &["opSmoothIntersection"],
        "a.smooth_intersection(b, radius = 0.2)",
    ),
    says(&["chamfer"], "a.chamfer_union(b, radius = 0.2)"),
    says(
        &["color", "colour", "set_color", "fill"],
        "shape.paint(material(color = \"tomato\")), or show(shape, \"tomato\")",
    ),
    says(
        &["texture", "image"],
        "material(color = triplanar(image = \"wood.png\"))",
    ),
    says(
        &["negate", "invert", "inverse"],
        "~shape, or shape.complement()",
    ),
    says(&["X", "UP_X"], "the text \"x\", or (1, 0, 0)"),
    says(&["Y", "UP"], "the text \"y\", or (0, 1, 0)"),
    says(&["Z"], "the text \"z\", or (0, 0, 1)"),
    says(&["ORIGIN"], "(0, 0, 0)"),
    says(&["PI"], "pi"),
    says(&["TAU", "two_pi"], "tau"),
    says(
        &["iTime", "t", "frame", "current_time"],
        "time(), seconds: zeroset render --time 0.25",
    ),
    says(
        &["sdf2", "sdf3", "make_shape", "distance_field", "shape"],
        "field(lambda p: length(p) - 1), or field2d for a plane shape",
    ),
    says(
        &["bend_linear", "bend_radial"],
        "shape.bend(angle = 60, length = 2), or shape.map(lambda p: ...)",
    ),
    says(
        &["transition_linear", "transition_radial", "morph"],
        "shape.morph(other, t = 0.5)",
    ),
    says(
        &["hull"],
        "smooth_union([a, b], radius = 0.5), or capsule_between and round_cone for round hulls",
    ),
    says(
        &["math", "np", "numpy"],
        "sin, cos, sqrt and the others are there without a module: sin(x)",
    ),
    says(
        &["float3", "float2"],
        "(x, y, z), or vec3(x, y, z) in a formula",
    ),
];

/// What to write for a name of another tool.
pub(crate) fn of_name(name: &str) -> Option<String> {
    let found = SYNONYMS.iter().find(|s| s.words.contains(&name))?;
    Some(format!("here that is {}", found.write))
}

/// Arguments of other tools, and what they are called here, the first that there is.
const ARGUMENTS: &[(&str, &[&str])] = &[
    ("k", &["radius", "amount"]),
    ("r", &["radius", "tube"]),
    ("smoothness", &["radius"]),
    ("smooth", &["radius"]),
    ("rad", &["radius"]),
    ("r1", &["radius"]),
    ("r2", &["tube"]),
    ("minor", &["tube"]),
    ("major", &["radius"]),
    ("h", &["height", "length"]),
    ("depth", &["height"]),
    ("length", &["height"]),
    ("dimensions", &["size"]),
    ("dims", &["size"]),
    ("sides", &["size"]),
    ("n", &["count", "sides"]),
    ("copies", &["count"]),
    ("distance", &["spacing", "amount", "offset"]),
    ("colour", &["color"]),
    ("vector", &["x"]),
    ("v", &["x"]),
    ("offset", &["x", "amount"]),
    ("metalness", &["metallic"]),
    ("metal", &["metallic"]),
    ("shininess", &["roughness"]),
    ("position", &["eye"]),
    ("look_at", &["target"]),
    ("intensity", &["strength"]),
];

/// What to write for an argument that a function does not have.
pub(crate) fn of_argument(params: &[&str], written: &str) -> Option<String> {
    match written {
        "center" | "centre" | "at" | "pos" | "origin" if !params.contains(&"eye") => {
            return Some("shapes stand at the origin: write .move(x, y, z) behind it".into());
        }
        "rotation" | "angles" | "axis" if !params.contains(&"angle") => {
            return Some("write .turn(x = 90) behind it, in degrees".into());
        }
        "d" | "diameter" if params.contains(&"radius") => {
            return Some("write `radius`, half of the diameter".into());
        }
        "position" if !params.contains(&"eye") => {
            return Some("shapes stand at the origin: write .move(x, y, z) behind it".into());
        }
        _ => {}
    }
    let (_, names) = ARGUMENTS.iter().find(|(name, _)| *name == written)?;
    let name = names.iter().find(|name| params.contains(name))?;
    Some(format!("here that is `{name}`"))
}

/// What to write where numbers are given one by one that are one size: `box(1, 2, 3)`.
pub(crate) fn of_numbers(name: &str, arguments: &[Argument<'_>]) -> Option<String> {
    let all = catalogue();
    let info = (all.primitive(name).map(|e| &e.info))
        .or_else(|| all.map(name).map(|e| &e.info))
        .or_else(|| all.modifier(name).map(|e| &e.info))?;
    let first = info.params.first()?;
    let width = match first.kind {
        Kind::Vec2 => 2,
        Kind::Vec3 => 3,
        _ => return None,
    };
    let numbers: Vec<String> = (arguments.iter().filter(|a| a.name.is_none()))
        .map_while(|a| match a.value {
            Value::Int(i) => Some(i.to_string()),
            Value::Float(x) => Some(spoken(x)),
            _ => None,
        })
        .take(width)
        .collect();
    (numbers.len() == width).then(|| {
        format!(
            "`{}` is one argument: {name}(({}))",
            first.name,
            numbers.join(", ")
        )
    })
}
