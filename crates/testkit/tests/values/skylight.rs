//! Skylight from a volume (Evans 2006, 9.6 and 9.9), against its formula in double precision on the exact distances, blurred as its mips are.

use crate::known::{Check, Draw, Eye, Found, Lens, SIZE, ball, compare, floor, light, rgb, with};
use crate::sky::{arriving, line};
use glam::DVec3;
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 8] = [
    Check {
        name: "skylight on a bare floor",
        run: bare,
    },
    Check {
        name: "skylight where its volume ends",
        run: ends,
    },
    Check {
        name: "skylight under a ball",
        run: under,
    },
    Check {
        name: "skylight by exact distances",
        run: unblurred,
    },
    Check {
        name: "a ball under a white sky",
        run: white,
    },
    Check {
        name: "where skylight comes from",
        run: above,
    },
    Check {
        name: "curvature in a corner",
        run: corner,
    },
    Check {
        name: "light beside a red wall",
        run: beside,
    },
];

/// The distance and the colour of what is nearest at a place.
type Around<'a> = &'a dyn Fn(DVec3) -> (f64, DVec3);

/// The volume around a box of this middle and half size, and what is around.
struct Model<'a> {
    around: Around<'a>,
    origin: DVec3,
    voxel: f64,
}

/// Shares of the nodes of the finest mip that a node of another is made of: those of 1/4, 1/2, 1/4, mip after mip.
fn kernel(level: u32) -> Vec<(i64, f64)> {
    let mut all = vec![(0, 1.0)];
    for finer in (0..level).rev() {
        let step = 1 << finer;
        let mut next = std::collections::BTreeMap::new();
        for (at, share) in all {
            for (by, part) in [(-step, 0.25), (0, 0.5), (step, 0.25)] {
                *next.entry(at + by).or_insert(0.0) += share * part;
            }
        }
        all = next.into_iter().collect();
    }
    all
}

