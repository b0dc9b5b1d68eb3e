//! Quadrics and their relatives.

use super::*;

/// A stretched ball, exact.
pub struct Ellipsoid;
impl Primitive for Ellipsoid {
    const INFO: Info = solid(
        "Quadrics",
        "ellipsoid",
        "A ball stretched along the axes.",
        "root as in Eberly 2013, found as a secular equation (More and Sorensen 1983)",
        &[vec3(
            "radii",
            Unit::Length,
            &[1.0, 0.6, 0.8],
            SMALL,
            LARGE,
            "Half diameters along x, y and z.",
        )],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[1.0, 1.0, 1.0],
        &[1.0, 0.1, 0.1],
        &[1.0, 1.0, 0.05],
        &[0.2, 2.0, 0.5],
    ];

    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| to_ellipsoid(p, a.vec3(0)),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred(triple(a, 0))
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        (0..3).map(|k| (p[k] / a[k]).powi(2)).sum::<f64>() <= 1.0
    }
}

/// Distance to an ellipsoid with these radii.
///
/// The nearest point of the surface is `r_i^2 p_i / (r_i^2 + t)`, where `t` makes the vector `u_i = r_i p_i / (r_i^2 + t)`
/// one of length 1; the distance is `t |u / r|`. With `t + least^2` in place of `t` nothing cancels.
#[inline(always)]
fn to_ellipsoid<R: Real>(p: Vec3<R>, r: Vec3<R::Scalar>) -> R {
    let least = r.x.min(r.y.min(r.z));
    let q = p.abs().times(r);
    let extra = r.map(
        #[inline(always)]
        |r: R::Scalar| (r - least) * (r + least),
    );
    // Each component alone is at most 1 from here on, and one of them is 1: at or before the root.
    let floor = least * least * 1e-6;
    let start = (q - extra).max_component().max(floor);
    let square = inlined(
        #[inline(always)]
        |t: R| {
            let d = v3(t + extra.x, t + extra.y, t + extra.z);
            let u = q.over(d);
            let s = u.map(
                #[inline(always)]
                |u: R| u.sq(),
            );
            (s.x + s.y + s.z, s.over(d), u)
        },
    );
    // Newton's method on 1 / |u| = 1, which is nearly linear in t and concave: it climbs to the root and does not pass.
    let newton = inlined(
        #[inline(always)]
        |t: R| {
            let (s, slopes, _) = square(t);
            let s = s.max(1e-30);
            let slope = (slopes.x + slopes.y + slopes.z).max(1e-30);
            let step = s * (s.sqrt() - 1.0) / slope;
            (t + step.max(0.0), step / t)
        },
    );
    let (t, _) = R::repeat_while(
        R::constant(12.0),
        (start, p.x.lit(1.0)),
        #[inline(always)]
        |(_, change)| change.above(1e-6),
        #[inline(always)]
        |(t, _)| newton(t),
    );
    let (s, _, u) = square(t);
    // In the middle of a flat ellipsoid there is no root: what is missing to length 1 is along the least radius.
    let missing =
        R::select(t.above(floor * 2.0), t.lit(0.0), s.one_minus().max(0.0)) / (least * least);
    let v = u.over(r);
    let length = (v.length_squared() + missing).sqrt() / s.max(1.0).sqrt();
    (t - least * least) * length
}

