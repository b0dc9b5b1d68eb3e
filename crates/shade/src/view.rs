//! Rays through pixels, how wide a pixel is along them, and the part of a ray that can meet the scene.

use zeroset_catalogue::bounds::Aabb;
use zeroset_number::{Real, Vec2, Vec3, v2, v3};
use zeroset_scene::camera::{Camera, Lens};

/// Evaluations in single precision are off by about this share of the largest coordinate.
pub const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// A number that grows evenly along a ray: `slope * t + constant`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<C = f32> {
    /// Growth per unit of `t`.
    pub slope: C,
    /// Value at 0.
    pub constant: C,
}

impl<C> Linear<C> {
    /// The value at `t`.
    #[inline(always)]
    pub fn at<R: Real<Scalar = C>>(self, t: R) -> R {
        t * self.slope + self.constant
    }
}

/// A camera with a picture size: what turns pixels into rays.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Whether all rays go through the eye; else they are parallel.
    pub pinhole: bool,
    /// Where the camera is.
    pub eye: [f32; 3],
    /// To the right of the picture.
    pub right: [f32; 3],
    /// Upwards on the picture.
    pub up: [f32; 3],
    /// Against the way the camera looks.
    pub back: [f32; 3],
    /// Side of a pixel on the plane at distance 1 (pinhole), or anywhere (orthographic).
    pub scale: f32,
    /// Half the picture's size in pixels.
    pub half: [f32; 2],
    /// Rays start here.
    pub near: f32,
    /// Rays end here at the latest.
    pub far: f32,
    /// Full width of a pixel along the ray through the middle of the picture; see [`View::narrow`].
    pub pixel: Linear,
    /// What single precision cannot tell apart along a ray.
    pub rounding: Linear,
    /// Nearer than this to the surface a ray is under its footprint: `footprint` pixel widths in the middle of the picture, and
    /// what rounding adds.
    pub threshold: Linear,
    /// Radius of the lens; 0 where it has no extent.
    pub aperture: f32,
    /// How far before it, along the way it looks, what is sharp lies; 1 where the lens has no extent.
    pub focus: f32,
    /// Share of a pixel's width that is its footprint.
    footprint: f32,
    /// Share of a pixel's footprint that rays are marched with: in small pictures as if they were of [`FINE`] rows.
    pub fine: f32,
}

/// Rays of pictures with fewer rows are marched as if they had this many: their pixels are wider than what is to be seen.
pub const FINE: u32 = 512;

impl View {
    /// `footprint`: what is nearer to a ray than this many pixel widths is below what the picture shows.
    pub fn new(camera: &Camera, [width, height]: [u32; 2], footprint: f32) -> View {
        let (slope, constant) = camera.pixel_width(height);
        let pixel = Linear { slope, constant };
        let scale = camera.plane_height() / height as f32;
        let half = [0.5 * width as f32, 0.5 * height as f32];
        let pinhole = matches!(camera.lens, Lens::Pinhole { .. });
        let aside = if pinhole {
            0.0
        } else {
            scale * half[0].hypot(half[1])
        };
        let rounding = Linear {
            slope: ROUNDING,
            constant: (ROUNDING * (camera.eye.length() + aside)).max(f32::MIN_POSITIVE),
        };
        let threshold = Linear {
            slope: footprint * slope + rounding.slope,
            constant: footprint * constant + rounding.constant,
        };
        View {
            pinhole,
            eye: camera.eye.to_array(),
            right: camera.axes.x_axis.to_array(),
            up: camera.axes.y_axis.to_array(),
            back: camera.axes.z_axis.to_array(),
            scale,
            half,
            near: camera.near,
            far: camera.far,
            pixel,
            rounding,
            threshold,
            aperture: camera.aperture,
            focus: if camera.aperture > 0.0 {
                camera.focus
            } else {
                1.0
            },
            footprint,
            fine: (height as f32 / FINE as f32).min(1.0),
        }
    }

