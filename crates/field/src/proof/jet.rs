//! What is known of a step of a formula over a box.

use crate::formula::Inner;
use std::f64::consts::PI;
use zeroset_catalogue::op::arithmetic::{self, TINY};
use zeroset_catalogue::op::arithmetic::{Binary, NoiseKind, Unary};
use zeroset_number::{F64, Interval, Real, Slope, v3};

/// What is known of a step over a box: ranges of its value and gradient, and more that [`Slope`] does not hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet {
    /// Value, gradient, and a bound on the gradient's length.
    pub(crate) slope: Slope,
    /// A bound on the gradient's length divided by the value's magnitude. Through it the logarithm of a sum of
    /// exponentials keeps the slope of the exponents.
    relative: f64,
    /// Whether an angle jumps by a whole turn somewhere in the box, and the ranges are those of its pieces.
    pub(crate) turned: bool,
}

const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };
const WHOLE: Interval = Interval {
    lo: f64::NEG_INFINITY,
    hi: f64::INFINITY,
};

/// For the few roundings of a bound that is computed in plain numbers.
const UP: f64 = 1.0 + 1e-14;

/// `a b`, where 0 times endless is 0: an endless bound stands for every large number.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// Bound on the length of a vector of ranges, or the bound `l` that is known.
fn longest(d: &[Interval; 3], l: f64) -> f64 {
    let length = d.iter().map(|d| d.mag() * d.mag()).sum::<f64>().sqrt() * UP;
    match (length.is_nan(), l.is_nan()) {
        (false, false) => length.min(l),
        (false, true) => length,
        (true, false) => l,
        (true, true) => f64::INFINITY,
    }
}

fn is_finite(x: Interval) -> bool {
    x.lo.is_finite() && x.hi.is_finite()
}

/// Range of `x^e` for x above 0: it is monotone in each, so it is largest and smallest at corners.
fn power(x: Interval, e: Interval) -> Interval {
    let corners = [(x.lo, e.lo), (x.lo, e.hi), (x.hi, e.lo), (x.hi, e.hi)].map(|(x, e)| x.powf(e));
    let lo = corners.iter().copied().fold(f64::INFINITY, f64::min);
    let hi = corners.iter().copied().fold(0.0, f64::max);
    Interval {
        lo: lo * (1.0 - 1e-14),
        hi: hi * UP + f64::MIN_POSITIVE,
    }
}

impl Jet {
    pub(crate) fn coordinate(slope: Slope) -> Jet {
        Jet::new(slope, f64::INFINITY, false)
    }

    /// A constant, as it is and as single precision holds it.
    pub(crate) fn constant(c: f64) -> Jet {
        let single = f64::from(c as f32);
        let v = Interval {
            lo: c.min(single),
            hi: c.max(single),
        };
        let d = [ZERO; 3];
        Jet {
            slope: Slope { v, d, l: 0.0 },
            relative: 0.0,
            turned: false,
        }
    }

    /// With what the two bounds say of each other.
    fn new(mut slope: Slope, relative: f64, turned: bool) -> Jet {
        let least = slope.v.lo.max(-slope.v.hi);
        let direct = if least > 0.0 {
            slope.l / least * UP
        } else {
            f64::INFINITY
        };
        // also where it is NaN
        let relative = if relative < direct { relative } else { direct };
        let length = times(relative, slope.v.mag()) * UP;
        if length < slope.l {
            slope.l = length;
        }
        Jet {
            slope,
            relative,
            turned,
        }
    }

    pub(crate) fn value(&self) -> Interval {
        self.slope.v
    }

    /// Whether the value is a number everywhere, of single precision.
    pub(crate) fn is_defined(&self) -> bool {
        self.slope.v.mag() < f64::from(f32::MAX)
    }

    /// Whether it is defined and its gradient has a bound, if only a useless one.
    pub(crate) fn is_bounded(&self) -> bool {
        self.slope.l < 1e12 && self.is_defined()
    }

