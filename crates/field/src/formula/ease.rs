//! Easing functions: how something goes from 0 to 1 (Penner 2001, chapter 7).

use super::builder::Expression;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A curve from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Curve {
    Linear,
    Power(i32),
    Sine,
    Expo,
    Circ,
    Back,
    Elastic,
    Bounce,
}

/// Which end of it is gentle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    In,
    Out,
    Both,
}

/// An easing function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ease {
    curve: Curve,
    end: End,
}

/// Curves by name.
const CURVES: [(&str, Curve); 10] = [
    ("quad", Curve::Power(2)),
    ("cubic", Curve::Power(3)),
    ("quart", Curve::Power(4)),
    ("quint", Curve::Power(5)),
    ("sine", Curve::Sine),
    ("expo", Curve::Expo),
    ("circ", Curve::Circ),
    ("back", Curve::Back),
    ("elastic", Curve::Elastic),
    ("bounce", Curve::Bounce),
];

impl Ease {
    /// By its name: "linear", or "in_", "out_" or "in_out_" and a curve, as in "in_out_cubic".
    pub fn named(name: &str) -> Option<Ease> {
        if name == "linear" {
            return Some(Ease {
                curve: Curve::Linear,
                end: End::In,
            });
        }
        let (end, curve) = match name.strip_prefix("in_out_") {
            Some(curve) => (End::Both, curve),
            None => match name.strip_prefix("in_") {
                Some(curve) => (End::In, curve),
                None => (End::Out, name.strip_prefix("out_")?),
            },
        };
        let curve = CURVES.iter().find(|c| c.0 == curve)?.1;
        Some(Ease { curve, end })
    }

    /// The names of all.
    pub fn names() -> Vec<String> {
        let of = |curve: &'static str| ["in", "out", "in_out"].map(|end| format!("{end}_{curve}"));
        std::iter::once("linear".to_owned())
            .chain(CURVES.iter().flat_map(|c| of(c.0)))
            .collect()
    }

    /// The value at `t`, which counts as no less than 0 and no more than 1.
    pub fn at(self, t: &Expression) -> Expression {
        let t = t.clamp(0.0, 1.0);
        match self.end {
            End::In => self.curve.begin(&t),
            End::Out => 1.0 - self.curve.begin(&(1.0 - t)),
            End::Both => {
                let first = self.curve.begin(&(&t * 2.0)) * 0.5;
                let second = 1.0 - self.curve.begin(&(2.0 - &t * 2.0)) * 0.5;
                t.less(0.5).choose(first, second)
            }
        }
    }
}

impl Curve {
    /// The curve that begins gently; it is asked from 0 to 1, and where a choice leaves it out, beyond.
    fn begin(self, t: &Expression) -> Expression {
        match self {
            Curve::Linear => t.clone(),
            Curve::Power(n) => t.powi(n),
            Curve::Sine => 1.0 - (t * FRAC_PI_2).cos(),
            // 2^(10 t - 10), moved and scaled so that it begins at 0 and ends at 1
            Curve::Expo => {
                let least = (-10_f64).exp2();
                ((t * (10.0 * std::f64::consts::LN_2)).exp() * least - least) / (1.0 - least)
            }
            Curve::Circ => 1.0 - (1.0 - t.square()).sqrt(),
            Curve::Back => {
                let s = 1.70158;
                t.square() * (t * (s + 1.0) - s)
            }
            Curve::Elastic => {
                let wave = ((t - 1.075) * (TAU / 0.3)).sin();
                let least = (-10_f64).exp2() * (-1.075 * TAU / 0.3).sin();
                let swing = -((t - 1.0) * (10.0 * std::f64::consts::LN_2)).exp() * wave;
                // a hair is left at 0: it goes to 0 at 1
                swing + (1.0 - t) * least
            }
            // four arcs, each half as long as the one before: 1 minus the bounces out
            Curve::Bounce => {
                let u = 1.0 - t;
                let arc = |middle: f64, height: f64| {
                    let from = &u - middle / 2.75;
                    from.square() * 7.5625 + height
                };
                let arcs = [arc(1.5, 0.75), arc(2.25, 0.9375), arc(2.625, 0.984375)];
                let [second, third, fourth] = arcs;
                let first = u.square() * 7.5625;
                1.0 - first.min(second.min(third.min(fourth)))
            }
        }
    }
}