impl<'a> Model<'a> {
    /// Of 64 voxels along the longest side, 8 of them at either end beyond the box.
    fn new(middle: DVec3, half: DVec3, around: Around<'a>) -> Model<'a> {
        let voxel = 2.0 * half.max_element() / 48.0;
        let cells = (half * 2.0 / voxel - 1e-6).ceil();
        let cells = (cells / 8.0).ceil() * 8.0 + 16.0;
        Model {
            around,
            origin: middle - cells * (0.5 * voxel),
            voxel,
        }
    }

    /// A mip at a place, between its nodes; `taps` are the nodes of the finest mip that each is made of, and their shares.
    fn read(
        &self,
        p: DVec3,
        level: u32,
        taps: &[(i64, f64)],
        of: &dyn Fn(DVec3) -> DVec3,
    ) -> DVec3 {
        let wide = f64::from(1 << level);
        let q = (p - self.origin) / (self.voxel * wide);
        let (low, t) = (q.floor(), q - q.floor());
        let mut sum = DVec3::ZERO;
        for corner in 0..8 {
            let step = DVec3::from([0, 1, 2].map(|axis| f64::from(corner >> axis & 1)));
            let weight: f64 = (0..3)
                .map(|k| if step[k] > 0.0 { t[k] } else { 1.0 - t[k] })
                .product();
            if weight == 0.0 {
                continue;
            }
            let node = (low + step) * wide;
            let mut mixed = DVec3::ZERO;
            for (i, a) in taps {
                for (j, b) in taps {
                    for (k, c) in taps {
                        let by = DVec3::new(*i as f64, *j as f64, *k as f64);
                        mixed += a * b * c * of(self.origin + (node + by) * self.voxel);
                    }
                }
            }
            sum += weight * mixed;
        }
        sum
    }

    /// The light of each colour at a place with this normal.
    fn light(&self, p: DVec3, n: DVec3, how: &How) -> DVec3 {
        let samples = [(1.0, 1.0), (1.2, 2.0), (1.4, 4.0), (1.8, 8.0)];
        let first = how.step * self.voxel;
        let ways: f64 = samples.iter().map(|(w, d)| w * d * first).sum();
        let mut sums = DVec3::ZERO;
        for (level, (weight, far)) in (0u32..).zip(samples) {
            let at = p + (n + DVec3::Y * how.bend) * (far * first);
            let distance = match how.blurs {
                true => {
                    let of = |p: DVec3| DVec3::splat((self.around)(p).0);
                    self.read(at, level, &kernel(level), &of).x
                }
                false => (self.around)(at).0,
            };
            sums += DVec3::splat(weight * (distance - far * first));
            if how.bleed > 0.0 {
                // the colours begin with the second mip, blurred once
                let coarser = level.max(1);
                let mut taps = std::collections::BTreeMap::new();
                for (by, part) in [(-2, 0.25), (0, 0.5), (2, 0.25)] {
                    for (at, share) in kernel(coarser - 1) {
                        *taps.entry(2 * at + by).or_insert(0.0) += share * part;
                    }
                }
                let taps: Vec<(i64, f64)> = taps.into_iter().collect();
                let near = self.read(at, coarser, &taps, &|p| (self.around)(p).1);
                sums += near * (weight * how.bleed * ways / 5.4);
            }
        }
        (sums * (how.strength / ways)).min(DVec3::ZERO).exp()
    }
}

/// The numbers of the method.
struct How {
    step: f64,
    strength: f64,
    bend: f64,
    bleed: f64,
    blurs: bool,
}

const USUAL: How = How {
    step: 2.0,
    strength: 3.0,
    bend: 0.5,
    bleed: 0.0,
    blurs: true,
};

impl How {
    fn words(&self) -> String {
        format!(
            "aa = none(), shading = \"phong\", ao = skylight(resolution = 64, step = {}, strength = {}, bend = {}, bleed = {})",
            self.step, self.strength, self.bend, self.bleed
        )
    }
}

/// Some pixels, since the right values take time.
fn some(x: f64, y: f64) -> bool {
    (x as u32 * 7 + y as u32 * 3).is_multiple_of(5)
}

fn from_aside() -> Eye {
    Eye {
        at: DVec3::new(0.4, 3.0, 3.2),
        target: DVec3::new(0.1, 0.3, 0.0),
        up: DVec3::Y,
        lens: Lens::Fov(50.0),
        size: SIZE,
    }
}

const DARK: &str = "sun(strength = 0, shadow = none())\n";

/// Nothing stands on it, and nothing takes any of its light.
fn bare(draw: Draw) -> Found {
    let eye = from_aside();
    let film = draw(&with(
        &format!("show(plane())\n{DARK}"),
        &eye,
        &USUAL.words(),
    ));
    compare(&film, &eye, Plane::Occlusion, 0.0, |x, y| {
        floor(eye.ray(x, y)).map(|_| DVec3::ONE)
    })?;
    // without a bend samples are as far as they should be, up to rounding
    let straight = How { bend: 0.0, ..USUAL };
    let film = draw(&with(
        &format!("show(plane())\n{DARK}"),
        &eye,
        &straight.words(),
    ));
    compare(&film, &eye, Plane::Occlusion, 1e-5, |x, y| {
        floor(eye.ray(x, y)).map(|_| DVec3::ONE)
    })
}

/// Two balls far to the left and to the right: the volume is a bar between them, and the floor goes on beside it.
fn ends(draw: Draw) -> Found {
    let eye = from_aside();
    let text = format!(
        "show(sphere(0.1).move((-7, 0.1, 0)))\nshow(sphere(0.1).move((7, 0.1, 0)))\nshow(plane())\n{DARK}"
    );
    for bend in [0.5, 0.0] {
        let how = How { bend, ..USUAL };
        let film = draw(&with(&text, &eye, &how.words()));
        compare(&film, &eye, Plane::Occlusion, 2e-5, |x, y| {
            floor(eye.ray(x, y)).map(|_| DVec3::ONE)
        })?;
    }
    Ok(())
}

const MIDDLE: DVec3 = DVec3::new(0.0, 1.1, 0.0);

/// A ball over a floor.
fn ball_over_floor(p: DVec3) -> (f64, DVec3) {
    (((p - MIDDLE).length() - 1.0).min(p.y), DVec3::ONE)
}

fn on_floor(eye: &Eye, x: f64, y: f64) -> Option<DVec3> {
    let ray = eye.ray(x, y);
    if !some(x, y) || ball(ray, MIDDLE, 1.0).is_some() {
        return None;
    }
    // within the volume, where the field does not count
    floor(ray).filter(|p| p.x.abs() < 0.9 && p.z.abs() < 0.9)
}

/// The darkness under a ball, seen from beside it.
fn under(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(0.1, 0.45, 1.8),
        target: DVec3::new(0.0, 0.0, 0.75),
        lens: Lens::Fov(35.0),
        ..from_aside()
    };
    let text = format!("show(sphere(1).move(y = 1.1))\nshow(plane())\n{DARK}");
    for how in [
        USUAL,
        How {
            step: 1.0,
            strength: 1.5,
            bend: 0.2,
            ..USUAL
        },
    ] {
        let film = draw(&with(&text, &eye, &how.words()));
        let model = Model::new(MIDDLE, DVec3::ONE, &ball_over_floor);
        compare(&film, &eye, Plane::Occlusion, 2e-4, |x, y| {
            let p = on_floor(&eye, x, y)?;
            Some(DVec3::splat(model.light(p, DVec3::Y, &how).x))
        })?;
    }
    Ok(())
}

