//! Values of options, read from text. Every error says what is allowed.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;
use zeroset_scene::methods::{Choice, Kind, Method, Param, Value};

/// A size in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = &'static str;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const WANTED: &str = "write width x height in pixels, for example 640x360";
        let (width, height) = text.split_once(['x', 'X']).ok_or(WANTED)?;
        let side = |text: &str| match text.trim().parse::<u32>() {
            Ok(0) => Err("both sides must be at least 1 pixel"),
            Ok(pixels) => Ok(pixels),
            Err(_) => Err(WANTED),
        };
        Ok(Size([side(width)?, side(height)?]))
    }
}

/// `NAME=VALUE`.
pub(crate) fn assignment(text: &str) -> Result<(String, String), &'static str> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("write NAME=VALUE, for example size=0.5"),
    }
}

/// A finite number of seconds.
pub(crate) fn seconds(text: &str) -> Result<f64, &'static str> {
    text.parse::<f64>()
        .ok()
        .filter(|x| x.is_finite())
        .ok_or("write a number of seconds, for example 1.5")
}

/// A share of 100.
pub(crate) fn percent(text: &str) -> Result<f64, &'static str> {
    text.parse::<f64>()
        .ok()
        .filter(|x| (0.0..=100.0).contains(x))
        .ok_or("write a number of percent, 0 to 100")
}

/// A finite number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, &'static str> {
    text.parse::<f64>()
        .ok()
        .filter(|x| x.is_finite() && *x > 0.0)
        .ok_or("write a number above 0")
}

/// A method with its numbers: `NAME`, `NAME=NUMBER` for the first of them, `NAME,PARAM=NUMBER,...` for any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chosen<T>(pub T);

impl<T: Choice> FromStr for Chosen<T> {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut parts = text.split(',');
        let first = parts.next().unwrap_or_default();
        let (name, number) = match first.split_once('=') {
            Some((name, number)) => (name.trim(), Some(number)),
            None => (first.trim(), None),
        };
        let mut made = T::named(name).ok_or_else(|| {
            let names: Vec<_> = T::METHODS.iter().map(|m| m.name).collect();
            let (last, others) = names.split_last().unwrap_or((&"", &[]));
            format!("the methods are {} and {last}", others.join(", "))
        })?;
        let params = made.method().params;
        let names = || params.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
        let mut given = Vec::new();
        if let Some(number) = number {
            let param = params.first().ok_or(format!("`{name}` takes no number"))?;
            given.push((param, number));
        }
        for part in parts {
            let (param, value) = (part.split_once('='))
                .ok_or_else(|| format!("write `{name},PARAM=NUMBER`, not `{part}`"))?;
            let found = params.iter().find(|p| p.name == param.trim());
            let found = found.ok_or_else(|| match params {
                [] => format!("`{name}` takes no number"),
                _ => format!("`{name}` has no `{}`, it takes {}", param.trim(), names()),
            })?;
            given.push((found, value));
        }
        for (i, (param, value)) in given.iter().enumerate() {
            if given[..i].iter().any(|(other, _)| other.name == param.name) {
                return Err(format!("`{}` is given twice", param.name));
            }
            let value = read(param, value.trim())?;
            (made.set(param.name, value)).map_err(|e| format!("{} {e}", param.name))?;
        }
        Ok(Chosen(made))
    }
}

/// With all its numbers, so that it is read as what it is.
impl<T: Choice> fmt::Display for Chosen<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let method = self.0.method();
        f.write_str(method.name)?;
        for param in method.params {
            if let Some(value) = self.0.get(param.name) {
                let text = param.written(value);
                write!(f, ",{}={}", param.name, text.trim_matches('"'))?;
            }
        }
        Ok(())
    }
}

/// The value of a parameter, from text.
fn read(param: &Param, text: &str) -> Result<Value, String> {
    match param.kind {
        Kind::Word(methods) => param.word(text).ok_or_else(|| {
            let names: Vec<_> = methods.iter().map(|m| m.name).collect();
            format!("{} is one of {}", param.name, names.join(", "))
        }),
        Kind::Limit if text == "unlimited" => Ok(Value::Limit(None)),
        Kind::Limit | Kind::Real | Kind::Whole => match text.parse::<f64>() {
            Ok(x) if x.is_finite() => param
                .value(x)
                .map_err(|refused| format!("{} {refused}", param.name)),
            _ => Err(format!("`{text}` is not a number")),
        },
    }
}