    /// Marks a value that jumps somewhere in the box.
    pub(crate) fn break_off(&mut self) {
        self.slope.d = [WHOLE; 3];
        self.slope.l = f64::INFINITY;
        self.relative = f64::INFINITY;
        self.turned = false;
    }

    /// A function of one step.
    pub(crate) fn unary(f: Unary, x: &Jet) -> Jet {
        let mut slope = arithmetic::unary(f, x.slope);
        let relative = match f {
            Unary::Neg | Unary::Abs => x.relative,
            Unary::Square => 2.0 * x.relative,
            Unary::Sqrt => 0.5 * x.relative,
            Unary::Exp => x.slope.l,
            _ => f64::INFINITY,
        };
        if f == Unary::Ln && x.slope.v.lo > f64::from(TINY) {
            slope.l = slope.l.min(x.relative);
        }
        Jet::new(slope, relative * UP, x.turned)
    }

    /// A function of two steps; `exponent` says that the second one is a constant.
    pub(crate) fn binary(f: Binary, x: &Jet, y: &Jet, exponent: bool) -> Jet {
        let (v, w) = (x.slope.v, y.slope.v);
        let turned = x.turned || y.turned;
        let larger = x.relative.max(y.relative);
        let same_sign =
            |v: Interval, w: Interval| (v.lo >= 0.0 && w.lo >= 0.0) || (v.hi <= 0.0 && w.hi <= 0.0);
        let (mut slope, relative) = match f {
            Binary::Atan2 => return Jet::angle(x, y),
            Binary::Pow if exponent => (Jet::power(x, w), w.mag() * x.relative),
            f => {
                let relative = match f {
                    Binary::Add if same_sign(v, w) => larger,
                    Binary::Sub if same_sign(v, -w) => larger,
                    Binary::Mul | Binary::Div => x.relative + y.relative,
                    Binary::Min | Binary::Max | Binary::Hypot => larger,
                    _ => f64::INFINITY,
                };
                (arithmetic::binary(f, x.slope, y.slope), relative)
            }
        };
        // what is no number: infinity times 0, and 0 by 0
        let undefined = match f {
            Binary::Mul => !is_finite(v) || !is_finite(w),
            Binary::Div | Binary::Modulo => w.lo <= 0.0 && w.hi >= 0.0,
            _ => false,
        };
        if undefined {
            slope.v = WHOLE;
        }
        Jet::new(slope, relative * UP, turned)
    }

    /// A noise at a point of three steps.
    pub(crate) fn noise(kind: NoiseKind, [x, y, z]: [&Jet; 3]) -> Jet {
        let slope = arithmetic::noise(kind, v3(x.slope, y.slope, z.slope));
        Jet::new(slope, f64::INFINITY, x.turned || y.turned || z.turned)
    }

    /// The value of a field at a point of three steps. What is known of it is its value in the middle of where that point may
    /// be, and that it changes by no more than its Lipschitz constant times the way.
    pub(crate) fn field(field: &Inner, q: [&Jet; 3]) -> Jet {
        // a hair more: the program holds the field's numbers in single precision
        let lipschitz = (field.field().facts().slope * (1.0 + 1e-6)) as f32;
        let lipschitz = lipschitz.next_up();
        let ranges = q.map(|jet| jet.slope.v);
        let mut v = WHOLE;
        if ranges.into_iter().all(is_finite) {
            let middle = ranges.map(|r| 0.5 * (r.lo + r.hi));
            let [x, y, z] = middle.map(F64);
            let value = field.value(v3(x, y, z)).0;
            let half = ranges.map(|r| 0.5 * (r.hi - r.lo));
            let way = half[0].hypot(half[1]).hypot(half[2]) * UP;
            let change = f64::from(lipschitz) * way + 1e-6 * value.abs();
            if value.is_finite() {
                v = Interval {
                    lo: value - change,
                    hi: value + change,
                };
            }
        }
        let [x, y, z] = q.map(|jet| jet.slope);
        let anything = Slope {
            v,
            d: [WHOLE; 3],
            l: f64::INFINITY,
        };
        let slope = anything.proven(f32::NEG_INFINITY, f32::INFINITY, v3(x, y, z), lipschitz);
        Jet::new(slope, f64::INFINITY, q.iter().any(|jet| jet.turned))
    }

