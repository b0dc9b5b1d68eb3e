//! Fields of scenes, asked at points.

#![allow(dead_code, reason = "each test uses a part of it")]

use std::sync::Arc;
use zeroset_eval::Point;
use zeroset_field::field::Field;
use zeroset_field::program::{Limits, Program};
use zeroset_language::load::{Language, Loaded, Options, load_text};
use zeroset_number::{F64, v3};

pub(crate) const TIME: f64 = 0.4;

pub(crate) fn load(text: &str) -> Result<Loaded, String> {
    let options = Options {
        time: TIME,
        bare: true,
        ..Options::default()
    };
    load_text("scene.star", text, Language::Starlark, None, &options).map_err(|e| e.to_string())
}

/// The value of the first object of a scene.
pub(crate) struct Shown(Arc<Program>);

impl Shown {
    pub(crate) fn of(field: &Field) -> Shown {
        Shown(Arc::new(
            Program::compile(field, &Limits::default()).expect("a program"),
        ))
    }

    pub(crate) fn at(&self, [x, y, z]: [f64; 3]) -> f64 {
        Point::<F64>::new(self.0.values())
            .value(v3(F64(x), F64(y), F64(z)))
            .0
    }
}

/// Points of a box around the origin, the same ones every time (Roberts 2018).
pub(crate) fn points(n: u32, half: f64) -> impl Iterator<Item = [f64; 3]> {
    const SHARES: [f64; 3] = [0.819_172_513_4, 0.671_043_606_7, 0.549_700_477_9];
    (1..=n).map(move |k| SHARES.map(|s| half * (2.0 * (0.5 + f64::from(k) * s).fract() - 1.0)))
}