/// What a choice of methods is, for `--help`: the methods with what they take.
pub(crate) fn help<T: Choice>(what: &str) -> String {
    let each = |method: &Method| {
        let param = |(i, p): (usize, &Param)| {
            let name = p.name.to_uppercase();
            if i == 0 {
                format!("[={name}]")
            } else {
                format!("[,{}={name}]", p.name)
            }
        };
        let params: String = method.params.iter().enumerate().map(param).collect();
        format!("{}{params}", method.name)
    };
    let all: Vec<String> = T::METHODS.iter().map(each).collect();
    format!("{what}: {}", all.join(", "))
}

/// Numbers of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Frames(pub Range<u32>);

impl FromStr for Frames {
    type Err = &'static str;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const WANTED: &str = "write first..end, for example 0..30 for the frames 0 to 29";
        let (first, end) = text.split_once("..").ok_or(WANTED)?;
        let first: u32 = first.parse().map_err(|_| WANTED)?;
        let end: u32 = match end.strip_prefix('=') {
            Some(last) => last
                .parse::<u32>()
                .ok()
                .and_then(|last| last.checked_add(1))
                .ok_or(WANTED)?,
            None => end.parse().map_err(|_| WANTED)?,
        };
        if first >= end {
            Err("there is no frame in this range")
        } else {
            Ok(Frames(first..end))
        }
    }
}

/// A plane across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SectionPlane {
    /// 0 = x, 1 = y, 2 = z.
    pub axis: usize,
    /// Where on the axis.
    pub at: f64,
}

impl FromStr for SectionPlane {
    type Err = &'static str;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const WANTED: &str = "write x, y or z and where, for example z=0.5";
        let (axis, at) = text.split_once('=').ok_or(WANTED)?;
        let axis = ["x", "y", "z"]
            .iter()
            .position(|name| *name == axis.trim())
            .ok_or(WANTED)?;
        let at = at
            .trim()
            .parse::<f64>()
            .ok()
            .filter(|x| x.abs() <= 1e6)
            .ok_or(WANTED)?;
        Ok(SectionPlane { axis, at })
    }
}

impl fmt::Display for SectionPlane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", ["x", "y", "z"][self.axis], self.at)
    }
}

/// A rectangle on a plane: left, bottom, right, top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window(pub [f64; 4]);

impl FromStr for Window {
    type Err = &'static str;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers: Vec<f64> = text
            .split(',')
            .map_while(|n| n.trim().parse().ok())
            .collect();
        match numbers[..] {
            [u0, v0, u1, v1]
                if text.split(',').count() == 4
                    && [u0, v0, u1, v1].iter().all(|x| x.abs() <= 1e6) =>
            {
                if u0 < u1 && v0 < v1 {
                    Ok(Window([u0, v0, u1, v1]))
                } else {
                    Err("left must be less than right, and bottom less than top")
                }
            }
            _ => Err("write left,bottom,right,top, for example -2,-1,2,1"),
        }
    }
}

/// One of several words.
fn word<T: Copy>(text: &str, words: &[(&'static str, T)]) -> Result<T, String> {
    let found = words.iter().find(|(name, _)| *name == text);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = words.iter().map(|w| w.0).collect();
        format!("it is one of {}", names.join(", "))
    })
}

/// A number of cells, 0 or more.
pub(crate) fn cells(text: &str) -> Result<f64, &'static str> {
    text.parse::<f64>()
        .ok()
        .filter(|x| x.is_finite() && *x >= 0.0)
        .ok_or("write a number of cells, 0 or more")
}

/// A box: its smallest corner and its largest.
pub(crate) fn bounds(text: &str) -> Result<zeroset_catalogue::bounds::Aabb, &'static str> {
    let numbers: Vec<f64> = (text.split(','))
        .map_while(|n| n.trim().parse().ok())
        .collect();
    let [x0, y0, z0, x1, y1, z1] = numbers[..] else {
        return Err("write the smallest corner and the largest, for example -2,0,-2,2,3,2");
    };
    let (min, max) = ([x0, y0, z0], [x1, y1, z1]);
    let is_box = (0..3).all(|k| min[k] < max[k] && min[k].abs() <= 1e6 && max[k].abs() <= 1e6);
    if is_box && text.split(',').count() == 6 {
        Ok(zeroset_catalogue::bounds::Aabb::new(min, max))
    } else {
        Err("the first corner must be less than the second along each axis, and none beyond 1e6")
    }
}