    /// No picture: rays of one's own. What they stand for is `width` wide anywhere, they go as far as `far` from places within `size` of
    /// the origin.
    pub fn of_rays(width: f32, size: f32, far: f32) -> View {
        let pixel = Linear {
            slope: 0.0,
            constant: width,
        };
        let rounding = Linear {
            slope: ROUNDING,
            constant: (ROUNDING * size).max(f32::MIN_POSITIVE),
        };
        let footprint = 0.5;
        View {
            pinhole: false,
            eye: [0.0; 3],
            right: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            back: [0.0, 0.0, 1.0],
            scale: width,
            half: [0.0; 2],
            near: 0.0,
            far,
            pixel,
            rounding,
            threshold: Linear {
                slope: rounding.slope,
                constant: footprint * width + rounding.constant,
            },
            aperture: 0.0,
            focus: 1.0,
            footprint,
            fine: 1.0,
        }
    }

    /// How much narrower the footprint of a pixel is along `ray` (what [`View::ray`] gave) than in the middle of the
    /// picture, for the same distance: pixels have equal sides on a plane, which a ray at the angle a meets cos a later and
    /// aslant.
    #[inline(always)]
    pub fn narrow<R: Real<Scalar = f32>>(&self, ray: Vec3<R>) -> R {
        if self.pinhole {
            narrowness(ray, vector(self.back))
        } else {
            ray.x.lit(1.0)
        }
    }

    /// The radius of this share of the footprint, but for what rounding adds, in the middle of the picture.
    pub fn footprint(&self, share: f32) -> Linear {
        Linear {
            slope: share * self.footprint * self.pixel.slope,
            constant: share * self.footprint * self.pixel.constant,
        }
    }

    /// The radius of the footprint at distance `t` of a ray that is that [`narrow`](View::narrow).
    #[inline(always)]
    pub fn near<R: Real<Scalar = f32>>(&self, t: R, narrow: R) -> R {
        footprint(t, narrow, self.footprint(1.0), self.rounding)
    }

    /// The width of a pixel at distance `t` of a ray that is that [`narrow`](View::narrow): the side of a square of its area.
    #[inline(always)]
    pub fn width<R: Real<Scalar = f32>>(&self, t: R, narrow: R) -> R {
        pixel_width(t, narrow, self.pixel)
    }

    /// What of the ray through (`x`, `y`) pixels differs from ray to ray: the direction (pinhole) or the origin.
    #[inline(always)]
    pub fn ray<R: Real<Scalar = f32>>(&self, x: R, y: R) -> Vec3<R> {
        let q = on_plane(v2(x, y), v2(self.half[0], self.half[1]), self.scale);
        let (right, up) = (vector(self.right), vector(self.up));
        if self.pinhole {
            pinhole_ray(q, right, up, vector(self.back))
        } else {
            across(q, right, up, vector(self.eye))
        }
    }

    /// Origin and direction from what [`View::ray`] gave.
    #[inline(always)]
    pub fn split<R: Real<Scalar = f32>>(&self, ray: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
        if self.pinhole {
            (constant(ray.x, self.eye), ray)
        } else {
            (ray, -constant(ray.x, self.back))
        }
    }

    /// The ray through (`x`, `y`) pixels from a place on the lens, which is given by a point of the unit square: origin and direction. All
    /// of them meet where the ray through the middle of the lens comes to the plane that is in focus.
    #[inline(always)]
    pub fn lens_ray<R: Real<Scalar = f32>>(&self, x: R, y: R, u: [R; 2]) -> (Vec3<R>, Vec3<R>) {
        let q = on_plane(v2(x, y), v2(self.half[0], self.half[1]), self.scale);
        let [a, b] = on_disc(u);
        let at = v2(a * self.aperture, b * self.aperture);
        let (right, up) = (vector(self.right), vector(self.up));
        let (back, eye) = (vector(self.back), vector(self.eye));
        let nearer = 1.0 / self.focus;
        if self.pinhole {
            let to = v2(q.x - at.x * nearer, q.y - at.y * nearer);
            (across(at, right, up, eye), pinhole_ray(to, right, up, back))
        } else {
            let to = v2(-(at.x * nearer), -(at.y * nearer));
            let from = v2(q.x + at.x, q.y + at.y);
            (
                across(from, right, up, eye),
                pinhole_ray(to, right, up, back),
            )
        }
    }

