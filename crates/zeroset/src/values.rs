//! Values of options, read from text. Every error says what is allowed.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;
use zeroset_scene::settings::March;

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

/// A finite number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, &'static str> {
    text.parse::<f64>()
        .ok()
        .filter(|x| x.is_finite() && *x > 0.0)
        .ok_or("write a number above 0")
}

/// A march method with its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MarchChoice(pub March);

impl FromStr for MarchChoice {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (name, number) = match text.split_once('=') {
            None => (text, None),
            Some((name, number)) => match number.parse::<f32>() {
                Ok(number) if number.is_finite() => (name, Some(number)),
                _ => return Err(format!("`{number}` is not a number")),
            },
        };
        let within = |default: f32, low: f32, high: f32, what: &str| match number.unwrap_or(default)
        {
            x if (low..=high).contains(&x) => Ok(x),
            x => Err(format!("{what} is {x}, allowed is {low} to {high}")),
        };
        Ok(MarchChoice(match name {
            "fixed" => March::Fixed {
                step: within(0.02, 1e-5, 1e3, "the step")?,
            },
            "sphere" if number.is_some() => return Err("`sphere` takes no number".to_owned()),
            "sphere" => March::Sphere,
            "relaxed" => March::Relaxed {
                omega: within(1.2, 1.0, 1.99, "omega")?,
            },
            "enhanced" => March::Enhanced {
                share: within(0.9, 0.1, 0.99, "the share")?,
            },
            "auto" => March::Auto {
                beta: within(0.3, 0.0, 1.0, "beta")?,
            },
            _ => return Err("the methods are fixed, sphere, relaxed, enhanced and auto".to_owned()),
        }))
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_values_are_read() {
        assert_eq!("640x360".parse(), Ok(Size([640, 360])));
        assert_eq!(
            assignment(" bite = 0.5=x"),
            Ok(("bite".into(), "0.5=x".into()))
        );
        assert_eq!(
            "relaxed=1.2".parse(),
            Ok(MarchChoice(March::Relaxed { omega: 1.2 }))
        );
        assert_eq!("auto".parse(), Ok(MarchChoice(March::Auto { beta: 0.3 })));
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
        ] {
            assert!(text.parse::<MarchChoice>().is_err(), "{text}");
        }
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
}
