//! Which arguments of a statement say a value, whatever the language of the file.

use super::Reason;
use glam::Vec3;
use zeroset_scene::camera::{Camera, Lens, degrees_of};
use zeroset_scene::colour::linear;

/// A value as a file writes it out.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Literal {
    /// Nothing, said outright.
    None,
    Flag(bool),
    Number(f64),
    Text(String),
    Numbers(Vec<f64>),
    /// A lens with parallel rays.
    Orthographic(f64),
}

impl Literal {
    /// A number of single precision in the fewest digits that mean it.
    pub(super) fn single(x: f32) -> Literal {
        Literal::Number(exact(x))
    }

    /// A point or a direction.
    pub(super) fn vector(v: Vec3) -> Literal {
        Literal::Numbers(v.to_array().map(exact).to_vec())
    }

    /// An sRGB colour: in hexadecimal digits where those mean it exactly.
    pub(super) fn colour(srgb: [f64; 3]) -> Literal {
        let [r, g, b] = srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
        let text = format!("#{r:02x}{g:02x}{b:02x}");
        if crate::colour::parse(&text) == Ok(srgb) {
            return Literal::Text(text);
        }
        Literal::Numbers(srgb.to_vec())
    }

    /// The sRGB colour that becomes a linear one.
    pub(super) fn of_linear(colour: Vec3) -> Literal {
        let srgb = colour.to_array().map(srgb_of);
        let levels = srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() / 255.0);
        let near = linear(levels).abs_diff_eq(colour, 1e-6);
        if !near {
            return Literal::Numbers(srgb.to_vec());
        }
        let [r, g, b] = levels.map(|c| (c * 255.0).round() as u8);
        Literal::Text(format!("#{r:02x}{g:02x}{b:02x}"))
    }

    /// The linear colour that it is, if it is one.
    fn as_linear(&self) -> Option<Vec3> {
        match self {
            Literal::Text(text) => crate::colour::parse(text).ok().map(linear),
            Literal::Numbers(n) => <[f64; 3]>::try_from(n.as_slice()).ok().map(linear),
            _ => None,
        }
    }

    /// Three numbers, or an axis by its name.
    pub(super) fn as_vector(&self) -> Option<Vec3> {
        let numbers = match self {
            Literal::Numbers(n) => <[f64; 3]>::try_from(n.as_slice()).ok()?,
            Literal::Text(word) => crate::starlark::direction_of_word(word)?,
            _ => return None,
        };
        Some(Vec3::from(numbers.map(|x| x as f32)))
    }

    /// Whether a file that says this need not be changed to say the other.
    pub(super) fn means(&self, other: &Literal) -> bool {
        self == other
            || match (self.as_linear(), other.as_linear()) {
                (Some(a), Some(b)) => a.abs_diff_eq(b, 1e-7),
                _ => false,
            }
    }
}

/// The double that has the shortest digits of a single.
fn exact(x: f32) -> f64 {
    // -0 is written as 0
    (x + 0.0).to_string().parse().unwrap_or(f64::from(x))
}

/// The sRGB value of a linear one, 0 to 1, in the fewest digits that mean it (IEC 61966-2-1).
fn srgb_of(linear_value: f32) -> f64 {
    let x = f64::from(linear_value).clamp(0.0, 1.0);
    let coded = if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    };
    let near = |c: f64| (linear([c; 3]).x - linear_value).abs() <= 1e-7;
    let rounded = (2..10).map(|digits| {
        let scale = 10_f64.powi(digits);
        (coded * scale).round() / scale
    });
    let mut exact = rounded.filter(|c| near(*c));
    exact.next().unwrap_or(coded).clamp(0.0, 1.0)
}

/// What a file says of an argument.
pub(super) enum Given {
    /// Nothing.
    Absent,
    /// A value, written out.
    Literal(Literal),
    /// Something that makes a value.
    Expression,
}

/// A statement whose arguments can be read and changed.
pub(super) trait Statement {
    /// What it says of an argument.
    fn given(&self, name: &str) -> Given;
    /// Makes an argument say something. One that does not stand there is added, one that says it already is left as it is.
    ///
    /// # Errors
    /// It is no literal.
    fn set(&mut self, name: &str, value: Literal) -> Result<(), Reason>;
    /// Puts another argument in the place of one.
    ///
    /// # Errors
    /// The one that goes is no literal.
    fn exchange(&mut self, old: &str, new: &str, value: Literal) -> Result<(), Reason>;
    /// Whether its lens is said by its height, or by a function of the language.
    fn has_height(&self) -> bool;
}

/// What may say which way a camera looks in place of a target.
const WAYS: [&str; 3] = ["turn", "direction", "axes"];

/// Makes a statement say a camera, given the one that it says now.
pub(super) fn camera(
    to: &mut impl Statement,
    before: &Camera,
    now: &Camera,
    target: Vec3,
) -> Result<(), Reason> {
    let is_there = before.eye == now.eye && before.axes.abs_diff_eq(now.axes, 1e-6);
    if !is_there {
        to.set("eye", Literal::vector(now.eye))?;
        let stated = |to: &dyn Fn(&str) -> bool| WAYS.into_iter().find(|way| to(way));
        let way = stated(&|name| !matches!(to.given(name), Given::Absent));
        match way {
            Some(way) => to.exchange(way, "target", Literal::vector(target))?,
            None => to.set("target", Literal::vector(target))?,
        }
        let up = match to.given("up") {
            Given::Absent => Some(Vec3::Y),
            Given::Literal(up) => up.as_vector(),
            Given::Expression => None,
        };
        let level = up.and_then(|up| Camera::look_at(now.eye, target, up, now.lens));
        if !level.is_some_and(|c| c.axes.abs_diff_eq(now.axes, 1e-5)) {
            to.set("up", Literal::vector(now.axes.y_axis))?;
        }
    }
    if before.lens != now.lens {
        match now.lens {
            Lens::Pinhole { fov } => to.set("fov", Literal::Number(degrees_of(fov)))?,
            Lens::Orthographic { height } if to.has_height() => {
                to.set("height", Literal::single(height))?;
            }
            Lens::Orthographic { height } => {
                let height = f64::from(height).to_string().parse().unwrap_or(1.0);
                to.set("lens", Literal::Orthographic(height))?;
            }
        }
    }
    if before.near != now.near {
        to.set("near", Literal::single(now.near))?;
    }
    if before.aperture != now.aperture {
        to.set("aperture", Literal::single(now.aperture))?;
    }
    // where nothing is said of it, what is sharp follows from the target
    if now.aperture > 0.0
        && (!is_there || before.focus != now.focus || before.aperture != now.aperture)
    {
        to.set("focus", Literal::single(now.focus))?;
    }
    // what is not stated follows from the bounds
    if before.far != now.far && !matches!(to.given("far"), Given::Absent) {
        to.set("far", Literal::single(now.far))?;
    }
    Ok(())
}
