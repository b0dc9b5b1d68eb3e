//! Balls, what is cut from them, and rings.

use super::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

/// A ball.
pub struct Sphere;
impl Primitive for Sphere {
    const INFO: Info = solid(
        "Round solids",
        "sphere",
        "A ball around the origin.",
        "",
        &[size(
            "radius",
            &[1.0],
            "Distance from the centre to the surface.",
        )],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.01], &[250.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        p.length() - a.get(0)
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0]; 3])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        x * x + y * y + z * z <= a[0] * a[0]
    }
}

/// A ball cut by a horizontal plane.
pub struct CutSphere;
impl Primitive for CutSphere {
    const INFO: Info = solid(
        "Round solids",
        "cut_sphere",
        "The part of a ball above a horizontal plane.",
        "",
        &[
            size("radius", &[1.0], "Radius of the ball."),
            number(
                "height",
                Unit::Length,
                &[0.2],
                -LARGE,
                LARGE,
                "Height of the plane; less than the radius.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, -0.6], &[1.0, 0.0], &[2.0, 1.7]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (radius, height) = (a.get(0), a.get(1));
        let rim = (radius * radius - height * height).max(0.0).sqrt();
        let q = meridian(p);
        // Seen from the centre past the rim, and not below the disc: the rim is nearest.
        let past = (q.x * height).above(q.y * rim) & q.x.above(rim);
        let solid = (q.length() - radius).max(-(q.y - height));
        R::select(past, length2(q.x - rim, q.y - height), solid)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let wide = if a[1] > 0.0 {
            (a[0] * a[0] - a[1] * a[1]).max(0.0).sqrt()
        } else {
            a[0]
        };
        Aabb::new([-wide, a[1], -wide], [wide, a[0], wide])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        p[1] >= a[1] && Sphere::contains(a, p)
    }
    fn check(a: &[f64]) -> Result<(), String> {
        below_radius(a)
    }
}

fn below_radius(a: &[f64]) -> Result<(), String> {
    if a[1].abs() < a[0] {
        Ok(())
    } else {
        Err(format!(
            "height must lie between -radius and radius, -{0} and {0}, not {1}",
            a[0], a[1]
        ))
    }
}

/// A bowl.
pub struct CutHollowSphere;
impl Primitive for CutHollowSphere {
    const INFO: Info = solid(
        "Round solids",
        "cut_hollow_sphere",
        "A bowl with a round rim: the shell of a ball below a plane.",
        "",
        &[
            size("radius", &[1.0], "Radius of the middle of the shell."),
            number(
                "height",
                Unit::Length,
                &[0.2],
                -LARGE,
                LARGE,
                "Height of the rim; less than the radius.",
            ),
            size("thickness", &[0.1], "Full thickness of the shell."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[1.0, -0.5, 0.2], &[1.0, 0.0, 0.02], &[2.0, 1.8, 0.4]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (radius, height) = (a.get(0), a.get(1));
        let rim = (radius * radius - height * height).max(0.0).sqrt();
        let q = meridian(p);
        let above = (q.y * rim).above(q.x * height);
        let shell = (q.length() - radius).abs();
        R::select(above, length2(q.x - rim, q.y - height), shell) - a.get(2) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        let (radius, height, t) = (a[0], a[1], 0.5 * a[2]);
        let wide = t + if height < 0.0 {
            (radius * radius - height * height).max(0.0).sqrt()
        } else {
            radius
        };
        Aabb::new([-wide, -radius - t, -wide], [wide, height + t, wide])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // The nearest angle from the top that the shell has.
        let (x, y) = (p[0].hypot(p[2]), p[1]);
        let angle = x.atan2(y).max((a[1] / a[0]).acos());
        let (s, c) = angle.sin_cos();
        2.0 * (x - a[0] * s).hypot(y - a[0] * c) <= a[2]
    }
    fn check(a: &[f64]) -> Result<(), String> {
        below_radius(a)
    }
}

/// A ball with a ball bitten out of its top.
pub struct DeathStar;
impl Primitive for DeathStar {
    const INFO: Info = solid(
        "Round solids",
        "death_star",
        "A ball with a ball bitten out of its top.",
        "",
        &[
            size("radius", &[1.0], "Radius of the ball."),
            size("bite", &[0.7], "Radius of the ball that is taken away."),
            size(
                "distance",
                &[1.1],
                "Distance between the centres; the surfaces must meet.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[1.0, 1.5, 1.2], &[1.0, 0.3, 0.8], &[0.5, 2.0, 2.4]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (radius, bite, apart) = (a.get(0), a.get(1), a.get(2));
        // Height and radius of the rim.
        let height = (radius * radius - bite * bite + apart * apart) / (apart * 2.0);
        let rim = (radius * radius - height * height).max(0.0).sqrt();
        let q = meridian(p);
        // Outside the cone from the centre through the rim, and inside the one from the bite's centre, the balls are
        // nearest; else the rim.
        let over =
            (q.y * rim).above(q.x * height) & ((q.y - apart) * rim).above(q.x * (height - apart));
        let ball = q.length() - radius;
        let hole = -(length2(q.x, q.y - apart) - bite);
        R::select(over, length2(q.x - rim, q.y - height), ball.max(hole))
    }
    fn bounds(a: &[f64]) -> Aabb {
        let (radius, bite, apart) = (a[0], a[1], a[2]);
        let height = (radius * radius - bite * bite + apart * apart) / (2.0 * apart);
        let wide = if height < 0.0 {
            (radius * radius - height * height).max(0.0).sqrt()
        } else {
            radius
        };
        Aabb::new([-wide, -radius, -wide], [wide, height.max(-radius), wide])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let [x, y, z] = p;
        Sphere::contains(a, p) && x * x + (y - a[2]) * (y - a[2]) + z * z >= a[1] * a[1]
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let (least, most) = ((a[0] - a[1]).abs(), a[0] + a[1]);
        if least < a[2] && a[2] < most {
            Ok(())
        } else {
            Err(format!(
                "distance must lie between {least} and {most}, so that the surfaces meet, not {}",
                a[2]
            ))
        }
    }
}

/// A sector of a ball.
pub struct SolidAngle;
impl Primitive for SolidAngle {
    const INFO: Info = solid(
        "Round solids",
        "solid_angle",
        "The part of a ball within a cone that opens upwards from its centre.",
        "",
        &[
            size("radius", &[1.0], "Radius of the ball."),
            number(
                "angle",
                Unit::Angle,
                &[FRAC_PI_6],
                1e-3,
                PI - 1e-3,
                "Angle from the axis to the cone.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 1.0], &[2.0, 2.5], &[1.0, FRAC_PI_2]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (radius, (s, c)) = (a.get(0), a.get(1).sin_cos());
        let q = meridian(p);
        // Along the cone's generator and over it.
        let (along, over) = (q.x * s + q.y * c, q.x * c - q.y * s);
        let beyond = along - along.clamp(0.0, radius);
        let end = length2(over, beyond);
        let side = R::select(
            beyond.abs().above(0.0),
            R::select(over.negative(), -end, end),
            over,
        );
        (q.length() - radius).max(side)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let (s, c) = a[1].sin_cos();
        let wide = a[0] * if a[1] < FRAC_PI_2 { s } else { 1.0 };
        Aabb::new([-wide, a[0] * c.min(0.0), -wide], [wide, a[0], wide])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        Sphere::contains(a, p) && p[0].hypot(p[2]).atan2(p[1]) <= a[1]
    }
}

/// A lens turned into a spindle.
pub struct VesicaSegment;
impl Primitive for VesicaSegment {
    const INFO: Info = solid(
        "Round solids",
        "vesica_segment",
        "A spindle between two points: the turned overlap of two circles.",
        "",
        &[
            vec3(
                "start",
                Unit::Length,
                &[0.0, -1.0, 0.0],
                -LARGE,
                LARGE,
                "First tip.",
            ),
            vec3(
                "end",
                Unit::Length,
                &[0.0, 1.0, 0.0],
                -LARGE,
                LARGE,
                "Second tip.",
            ),
            size(
                "width",
                &[0.7],
                "Full width in the middle; at most the distance of the tips.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[-1.0, 0.3, 0.2, 0.8, 0.5, -0.4, 0.5],
        &[0.0, -0.5, 0.0, 0.0, 0.5, 0.0, 1.0],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (start, end, wide) = (a.vec3(0), a.vec3(3), a.get(6) * 0.5);
        let (axis, middle) = (end - start, (end + start) * 0.5);
        let tip = axis.length() * 0.5;
        let axis = axis / (tip * 2.0);
        let p = p - middle;
        let along = p.dot(axis);
        let out = v3(
            p.x - along * axis.x,
            p.y - along * axis.y,
            p.z - along * axis.z,
        );
        let q = v2(out.length(), along.abs());
        // The arc's centre lies `back` behind the axis.
        let back = (tip * tip - wide * wide) / (wide * 2.0);
        let past = ((q.y - tip) * back).above(q.x * tip);
        R::select(
            past,
            length2(q.x, q.y - tip),
            length2(q.x + back, q.y) - (back + wide),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        // The spindle's reach along a direction at angle t from the axis: the arc's where its normal points there, else the
        // tip's.
        let (start, end, wide) = (triple(a, 0), triple(a, 3), 0.5 * a[6]);
        let axis: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
        let tip = 0.5 * axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let back = (tip * tip - wide * wide) / (2.0 * wide);
        let half: [f64; 3] = std::array::from_fn(|k| {
            let c = (axis[k] / (2.0 * tip)).abs().min(1.0);
            let s = (1.0 - c * c).sqrt();
            if c * (back + wide) < tip {
                (back + wide) - back * s
            } else {
                tip * c
            }
        });
        let centre: [f64; 3] = std::array::from_fn(|k| 0.5 * (start[k] + end[k]));
        Aabb::new(
            std::array::from_fn(|k| centre[k] - half[k]),
            std::array::from_fn(|k| centre[k] + half[k]),
        )
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // The circles' radius from the sagitta: half the chord squared is s (2 r - s).
        let (start, end, wide) = (triple(a, 0), triple(a, 3), 0.5 * a[6]);
        let chord: f64 = (0..3).map(|k| (end[k] - start[k]).powi(2)).sum();
        let t = (0..3)
            .map(|k| (p[k] - start[k]) * (end[k] - start[k]))
            .sum::<f64>()
            / chord;
        let out = (0..3)
            .map(|k| (p[k] - start[k] - t * (end[k] - start[k])).powi(2))
            .sum::<f64>()
            .sqrt();
        let radius = (0.25 * chord / wide + wide) / 2.0;
        let y = (t - 0.5) * chord.sqrt();
        (out + radius - wide).powi(2) + y * y <= radius * radius
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let most = (0..3)
            .map(|k| (a[3 + k] - a[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        if a[6] <= most {
            Ok(())
        } else {
            Err(format!(
                "width must be at most the distance of the tips, {most}, not {}",
                a[6]
            ))
        }
    }
}

const TUBE: Param = size("tube", &[0.25], "Radius of the tube.");

/// A ring.
pub struct Torus;
impl Primitive for Torus {
    const INFO: Info = solid(
        "Rings",
        "torus",
        "A ring that lies flat.",
        "",
        &[
            size(
                "radius",
                &[0.75],
                "From the centre to the middle of the tube.",
            ),
            TUBE,
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.02], &[0.5, 0.45]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let q = meridian(p);
        length2(q.x - a.get(0), q.y) - a.get(1)
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0] + a[1], a[1], a[0] + a[1]])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        // The quartic: (r^2 + R^2 - t^2)^2 <= 4 R^2 (x^2 + z^2).
        let flat = x * x + z * z;
        let s = flat + y * y + a[0] * a[0] - a[1] * a[1];
        s <= 0.0 || s * s <= 4.0 * a[0] * a[0] * flat
    }
    fn check(a: &[f64]) -> Result<(), String> {
        thin(a[1], a[0])
    }
}

fn thin(tube: f64, radius: f64) -> Result<(), String> {
    if tube <= radius {
        Ok(())
    } else {
        Err(format!(
            "tube must be at most the radius, {radius}, not {tube}"
        ))
    }
}

/// A piece of a ring.
pub struct CappedTorus;
impl Primitive for CappedTorus {
    const INFO: Info = solid(
        "Rings",
        "capped_torus",
        "A piece of a flat ring, around the z axis, with round ends.",
        "",
        &[
            size(
                "radius",
                &[0.75],
                "From the centre to the middle of the tube.",
            ),
            TUBE,
            number(
                "angle",
                Unit::Angle,
                &[2.0 * FRAC_PI_6],
                0.0,
                PI,
                "Angle from the z axis to an end.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[1.0, 0.1, 2.5], &[1.0, 0.3, 0.5], &[1.0, 0.2, PI]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        // At half a turn, rounding must not leave a gap.
        let (radius, (s, c)) = (a.get(0), a.get(2).sin_cos());
        let (s, x) = (s.max(0.0), p.x.abs());
        let past = (x * c).above(p.z * s);
        let end = R::norm([x - radius * s, p.y, p.z - radius * c]);
        let ring = length2(length2(x, p.z) - radius, p.y);
        R::select(past, end, ring) - a.get(1)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let (radius, tube, (s, c)) = (a[0], a[1], a[2].sin_cos());
        let wide = if a[2] > FRAC_PI_2 { radius } else { radius * s };
        Aabb::new(
            [-wide - tube, -tube, radius * c - tube],
            [wide + tube, tube, radius + tube],
        )
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        let angle = x.abs().atan2(z).min(a[2]);
        let (s, c) = angle.sin_cos();
        (x.abs() - a[0] * s).powi(2) + y * y + (z - a[0] * c).powi(2) <= a[1] * a[1]
    }
}

/// A link of a chain.
pub struct Link;
impl Primitive for Link {
    const INFO: Info = solid(
        "Rings",
        "link",
        "A link of a chain, upright in the xy plane.",
        "",
        &[
            number(
                "length",
                Unit::Length,
                &[0.6],
                0.0,
                LARGE,
                "Length of the straight part.",
            ),
            size(
                "radius",
                &[0.4],
                "Radius of the bends, to the middle of the tube.",
            ),
            size("tube", &[0.12], "Radius of the tube."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.5, 0.4], &[0.0, 1.0, 0.3]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let y = (p.y.abs() - a.get(0) * 0.5).max(0.0);
        length2(length2(p.x, y) - a.get(1), p.z) - a.get(2)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let reach = a[1] + a[2];
        Aabb::centred([reach, 0.5 * a[0] + reach, a[2]])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        let half = 0.5 * a[0];
        let straight = y.abs() <= half && (x.abs() - a[1]).hypot(z) <= a[2];
        let bend = y.abs() >= half && Torus::contains(&a[1..], [x, z, y.abs() - half]);
        straight || bend
    }
    fn check(a: &[f64]) -> Result<(), String> {
        thin(a[2], a[1])
    }
}
