//! Triply periodic surfaces, as sheets with a thickness.
//!
//! Their nodal approximations (von Schnering and Nesper 1991) are sums of waves a cos(k . x + f). The second derivative of
//! such a sum along a unit vector u is at most the sum of a (k . u)^2, which for the cubic sets of k is the same for all u.
//! That bound makes them distance bounds of second order, as [`Quadric`](super::Quadric): near the sheet's middle the value is
//! the distance, and the slope is at most 1 everywhere.

use super::quadric::second_order;
use super::*;
use std::f64::consts::{SQRT_2, TAU};

/// Sine and cosine of the three coordinates.
struct Waves<R> {
    s: Vec3<R>,
    c: Vec3<R>,
}

/// A surface's value and gradient, written over the sines and cosines, for period 2 pi.
trait Surface {
    /// Largest second derivative along any direction.
    const BEND: f64;
    fn value<R: Real>(w: &Waves<R>) -> R;
    fn gradient<R: Real>(w: &Waves<R>) -> Vec3<R>;
}

#[inline(always)]
fn sheet<S: Surface, R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
    let rate = a.get(0).recip() * R::constant(TAU);
    let ((sx, cx), (sy, cy), (sz, cz)) = (
        (p.x * rate).sin_cos(),
        (p.y * rate).sin_cos(),
        (p.z * rate).sin_cos(),
    );
    let w = Waves {
        s: v3(sx, sy, sz),
        c: v3(cx, cy, cz),
    };
    let distance = second_order(
        S::value(&w),
        S::gradient(&w).length(),
        R::constant(0.5 * S::BEND),
    );
    distance.abs() / rate - a.get(1) * 0.5
}

const PARAMS: &[Param] = &[
    size("period", &[1.0], "Side of the cube that repeats."),
    size(
        "thickness",
        &[0.1],
        "Full thickness of the sheet, as far as it is flat.",
    ),
];

macro_rules! periodic {
    ($(#[$doc:meta] $entry:ident $name:literal, $says:literal, $bend:expr,
        |$w:ident| $value:expr, $gradient:expr, |$x:ident, $y:ident, $z:ident| $plain:expr;)*) => {$(
        #[$doc]
        pub struct $entry;
        impl Surface for $entry {
            const BEND: f64 = $bend;
            #[inline(always)]
            fn value<R: Real>($w: &Waves<R>) -> R {
                $value
            }
            #[inline(always)]
            fn gradient<R: Real>($w: &Waves<R>) -> Vec3<R> {
                $gradient
            }
        }
        impl Primitive for $entry {
            const INFO: Info =
                solid("Periodic surfaces", $name, $says, "von Schnering and Nesper 1991; bound of second order, Taubin 1994", PARAMS);
            const EXACTNESS: Exactness = Exactness::Bound;
            const SAMPLES: &'static [&'static [f64]] = &[&[2.5, 0.05], &[1.0, 0.2]];
            #[inline(always)]
            fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
                sheet::<Self, R>(p, a)
            }
            fn bounds(_a: &[f64]) -> Aabb {
                Aabb::WHOLE
            }
            fn contains(a: &[f64], p: [f64; 3]) -> bool {
                in_sheet(a, $bend, p, |$x: f64, $y: f64, $z: f64| $plain)
            }
        }
    )*};
}

/// Whether a way of half the thickness could reach the surface: |value| <= |gradient| t + bend t^2 / 2.
fn in_sheet(a: &[f64], bend: f64, p: [f64; 3], value: impl Fn(f64, f64, f64) -> f64) -> bool {
    let rate = TAU / a[0];
    let at = |p: [f64; 3]| value(rate * p[0], rate * p[1], rate * p[2]);
    // The gradient by differences of sixth order.
    let h = 0.01 / rate;
    let slope = (0..3).map(|k| {
        let step = |n: f64| {
            let (mut u, mut v) = (p, p);
            u[k] += n * h;
            v[k] -= n * h;
            at(u) - at(v)
        };
        ((45.0 * step(1.0) - 9.0 * step(2.0) + step(3.0)) / (60.0 * h)).powi(2)
    });
    let (slope, t) = (slope.sum::<f64>().sqrt(), 0.5 * a[1]);
    at(p).abs() <= slope * t + 0.5 * bend * rate * rate * t * t
}

periodic! {
    /// Schoen's gyroid.
    Gyroid "gyroid", "Schoen's gyroid, a sheet without straight lines that fills space.", 2.0,
    |w| w.s.x * w.c.y + w.s.y * w.c.z + w.s.z * w.c.x,
    v3(w.c.x * w.c.y - w.s.z * w.s.x, w.c.y * w.c.z - w.s.x * w.s.y, w.c.z * w.c.x - w.s.y * w.s.z),
    |x, y, z| x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos();
    /// Schwarz' primitive surface.
    SchwarzP "schwarz_p", "Schwarz' primitive surface: a cubic lattice of tunnels.", 1.0,
    |w| w.c.x + w.c.y + w.c.z,
    w.s,
    |x, y, z| x.cos() + y.cos() + z.cos();
    /// Schwarz' diamond surface.
    SchwarzD "schwarz_d", "Schwarz' diamond surface: tunnels along the bonds of diamond.", SQRT_2,
    |w| w.c.x * w.c.y * w.c.z - w.s.x * w.s.y * w.s.z,
    v3(
        w.s.x * w.c.y * w.c.z + w.c.x * w.s.y * w.s.z,
        w.c.x * w.s.y * w.c.z + w.s.x * w.c.y * w.s.z,
        w.c.x * w.c.y * w.s.z + w.s.x * w.s.y * w.c.z,
    ),
    |x, y, z| x.cos() * y.cos() * z.cos() - x.sin() * y.sin() * z.sin();
    /// Neovius' surface.
    Neovius "neovius", "Neovius' surface: chambers joined through the edges of the cube.", 7.0,
    |w| (w.c.x + w.c.y + w.c.z) * 3.0 + w.c.x * w.c.y * w.c.z * 4.0,
    v3(
        w.s.x * (w.c.y * w.c.z * 4.0 + 3.0),
        w.s.y * (w.c.z * w.c.x * 4.0 + 3.0),
        w.s.z * (w.c.x * w.c.y * 4.0 + 3.0),
    ),
    |x, y, z| 3.0 * (x.cos() + y.cos() + z.cos()) + 4.0 * x.cos() * y.cos() * z.cos();
    /// Schoen's I-WP.
    Iwp "iwp", "Schoen's I-WP: chambers joined through the corners of the cube.", 8.0,
    |w| (w.c.x * w.c.y + w.c.y * w.c.z + w.c.z * w.c.x) * 2.0 - (w.c.x.sq() + w.c.y.sq() + w.c.z.sq()) * 2.0 + 3.0,
    v3(
        w.s.x * (w.c.y + w.c.z - w.c.x * 2.0) * 2.0,
        w.s.y * (w.c.z + w.c.x - w.c.y * 2.0) * 2.0,
        w.s.z * (w.c.x + w.c.y - w.c.z * 2.0) * 2.0,
    ),
    |x, y, z| {
        let products = x.cos() * y.cos() + y.cos() * z.cos() + z.cos() * x.cos();
        2.0 * products - ((2.0 * x).cos() + (2.0 * y).cos() + (2.0 * z).cos())
    };
}