    /// A condition or half a choice, whose jumps are the choice's to account for.
    pub(crate) fn quiet(mut self) -> Jet {
        self.slope.d = [ZERO; 3];
        self.slope.l = 0.0;
        self.turned = false;
        self
    }

    /// One of two steps, nobody knows which.
    pub(crate) fn one_of(x: &Jet, y: &Jet) -> Jet {
        let (a, b) = (x.slope, y.slope);
        let slope = Slope {
            v: a.v.hull(b.v),
            d: std::array::from_fn(|k| a.d[k].hull(b.d[k])),
            l: a.l.max(b.l),
        };
        Jet::new(slope, x.relative.max(y.relative), x.turned || y.turned)
    }

    /// The sum of two steps one of which is 0 wherever the other is not.
    pub(crate) fn either(x: &Jet, y: &Jet) -> Jet {
        let (a, b) = (x.slope, y.slope);
        let slope = Slope {
            v: a.v + b.v,
            d: std::array::from_fn(|k| a.d[k].hull(b.d[k])),
            l: a.l.max(b.l),
        };
        Jet::new(slope, x.relative.max(y.relative), x.turned || y.turned)
    }

    /// The angle of the point (y, x). Its gradient `(x dy - y dx) / (x^2 + y^2)` knows no jump, where the angle itself goes
    /// from pi to -pi.
    fn angle(y: &Jet, x: &Jet) -> Jet {
        let (v, w) = (y.slope.v, x.slope.v);
        let crossed = w.lo < 0.0 && v.lo <= 0.0 && v.hi >= 0.0;
        let rr = v.sq() + w.sq();
        if rr.lo <= 0.0 {
            // the origin has no angle
            let mut jet = Jet::new(
                arithmetic::binary(Binary::Atan2, y.slope, x.slope),
                f64::INFINITY,
                false,
            );
            jet.break_off();
            return jet;
        }
        let (a, b) = (w / rr, v / rr);
        let d: [Interval; 3] = std::array::from_fn(|k| y.slope.d[k] * a - x.slope.d[k] * b);
        let turn = PI.next_up();
        let slope = Slope {
            v: if crossed {
                Interval {
                    lo: -turn,
                    hi: turn,
                }
            } else {
                v.atan2(w)
            },
            d,
            l: longest(&d, x.slope.l.hypot(y.slope.l) / rr.lo.sqrt() * UP),
        };
        Jet::new(slope, f64::INFINITY, crossed || x.turned || y.turned)
    }

    /// `x^k` for a constant k, where x counts as no less than [`TINY`].
    fn power(x: &Jet, k: Interval) -> Slope {
        let v = x.slope.v;
        let tiny = f64::from(TINY);
        let base = Interval {
            lo: v.lo.max(tiny),
            hi: v.hi.max(tiny),
        };
        let less = if k.lo == k.hi {
            Interval {
                lo: k.lo - 1.0,
                hi: k.hi - 1.0,
            }
        } else {
            k - 1.0
        };
        let slope = k * power(base, less);
        let first = if v.lo > tiny {
            slope
        } else if v.hi <= tiny || (k.lo == 0.0 && k.hi == 0.0) {
            ZERO
        } else if k.lo >= 1.0 {
            // flat up to the smallest number, then a power
            slope.hull(ZERO)
        } else {
            WHOLE
        };
        let d = x.slope.d.map(|d| d * first);
        Slope {
            v: power(base, k),
            d,
            l: longest(&d, times(first.mag(), x.slope.l) * UP),
        }
    }
}
