//! Formulas of every kind, each written once.

use crate::formulas;
use zeroset_number::{Ends, Real, hash2, v2, v3};

formulas! {
    Sphere |p, a| p.length() - a.get(0);
    Cuboid |p, a| {
        let q = p.abs() - a.vec3(0);
        q.max0().length() + q.max_component().min(0.0)
    };
    Blend |p, a| {
        let (x, y) = (p.length() - a.get(0), (p - a.vec3(0)).xz().length());
        let m = (-(x - y).abs() + a.get(1)).max(0.0);
        x.min(y) - m.sq() * (a.get(1).recip() * 0.25)
    };
    Bulb |p, a| {
        let (_, dr, r) = R::repeat_while(
            a.get(3),
            (p, p.x.lit(1.0), p.length()),
            #[inline(always)] |(_, _, r)| r.below(2.0),
            #[inline(always)] |(z, dr, r)| {
                let (theta, phi) = (z.xy().length().atan2(z.z) * 3.0, z.y.atan2(z.x) * 3.0);
                let r2 = r.max(1e-6).powf(R::constant(2.0));
                let ((st, ct), (sp, cp)) = (theta.sin_cos(), phi.sin_cos());
                let z = v3(st * cp, st * sp, ct) * (r2 * r) + p;
                (z, r2 * dr * 3.0 + 1.0, z.length())
            },
        );
        r.max(1e-6).ln() * 0.5 * r / dr
    };
    Polygon |p, a| {
        let (d2, sign) = a.list(4).fold(
            Ends::Ring,
            (p.x.lit(1e30), p.x.lit(1.0)),
            #[inline(always)] |(d2, sign), a: [R::Scalar; 2], b: [R::Scalar; 2]| {
                let e = v2(b[0], b[1]) - v2(a[0], a[1]);
                let w = p.xy() - v2(a[0], a[1]);
                let t = (w.dot(e) / e.length_squared()).clamp01();
                let (above_a, below_b) = (!p.y.below(a[1]), p.y.below(b[1]));
                let left = (w.y * e.x).above(w.x * e.y);
                let flip = (above_a & below_b & left) | !(above_a | below_b | left);
                let near = v2(w.x - t * e.x, w.y - t * e.y).length_squared();
                (d2.min(near), R::select(flip, -sign, sign))
            },
        );
        d2.sqrt() * sign
    };
    Waves |p, a| p.x.sin() * p.y.cos() + ((p.z * 2.0).sin() * 0.9).asin() * 0.3 + p.x.tanh() + p.y.atan();
    Powers |p, a| (p.x.abs() + 0.1).powf(a.get(0)) + (p.y.sq() + 1.0).ln() + (-p.z).exp() + p.x.exp2();
    Quotients |p, a| (p.x * p.y) / (p.z.sq() + 0.5) + (p.y.abs() + 0.3).recip() - p.z.powi(5) * 0.01;
    Cells |p, a| {
        let cell = v2(p.x, p.z).floor();
        let x = p.x.fract() - hash2(cell);
        v3(x, p.y, p.z.modulo(a.get(1)) - 0.2).length()
    };
    Blends |p, a| p.x.smoothstep(-1.0, 1.5).mix(p.y, 0.3) + p.z.clamp(-0.5, p.x) + p.normalize().y;
}

/// Parameters that all of them can be evaluated with.
pub(crate) const PARAMS: [f32; 12] = [
    1.2, 0.6, 0.9, 6.0, 3.0, 0.7, -0.5, -0.6, -0.4, 0.1, 0.8, 0.0,
];