/// Between box, ball and octahedron.
pub struct Superquadric;
impl Primitive for Superquadric {
    const INFO: Info = solid(
        "Quadrics",
        "superquadric",
        "A superellipsoid: from an octahedron over a ball to a box.",
        "Barr 1981; exponents as 2 / e of his",
        &[
            vec3(
                "radii",
                Unit::Length,
                &[0.8, 0.8, 0.8],
                SMALL,
                LARGE,
                "Half diameters along x, y and z.",
            ),
            number(
                "around",
                Unit::Ratio,
                &[4.0],
                1.0,
                64.0,
                "Exponent around y: 1 is a rhombus, 2 an ellipse, more a box.",
            ),
            number(
                "upright",
                Unit::Ratio,
                &[4.0],
                1.0,
                64.0,
                "Exponent of the upright outline: as `around`.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[1.0, 1.0, 1.0, 2.0, 2.0],
        &[1.0, 0.5, 0.7, 1.0, 1.3],
        &[0.7, 0.7, 0.4, 16.0, 3.0],
        &[0.5, 1.0, 0.5, 2.0, 1.0],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let r = a.vec3(0);
        let q = p.abs().over(r);
        let flat = power_norm(q.x, q.z, a.get(3));
        (power_norm(flat, q.y, a.get(4)) - 1.0) * r.x.min(r.y.min(r.z))
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred(triple(a, 0))
    }
    /// The value is the least radius times what the shape would have to be scaled by.
    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        let scale = 1.0 + level / a[0].min(a[1]).min(a[2]);
        Aabb::centred(triple(a, 0).map(|r| r * scale))
    }
    fn lipschitz(a: &[f64]) -> f64 {
        let flat = power_norm_slope(1.0 / a[0], 1.0 / a[2], a[3]);
        power_norm_slope(flat, 1.0 / a[1], a[4]) * a[0].min(a[1]).min(a[2])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let q: [f64; 3] = std::array::from_fn(|k| (p[k] / a[k]).abs());
        (q[0].powf(a[3]) + q[2].powf(a[3])).powf(a[4] / a[3]) + q[1].powf(a[4]) <= 1.0
    }
}

/// (x^k + y^k)^(1/k), for x and y not below zero, without overflow.
#[inline(always)]
fn power_norm<R: Real>(x: R, y: R, k: R::Scalar) -> R {
    let (most, least) = ordered(x, y);
    let most = most.max(1e-30);
    let ratio = (least / most).max(1e-9);
    most * (ratio.powf(k) + 1.0).powf(k.recip())
}

/// The largest of (|a u|^k + |b v|^k)^(1/k) for u^2 + v^2 = 1 (Hoelder's inequality, reached).
fn power_norm_slope(a: f64, b: f64, k: f64) -> f64 {
    if k >= 2.0 {
        return a.max(b);
    }
    let s = 2.0 * k / (2.0 - k);
    let most = a.max(b);
    most * ((a / most).powf(s) + (b / most).powf(s)).powf(1.0 / s)
}

/// Any surface of second degree.
pub struct Quadric;

/// The matrix of the squares and products.
fn matrix(a: &[f64]) -> [[f64; 3]; 3] {
    let (s, [yz, zx, xy]) = (triple(a, 0), triple(a, 3).map(|x| 0.5 * x));
    [[s[0], xy, zx], [xy, s[1], yz], [zx, yz, s[2]]]
}

fn determinant(m: &[[f64; 3]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

impl Primitive for Quadric {
    const INFO: Info = solid(
        "Quadrics",
        "quadric",
        "Where a polynomial of second degree in x, y and z is not above zero.",
        "distance bound of second order, Taubin 1994",
        &[
            vec3(
                "squares",
                Unit::Ratio,
                &[1.0, 4.0, 1.0],
                -LARGE,
                LARGE,
                "Factors of x^2, y^2 and z^2.",
            ),
            vec3(
                "products",
                Unit::Ratio,
                &[0.0, 0.0, 0.0],
                -LARGE,
                LARGE,
                "Factors of y z, z x and x y.",
            ),
            vec3(
                "linear",
                Unit::Ratio,
                &[0.0, 0.0, 0.0],
                -LARGE,
                LARGE,
                "Factors of x, y and z.",
            ),
            number(
                "constant",
                Unit::Ratio,
                &[-1.0],
                -LARGE,
                LARGE,
                "What is added.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25],
        &[1.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        &[1.0, -0.5, 2.0, 0.7, -0.4, 1.1, 0.3, -0.2, 0.5, -0.6],
        &[3.0, 2.0, 1.0, 0.5, -1.0, 0.8, 0.3, -0.2, 0.5, -1.0],
    ];

    /// With the gradient g = q' at p and a bound l of the matrix's norm, q changes by at most |g| t + l t^2 over a way of
    /// length t. The t for which that is |q| is a distance bound; and as |g| changes by at most 2 l a unit length, the slope
    /// of t is at most 1: (|g| + 2 l t) |t'| <= |g| + 2 l t.
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (squares, products, linear) = (a.vec3(0), a.vec3(3), a.vec3(6));
        let h = v3(products.x * 0.5, products.y * 0.5, products.z * 0.5);
        let m = v3(
            p.x * squares.x + p.y * h.z + p.z * h.y,
            p.x * h.z + p.y * squares.y + p.z * h.x,
            p.x * h.y + p.y * h.x + p.z * squares.z,
        );
        let value = p.dot(m + linear) + a.get(9);
        let slope = (m * 2.0 + linear).length();
        // Frobenius' norm and the largest sum of a row, whichever is less.
        let (s, o) = (squares.abs(), h.abs());
        let frobenius = (squares.length_squared() + h.length_squared() * 2.0).sqrt();
        let rows = (s.x + o.y + o.z).max((s.y + o.x + o.z).max(s.z + o.x + o.y));
        second_order(value, slope, frobenius.min(rows))
    }

    fn bounds(a: &[f64]) -> Aabb {
        // An ellipsoid has a box: its centre solves 2 M c = -b, its reach along an axis is sqrt(k (M^-1)_ii).
        let m = matrix(a);
        let minors = [
            m[0][0],
            m[0][0] * m[1][1] - m[0][1] * m[0][1],
            determinant(&m),
        ];
        if !minors
            .iter()
            .all(|&d| d > 1e-9 * m[0][0].abs().max(SMALL * SMALL))
        {
            return Aabb::WHOLE;
        }
        let det = minors[2];
        let inverse = |i: usize, j: usize| {
            let (r, c) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
            (m[r[0]][c[0]] * m[r[1]][c[1]] - m[r[0]][c[1]] * m[r[1]][c[0]]) / det
        };
        let b = triple(a, 6);
        let centre: [f64; 3] =
            std::array::from_fn(|i| -0.5 * (0..3).map(|j| inverse(i, j) * b[j]).sum::<f64>());
        let left = -a[9] - 0.5 * (0..3).map(|i| b[i] * centre[i]).sum::<f64>();
        if left < 0.0 {
            return Aabb::EMPTY;
        }
        let reach: [f64; 3] = std::array::from_fn(|i| (left * inverse(i, i)).sqrt());
        Aabb::new(
            std::array::from_fn(|k| centre[k] - reach[k]),
            std::array::from_fn(|k| centre[k] + reach[k]),
        )
    }

    /// The value bends with the slope at the point: no box is claimed for its level sets.
    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        if level > 0.0 {
            Aabb::WHOLE
        } else {
            Self::bounds(a)
        }
    }

    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        a[0] * x * x
            + a[1] * y * y
            + a[2] * z * z
            + a[3] * y * z
            + a[4] * z * x
            + a[5] * x * y
            + a[6] * x
            + a[7] * y
            + a[8] * z
            + a[9]
            <= 0.0
    }

    fn check(a: &[f64]) -> Result<(), String> {
        if a[..9].iter().any(|&x| x != 0.0) {
            Ok(())
        } else {
            Err("one of squares, products and linear must not be zero".into())
        }
    }
}

/// The distance bound of a function from its `value`, the length of its gradient, and the largest norm of half its second
/// derivative: the t with `slope t + bend t^2 = |value|`, with the sign of the value.
#[inline(always)]
pub(super) fn second_order<R: Real>(value: R, slope: R, bend: R::Scalar) -> R {
    let root = (slope.sq() + value.abs() * (bend * 4.0)).sqrt();
    value * 2.0 / (slope + root).max(1e-30)
}