    /// A cone around the ray through (`x`, `y`) that holds all rays through the square of `reach` pixels around it: its
    /// radius at distance `t` is `slope * t + constant`.
    ///
    /// The slope is the tangent of the largest angle to a corner: one to an edge would leave the corners out.
    #[inline(always)]
    pub fn cone<R: Real<Scalar = f32>>(&self, x: R, y: R, reach: f32) -> (R, f32) {
        if !self.pinhole {
            return (x.lit(0.0), reach * self.scale * std::f32::consts::SQRT_2);
        }
        let q = on_plane(v2(x, y), v2(self.half[0], self.half[1]), self.scale);
        (cone_slope(q, reach * self.scale), 0.0)
    }
}

/// A place on the picture, `at` in pixels from the top left corner of a picture of `half` the size, in units of the plane at
/// distance 1 (pinhole) or of the scene (orthographic). `scale` is the side of a pixel there.
#[inline(always)]
pub fn on_plane<R: Real>(at: Vec2<R>, half: Vec2<R::Scalar>, scale: R::Scalar) -> Vec2<R> {
    v2((at.x - half.x) * scale, -(at.y - half.y) * scale)
}

/// A point of the unit disc from one of the unit square, by rings: areas keep their ratios, and what is near stays near (Shirley and
/// Chiu 1997).
#[inline(always)]
pub fn on_disc<R: Real>([u, v]: [R; 2]) -> [R; 2] {
    let (a, b) = (u * 2.0 - 1.0, v * 2.0 - 1.0);
    let wide = a.sq().above(b.sq());
    let radius = R::choose(wide, a, b);
    let other = R::choose(wide, b, a);
    let nonzero = R::choose(radius.abs().above(1e-12), radius, radius.lit(1.0));
    let turn = other / nonzero * std::f32::consts::FRAC_PI_4;
    let turn = R::choose(wide, turn, -(turn - std::f32::consts::FRAC_PI_2));
    let (sin, cos) = turn.sin_cos();
    [radius * cos, radius * sin]
}

/// The direction of a ray from the eye through `q` on the plane at distance 1.
#[inline(always)]
pub fn pinhole_ray<R: Real>(
    q: Vec2<R>,
    right: Vec3<R::Scalar>,
    up: Vec3<R::Scalar>,
    back: Vec3<R::Scalar>,
) -> Vec3<R> {
    across(q, right, up, -back).normalize()
}

/// The place `q` on the plane of the picture, from `origin`.
#[inline(always)]
pub fn across<R: Real>(
    q: Vec2<R>,
    right: Vec3<R::Scalar>,
    up: Vec3<R::Scalar>,
    origin: Vec3<R::Scalar>,
) -> Vec3<R> {
    let x = q.x;
    let right = v3(x.like(right.x), x.like(right.y), x.like(right.z));
    let up = v3(x.like(up.x), x.like(up.y), x.like(up.z));
    let origin = v3(x.like(origin.x), x.like(origin.y), x.like(origin.z));
    right * q.x + up * q.y + origin
}

/// See [`View::narrow`]: the square of the cosine between a ray and the view.
#[inline(always)]
pub fn narrowness<R: Real>(d: Vec3<R>, back: Vec3<R::Scalar>) -> R {
    d.dot(back).sq()
}

/// The width of a pixel at distance `t`, see [`View::width`].
#[inline(always)]
pub fn pixel_width<R: Real>(t: R, narrow: R, pixel: Linear<R::Scalar>) -> R {
    // area cos^3 a: the square root of that, with the square of the cosine given
    pixel.at(t * (narrow * narrow.sqrt()).sqrt())
}

/// The radius of a footprint at distance `t`, see [`View::near`].
#[inline(always)]
pub fn footprint<R: Real>(
    t: R,
    narrow: R,
    footprint: Linear<R::Scalar>,
    rounding: Linear<R::Scalar>,
) -> R {
    footprint.at(t * narrow) + rounding.at(t)
}