/// The same by the distances themselves: blurring takes off what it may.
fn unblurred(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(0.1, 0.45, 1.8),
        target: DVec3::new(0.0, 0.0, 0.75),
        lens: Lens::Fov(35.0),
        ..from_aside()
    };
    let text = format!("show(sphere(1).move(y = 1.1))\nshow(plane())\n{DARK}");
    let how = How {
        step: 4.0,
        bend: 0.2,
        blurs: false,
        ..USUAL
    };
    let film = draw(&with(&text, &eye, &how.words()));
    let model = Model::new(MIDDLE, DVec3::ONE, &ball_over_floor);
    compare(&film, &eye, Plane::Occlusion, 0.12, |x, y| {
        let p = on_floor(&eye, x, y)?;
        Some(DVec3::splat(model.light(p, DVec3::Y, &how).x))
    })
}

/// Nothing is before any part of a ball alone.
fn white(draw: Draw) -> Found {
    let eye = from_aside();
    let text = format!(
        "show(sphere(0.8).move(y = 0.3), material(color = {}))\n{DARK}sky(color = \"white\", ambient = 1)",
        rgb([0.7, 0.5, 0.9])
    );
    let how = How { bend: 0.0, ..USUAL };
    let film = draw(&with(&text, &eye, &how.words()));
    let seen = |x, y| ball(eye.ray(x, y), DVec3::new(0.0, 0.3, 0.0), 0.8);
    compare(&film, &eye, Plane::Colour, 2e-3, |x, y| {
        seen(x, y).map(|_| light([0.7, 0.5, 0.9]))
    })
}

/// A wall sees the sky that is above it, as far as its normal is bent.
fn above(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 2.0);
    let text = format!(
        "show(box((8, 8, 0.5)).move(z = -0.25), material(color = \"white\"))\n{DARK}{}",
        line(1.0)
    );
    for bend in [0.25, 1.0] {
        let how = How { bend, ..USUAL };
        let film = draw(&with(&text, &eye, &how.words()));
        let right = arriving(bend / bend.hypot(1.0));
        compare(&film, &eye, Plane::Colour, 4e-3, |_, _| Some(right))?;
    }
    Ok(())
}

/// A red wall on a white floor: red light comes nearer to it.
fn beside(draw: Draw) -> Found {
    // nodes never lie as near to the one as to the other
    let wall = -0.513;
    let red = light([1.0, 0.2, 0.1]);
    let around = move |p: DVec3| match p.x - wall < p.y {
        true => (p.x - wall, red),
        false => (p.y, DVec3::ONE),
    };
    let eye = Eye {
        at: DVec3::new(0.0, 1.9, 0.6),
        target: DVec3::new(-0.1, 0.0, 0.0),
        up: DVec3::Y,
        lens: Lens::Fov(40.0),
        size: SIZE,
    };
    let text = format!(
        "show(plane(), material(color = \"white\"))\nshow(plane().turn(z = -90).move(x = {wall}), material(color = {}))\n{DARK}sky(color = \"white\", ambient = 1)",
        rgb([1.0, 0.2, 0.1])
    );
    for bleed in [0.6, 0.0] {
        let how = How { bleed, ..USUAL };
        let film = draw(&with(&text, &eye, &how.words()));
        let model = Model::new(DVec3::ZERO, DVec3::splat(eye.at.length()), &around);
        compare(&film, &eye, Plane::Colour, 5e-3, |x, y| {
            let p = floor(eye.ray(x, y)).filter(|p| some(x, y) && p.x > wall + 0.02)?;
            Some(model.light(p, DVec3::Y, &how))
        })
        .map_err(|e| format!("bleed {bleed}: {e}"))?;
    }
    Ok(())
}

/// Two walls that meet: what their distance is off there, blurred, and nothing where they are flat.
fn corner(draw: Draw) -> Found {
    let wall = -0.113;
    let around = move |p: DVec3| ((p.x - wall).min(p.y), DVec3::ONE);
    let eye = Eye {
        at: DVec3::new(0.2, 1.2, 0.5),
        target: DVec3::new(-0.05, 0.0, 0.0),
        up: DVec3::Y,
        lens: Lens::Fov(40.0),
        size: SIZE,
    };
    let text = format!("show(plane())\nshow(plane().turn(z = -90).move(x = {wall}))\n{DARK}");
    let model = Model::new(DVec3::ZERO, DVec3::splat(eye.at.length()), &around);
    for (blur, strength) in [(0, 4.0), (1, 3.0), (3, 6.0)] {
        let words = format!(
            "aa = none(), ao = curvature(resolution = 64, blur = {blur}, strength = {strength})"
        );
        let film = draw(&with(&text, &eye, &words));
        let voxel = model.voxel * f64::from(1 << blur);
        compare(&film, &eye, Plane::Occlusion, 1e-3, |x, y| {
            let p = floor(eye.ray(x, y)).filter(|p| some(x, y) && p.x > wall + 0.02)?;
            let of = |p: DVec3| DVec3::splat((model.around)(p).0);
            let off = model.read(p, blur, &kernel(blur), &of).x;
            Some(DVec3::splat((0.5 + (strength * off / voxel).exp()) / 2.5))
        })
        .map_err(|e| format!("blur {blur}: {e}"))?;
    }
    Ok(())
}
