//! Solids that rays meet in closed form, beside a field that is marched (Keinert et al. 2014, section 4): floors, and a few balls.
//!
//! A ray that begins outside a union meets it where it meets the first of its parts. So the floor of a scene costs a division a ray, and
//! what is left to march often has an end: rays begin where its box does.

use crate::view::{Region, View};
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::closed::{ClosedForm, Split};
use zeroset_field::program::{Limits, Program};
use zeroset_number::{F64, Real, Vec3, v3};
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;

/// More balls than this are marched: each costs every ray a root.
pub const MOST_BALLS: usize = 4;

/// A solid in closed form, in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closed {
    /// A half space: where it is empty, and the distance of its plane from the origin.
    HalfSpace([f32; 3], f32),
    /// A ball: its middle and its radius.
    Ball([f32; 3], f32),
}

impl Closed {
    /// The distance at which a ray meets it; infinite where it does not, zero where it begins in a half space. One that begins in a ball goes
    /// through its surface. `d` has length 1.
    #[inline(always)]
    pub fn meet<R: Real<Scalar = f32>>(&self, o: Vec3<R>, d: Vec3<R>) -> R {
        match *self {
            Closed::HalfSpace(normal, offset) => half_space(normal, offset, o, d),
            Closed::Ball(centre, radius) => ball(centre, radius, o, d),
        }
    }
}

#[inline(always)]
fn half_space<R: Real<Scalar = f32>>(
    [x, y, z]: [f32; 3],
    offset: f32,
    o: Vec3<R>,
    d: Vec3<R>,
) -> R {
    let height = o.x * x + o.y * y + o.z * z - offset;
    let fall = -(d.x * x + d.y * y + d.z * z);
    let outside = height.above(0.0);
    let falls = R::select(fall.above(0.0), height / fall, height.lit(f32::INFINITY));
    // where two solids touch, a ray from the one may begin a rounding inside the other: no light comes from there
    R::select(outside, falls, height.lit(0.0))
}

/// By the distance of the middle from the ray, which stays exact where a small ball is far away (Haines et al. 2019, Precision Improvements
/// for Ray/Sphere Intersection).
#[inline(always)]
fn ball<R: Real<Scalar = f32>>([x, y, z]: [f32; 3], radius: f32, o: Vec3<R>, d: Vec3<R>) -> R {
    let to = v3(-o.x + x, -o.y + y, -o.z + z);
    let along = to.dot(d);
    let aside = to - d * along;
    let square = -aside.length_squared() + radius * radius;
    let outside = (to.length_squared() - radius * radius).above(0.0);
    let meets = square.above(0.0) & along.above(0.0) & outside;
    R::select(
        meets,
        along - square.max(0.0).sqrt(),
        along.lit(f32::INFINITY),
    )
}

/// A scene as solids in closed form and what is left to march.
#[derive(Clone, Debug)]
pub struct Closing {
    /// Solids in closed form.
    pub closed: Vec<Closed>,
    /// What is left. Where nothing is, no ray goes into its region.
    pub program: Program,
    /// Where that is.
    pub region: Region,
}

impl Closing {
    /// Splits a scene; none where nothing of it is in closed form.
    ///
    /// # Errors
    /// A field over the limits.
    pub fn of(scene: &Scene, limits: &Limits) -> Result<Option<Closing>, RenderError> {
        let Some(field) = scene.field()? else {
            return Ok(None);
        };
        let Some(Split { closed, rest }) = Split::of(&field, MOST_BALLS)? else {
            return Ok(None);
        };
        let bounds = |program: &Program| Region::new(&program.bounds());
        let (program, region) = match rest {
            Some(rest) => {
                let program = Program::compile(&rest, limits)?;
                let region = bounds(&program);
                (program, region)
            }
            // the program stands for nothing
            None => (Program::compile(&field, limits)?, Region::new(&Aabb::EMPTY)),
        };
        let single = |v: [f64; 3]| v.map(|x| x as f32);
        let closed = closed.into_iter().map(|form| match form {
            ClosedForm::HalfSpace { normal, offset } => {
                Closed::HalfSpace(single(normal), offset as f32)
            }
            ClosedForm::Ball { centre, radius } => Closed::Ball(single(centre), radius as f32),
        });
        Ok(Some(Closing {
            closed: closed.collect(),
            program,
            region,
        }))
    }
}

/// Whether all rays of a picture begin outside the solid: `distance` is that of the eye from it, or less.
///
/// They begin no farther from the eye than rays start, the lens reaches and, where they are parallel, the picture does.
pub fn begin_outside(view: &View, distance: f64) -> bool {
    let across = if view.pinhole {
        0.0
    } else {
        let [x, y] = view.half.map(|h| (h + 1.0) * view.scale);
        x.hypot(y)
    };
    let across = across + view.near + view.aperture;
    distance > f64::from(across) * 1.001
}

/// The value of a program at the eye: its solid is at least so far away, where it is above 0.
pub fn at_eye(program: &Program, view: &View) -> f64 {
    let [x, y, z] = view.eye.map(|x| F64(f64::from(x)));
    zeroset_eval::Point::new(program.values())
        .value(v3(x, y, z))
        .0
}