/// The slope of a cone around the ray through `q` on the plane at distance 1 that holds all rays through the square of `e` around
/// it: the tangent of the largest angle to a corner. (One to an edge would leave the corners out.)
#[inline(always)]
pub fn cone_slope<R: Real>(q: Vec2<R>, e: R::Scalar) -> R {
    // for axis a and corner a + d: tan = |a x d| / (a . a + a . d), with a = (u, v, 1) in the camera's axes
    let square = q.x.sq() + q.y.sq() + 1.0;
    let mut slope = q.x.lit(0.0);
    for (right, up) in [(true, true), (true, false), (false, true), (false, false)] {
        let (du, dv) = (if right { e } else { -e }, if up { e } else { -e });
        let dot = q.x * du + q.y * dv;
        let cross = (square * (e * 2.0 * e) - dot.sq()).max(0.0).sqrt();
        slope = slope.max(cross / (square + dot).max(1e-6));
    }
    slope
}

/// A box that holds the whole solid, in single precision.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    /// Least coordinates.
    pub min: [f32; 3],
    /// Largest coordinates.
    pub max: [f32; 3],
}

impl Region {
    /// The smallest such box of single precision numbers.
    pub fn new(bounds: &Aabb) -> Region {
        Region {
            min: bounds.min.map(|x| {
                if f64::from(x as f32) > x {
                    (x as f32).next_down()
                } else {
                    x as f32
                }
            }),
            max: bounds.max.map(|x| {
                if f64::from(x as f32) < x {
                    (x as f32).next_up()
                } else {
                    x as f32
                }
            }),
        }
    }

    /// From this `t` on the ray is farther from the box than `slope * t + constant`, for good. Infinite where it never is.
    ///
    /// Beyond the plane of one side, the distance to the box grows by the cosine `c` to that side and is at least
    /// `c t - d`, with `d` the distance to the plane at the start.
    #[inline(always)]
    pub fn leave<R: Real<Scalar = f32>>(&self, o: Vec3<R>, d: Vec3<R>, slope: R, constant: R) -> R {
        leave(vector(self.min), vector(self.max), o, d, slope, constant)
    }

    /// Up to this `t` the ray is farther from the box than `slope * t + constant`. Zero where it starts near it.
    #[inline(always)]
    pub fn enter<R: Real<Scalar = f32>>(&self, o: Vec3<R>, d: Vec3<R>, slope: R, constant: R) -> R {
        enter(vector(self.min), vector(self.max), o, d, slope, constant)
    }
}

/// See [`Region::leave`].
#[inline(always)]
pub fn leave<R: Real>(
    min: Vec3<R::Scalar>,
    max: Vec3<R::Scalar>,
    o: Vec3<R>,
    d: Vec3<R>,
    slope: R,
    constant: R,
) -> R {
    let mut end = o.x.lit(f32::INFINITY);
    let (min, max) = (min.array(), max.array());
    let (o, d) = (o.array(), d.array());
    for k in 0..3 {
        let backwards = d[k].negative();
        let depth = R::select(backwards, o[k] - min[k], -o[k] + max[k]);
        let gain = d[k].abs() - slope;
        let t = (depth + constant) / gain.max(1e-12);
        end = R::select(gain.above(1e-12), end.min(t), end);
    }
    end.max(0.0)
}

/// See [`Region::enter`].
#[inline(always)]
pub fn enter<R: Real>(
    min: Vec3<R::Scalar>,
    max: Vec3<R::Scalar>,
    o: Vec3<R>,
    d: Vec3<R>,
    slope: R,
    constant: R,
) -> R {
    let mut start = o.x.lit(0.0);
    let (min, max) = (min.array(), max.array());
    let (o, d) = (o.array(), d.array());
    for k in 0..3 {
        let backwards = d[k].negative();
        let gap = R::select(backwards, o[k] - max[k], -o[k] + min[k]);
        start = start.max((gap - constant) / (d[k].abs() + slope).max(1e-12));
    }
    start.min(f32::MAX)
}