/// What is inside of a mesh.
pub(crate) fn sign(text: &str) -> Result<zeroset_volume::bake::Sign, String> {
    use zeroset_volume::bake::Sign;
    word(
        text,
        &[
            ("auto", Sign::Auto),
            ("parity", Sign::Parity),
            ("winding", Sign::Winding),
        ],
    )
}

/// A metric of distance transforms.
pub(crate) fn metric(text: &str) -> Result<zeroset_volume::transform::Metric, String> {
    word(text, &zeroset_volume::transform::Metric::ALL)
}

/// A method of distance transforms.
pub(crate) fn transform(text: &str) -> Result<zeroset_volume::transform::Method, String> {
    word(text, &zeroset_volume::transform::Method::ALL)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize;
    use zeroset_language::load::{Language, Options, load_text};
    use zeroset_scene::methods::Allowed;
    use zeroset_scene::settings::{Antialias, Filter, March, Occlusion, Shadow};

    #[test]
    fn good_values_are_read() {
        assert_eq!("640x360".parse(), Ok(Size([640, 360])));
        assert_eq!(
            assignment(" bite = 0.5=x"),
            Ok(("bite".into(), "0.5=x".into()))
        );
        assert_eq!(
            "relaxed=1.2".parse(),
            Ok(Chosen(March::Relaxed { omega: 1.2 }))
        );
        assert_eq!("auto".parse(), Ok(Chosen(March::Auto { beta: 0.3 })));
        assert_eq!("sphere_tracing".parse(), Ok(Chosen(March::Sphere)));
        assert_eq!(
            "bent=7,bend=0.1".parse(),
            Ok(Chosen(Occlusion::Bent {
                steps: 7,
                step: 0.1,
                scale: 0.5,
                bend: 0.1
            }))
        );
        let (reach, steps) = (None, 9);
        assert_eq!(
            "cones=unlimited,steps=9".parse(),
            Ok(Chosen(Occlusion::Cones { reach, steps }))
        );
        let (samples, filter) = (9, Filter::Tent);
        assert_eq!(
            "supersample=9,filter=tent".parse(),
            Ok(Chosen(Antialias::Supersample { samples, filter }))
        );
        assert_eq!("3..7".parse(), Ok(Frames(3..7)));
        assert_eq!("3..=7".parse(), Ok(Frames(3..8)));
        assert_eq!("y=-0.5".parse(), Ok(SectionPlane { axis: 1, at: -0.5 }));
        assert_eq!("-2,-1, 2,1".parse(), Ok(Window([-2.0, -1.0, 2.0, 1.0])));
    }

    #[test]
    fn bad_values_are_refused_with_what_is_allowed() {
        for text in [
            "",
            "x",
            "640",
            "0x5",
            "5x0",
            "-1x5",
            "1e9x2",
            "640x360x2",
            "4294967296x1",
            "٣x٣",
        ] {
            assert!(text.parse::<Size>().is_err(), "{text}");
        }
        for text in ["", "=", "=1", "bite"] {
            assert!(assignment(text).is_err(), "{text}");
        }
        for text in [
            "",
            "spheres",
            "sphere=1",
            "relaxed=2",
            "relaxed=",
            "auto=nan",
            "fixed=0",
            "fixed=inf",
            "auto=0",
            "enhanced=1",
            "relaxed,omega",
            "relaxed,beta=0.3",
            "relaxed=1.2,omega=1.3",
            "sphere,step=1",
            "auto,",
        ] {
            assert!(text.parse::<Chosen<March>>().is_err(), "{text}");
        }
        for text in ["quilez=2.5", "quilez=0", "cones=none", "cones=0"] {
            assert!(text.parse::<Chosen<Occlusion>>().is_err(), "{text}");
        }
        assert!(
            "supersample,filter=lanczos"
                .parse::<Chosen<Antialias>>()
                .is_err()
        );
        for text in [
            "",
            "..",
            "3",
            "3..3",
            "7..3",
            "a..b",
            "-1..3",
            "0..=4294967295",
            "0...3",
        ] {
            assert!(text.parse::<Frames>().is_err(), "{text}");
        }
        for text in ["", "z", "w=0", "z=", "z=nan", "z=inf", "z=1e9", "=0"] {
            assert!(text.parse::<SectionPlane>().is_err(), "{text}");
        }
        for text in [
            "",
            "0,0,1",
            "0,0,1,1,1",
            "1,0,0,1",
            "0,0,0,0",
            "0,0,nan,1",
            "a,0,1,1",
        ] {
            assert!(text.parse::<Window>().is_err(), "{text}");
        }
        for text in ["", "nan", "inf", "x"] {
            assert!(seconds(text).is_err() && positive(text).is_err(), "{text}");
        }
        assert!(positive("0").is_err() && positive("-1").is_err());
    }

    /// Whether a scene loads.
    fn loads(name: &str, text: &str, language: Language) -> bool {
        let mut options = Options::default();
        options.limits.samples = u64::MAX;
        load_text(name, text, language, None, &options).is_ok()
    }

    /// The scene language, JSON and the command line agree about a number of a method.
    fn agree<T: Choice + Serialize>(
        in_script: fn(&str) -> String,
        in_json: fn(serde_json::Value) -> serde_json::Value,
    ) -> usize {
        let mut checked = 0;
        for base in T::all() {
            for param in base.method().params {
                let Allowed { min, max, .. } = param.allowed;
                let single = |x: f64, up: bool| match (x as f32, up) {
                    (x, true) => f64::from(x.next_up()),
                    (x, false) => f64::from(x.next_down()),
                };
                let numbers = match param.kind {
                    Kind::Word(_) => continue,
                    Kind::Whole => vec![min - 1.0, min, min + 1.0, max - 1.0, max, max + 1.0],
                    Kind::Real | Kind::Limit => vec![
                        -1.0,
                        single(min, false),
                        min,
                        single(min, true),
                        single(max, false),
                        max,
                        single(max, true),
                        1e30,
                    ],
                };
                for x in numbers {
                    let (word, name) = (base.method().word, param.name);
                    let text = match param.kind {
                        Kind::Whole => format!("{x}"),
                        _ => format!("{x:?}"),
                    };
                    let what = format!("{word}({name} = {text})");
                    let value = match param.kind {
                        Kind::Whole => Value::Whole(x.max(0.0) as u32),
                        Kind::Limit => Value::Limit(Some(x as f32)),
                        Kind::Real | Kind::Word(_) => Value::Real(x as f32),
                    };
                    let mut method = *base;
                    assert!(method.put(name, value), "{what}");
                    let json = in_json(serde_json::to_value(method).unwrap()).to_string();
                    let flag = format!("{},{name}={text}", base.method().name);
                    let right = param.value(x).is_ok();
                    assert_eq!(
                        loads("a.star", &in_script(&what), Language::Starlark),
                        right,
                        "{what}"
                    );
                    // what counts cannot be below 0: no method holds such a number to be written down
                    if x >= 0.0 || !matches!(param.kind, Kind::Whole) {
                        assert_eq!(loads("a.json", &json, Language::Json), right, "{json}");
                    }
                    let parsed = flag.parse::<Chosen<T>>();
                    assert_eq!(parsed.is_ok(), right, "{flag}");
                    // what is written is read as what it was
                    if right {
                        let chosen = Chosen(method);
                        assert_eq!(chosen.to_string().parse(), Ok(chosen), "{chosen}");
                    }
                    checked += 1;
                }
            }
        }
        checked
    }

    #[test]
    fn all_ways_to_write_a_method_agree_about_its_numbers() {
        fn scene(settings: serde_json::Value, lights: serde_json::Value) -> serde_json::Value {
            serde_json::json!({
                "zeroset": 1,
                "objects": [{"field": {"sphere": {"radius": 1}}}],
                "settings": settings,
                "lights": lights,
            })
        }
        let plain = scene(serde_json::json!({}), serde_json::json!([]));
        assert!(loads("a.json", &plain.to_string(), Language::Json));
        let checked = [
            agree::<March>(
                |what| format!("show(sphere())\nrender(march = {what})"),
                |method| scene(serde_json::json!({"march": method}), serde_json::json!([])),
            ),
            agree::<Occlusion>(
                |what| format!("show(sphere())\nrender(ao = {what})"),
                |method| {
                    scene(
                        serde_json::json!({"occlusion": method}),
                        serde_json::json!([]),
                    )
                },
            ),
            agree::<Antialias>(
                |what| format!("show(sphere())\nrender(aa = {what})"),
                |method| {
                    scene(
                        serde_json::json!({"antialias": method}),
                        serde_json::json!([]),
                    )
                },
            ),
            agree::<Shadow>(
                |what| format!("show(sphere())\nsun(shadow = {what})"),
                |method| {
                    let light = serde_json::json!({
                        "source": {"kind": "directional", "direction": [0, -1, 0]},
                        "radiance": [1, 1, 1],
                        "shadow": method,
                    });
                    scene(serde_json::json!({}), serde_json::json!([light]))
                },
            ),
        ];
        assert!(checked.iter().all(|n| *n > 5), "{checked:?}");
    }
}