/// Three numbers as a vector of parameters.
#[inline(always)]
fn vector([x, y, z]: [f32; 3]) -> Vec3<f32> {
    v3(x, y, z)
}

/// `c` as numbers of the company of `x`.
#[inline(always)]
fn constant<R: Real<Scalar = f32>>(x: R, c: [f32; 3]) -> Vec3<R> {
    v3(x.lit(c[0]), x.lit(c[1]), x.lit(c[2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3 as G;

    fn cameras() -> [Camera; 2] {
        let lens = [
            Lens::Pinhole { fov: 0.8 },
            Lens::Orthographic { height: 3.0 },
        ];
        lens.map(|l| {
            Camera::look_at(G::new(3.0, 2.0, 4.0), G::new(0.0, 0.5, 0.0), G::Y, l).expect("a view")
        })
    }

    #[test]
    fn rays_are_the_cameras() {
        for camera in cameras() {
            let view = View::new(&camera, [64, 48], 0.5);
            for (x, y) in [(0.0, 0.0), (64.0, 48.0), (12.25, 40.5)] {
                let (o, d) = view.split(view.ray(x, y));
                let (p, q) = camera.ray(x, y, [64, 48]);
                assert!(
                    (G::from(o.array()) - p).length() < 1e-5
                        && (G::from(d.array()) - q).length() < 1e-6
                );
            }
        }
    }

    #[test]
    fn cones_hold_their_pixels() {
        for camera in cameras() {
            let view = View::new(&camera, [64, 48], 0.5);
            for (x, y) in [(4.0, 4.0), (32.0, 24.0), (60.0, 44.0), (4.0, 24.0)] {
                let (slope, constant) = view.cone(x, y, 4.0f32);
                let (o, d) = view.split(view.ray(x, y));
                let mut widest = 0.0f32;
                for (dx, dy) in [
                    (-4.0, -4.0),
                    (4.0, -4.0),
                    (-4.0, 4.0),
                    (4.0, 4.0),
                    (0.0, 4.0),
                    (1.5, -2.0),
                ] {
                    let (p, q) = view.split(view.ray(x + dx, y + dy));
                    for t in [0.1, 1.0, 7.0] {
                        let axis = G::from(o.array()) + G::from(d.array()) * t;
                        let side = (G::from(p.array()) + G::from(q.array()) * t - axis).length();
                        assert!(
                            side <= (slope * t + constant) * 1.0001 + 1e-6,
                            "at ({x}, {y})"
                        );
                        widest = widest.max(side / (slope * t + constant));
                    }
                }
                assert!(widest > 0.95, "the cone is wider than it need be: {widest}");
            }
        }
    }

    #[test]
    fn rays_leave_and_enter_the_box() {
        let bounds = Aabb::new([-1.0, f64::NEG_INFINITY, -2.0], [1.0, 0.5, 0.25]);
        let region = Region::new(&bounds);
        let outside = |p: G| {
            let mut far = 0.0f32;
            for k in 0..3 {
                far = far.max(region.min[k] - p[k]).max(p[k] - region.max[k]);
            }
            far
        };
        let mut finite = 0;
        for i in 0..2000 {
            let h = |k: i32| ((i * 7919 + k * 104_729) % 2003) as f32 / 1001.5 - 1.0;
            let o = G::new(h(1), h(2), h(3)) * 4.0;
            let Some(d) = G::new(h(4), h(5), h(6)).try_normalize() else {
                continue;
            };
            let (slope, constant) = (0.1 * h(7).abs(), 0.05 * h(8).abs());
            let (a, b) = (v3(o.x, o.y, o.z), v3(d.x, d.y, d.z));
            let (start, end) = (
                region.enter(a, b, slope, constant),
                region.leave(a, b, slope, constant),
            );
            finite += u32::from(end.is_finite());
            for k in 0..200 {
                let t = 0.1 * k as f32;
                if t < start * 0.999 || t > end * 1.001 + 1e-4 {
                    assert!(
                        outside(o + d * t) > slope * t + constant - 1e-4,
                        "t {t}, {start} to {end}"
                    );
                }
            }
        }
        assert!(finite > 1500);
    }
}
