//! Rays of one's own, from anywhere to anywhere: what they meet first, all that they meet, whether anything stands in their way.

use crate::closest::{Plan, closest, crossings};
use crate::march::ORDINAL;
use crate::normal::{normals, place};
use crate::ray;
use crate::renderer::PreparedScene;
use crate::secondary::occluded;
use crate::simd::{INSIDE, Sheet, TILE_RAYS};
use crate::stop::Stop;
use crate::surface::marks;
use crate::tile::{Scratch, Solid};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;
use zeroset_number::{at_level, v3};
use zeroset_scene::render::Silent;
use zeroset_scene::settings::Normals;
use zeroset_shade::view::View;

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins.
    pub origin: Vec3,
    /// Where it goes; of any length but zero.
    pub direction: Vec3,
    /// Nothing nearer than this is looked at. Not below 0.
    pub near: f32,
    /// Nothing farther than this is looked at. More than `near`.
    pub far: f32,
}

impl Ray {
    /// A ray from a place in a direction, as far as scenes are shown by default: 1000.
    pub fn new(origin: Vec3, direction: Vec3) -> Ray {
        Ray {
            origin,
            direction,
            near: 0.0,
            far: 1000.0,
        }
    }
}

/// Where a ray meets the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray.
    pub t: f32,
    /// The place.
    pub point: Vec3,
    /// The surface's normal, of length 1, on the side that the ray comes from.
    pub normal: Vec3,
    /// Number of the object, where the scene has any.
    pub object: Option<usize>,
    /// Number of the material that counts most there.
    pub material: Option<usize>,
    /// Whether the ray comes from inside the solid.
    pub inside: bool,
}

/// Why a query has no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum QueryError {
    /// A number is none, infinite, or too large.
    #[error(
        "ray {0}: its origin and its direction must be finite numbers, and the origin within 1e19 of (0, 0, 0)"
    )]
    NotFinite(usize),
    /// A ray goes nowhere.
    #[error("ray {0}: its direction has no length")]
    NoDirection(usize),
    /// A ray ends before it starts.
    #[error(
        "ray {number}: it must have 0 <= near < far, both finite, not near = {near} and far = {far}"
    )]
    NoLength {
        /// Which.
        number: usize,
        /// What was given.
        near: f32,
        /// What was given.
        far: f32,
    },
    /// The width of the rays is none.
    #[error("the width of rays must be above 0 and finite, not {0}")]
    Width(f32),
}

/// A query at work.
struct Query<'a> {
    picture: &'a PreparedScene,
    view: View,
    /// Surfaces that a ray may meet.
    most: usize,
}

impl PreparedScene {
    /// Where each ray first meets the surface, if it does.
    ///
    /// `width` is what a ray stands for across, in scene units: what is thinner than a sixteenth of it may be passed, as in a picture with such
    /// pixels.
    ///
    /// ```
    /// use glam::vec3;
    /// use std::sync::Arc;
    /// use zeroset_field::shape::sphere;
    /// use zeroset_scene::material::Material;
    /// use zeroset_scene::scene::{Object, SceneParts};
    /// use zeroset_trace::{CpuRenderer, Ray};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let parts = SceneParts {
    ///     objects: vec![Object::new("ball", sphere(1.0).field()?)],
    ///     materials: vec![Material::default()],
    ///     ..SceneParts::default()
    /// };
    /// let scene = CpuRenderer::new(Some(1))?.prepare_scene(Arc::new(parts.build()?))?;
    /// let rays = [
    ///     Ray::new(vec3(0.0, 0.0, 5.0), vec3(0.0, 0.0, -1.0)),
    ///     Ray::new(vec3(0.0, 2.0, 5.0), vec3(0.0, 0.0, -1.0)),
    /// ];
    /// let hits = scene.closest(&rays, 1e-3)?;
    /// let front = hits[0].expect("a hit");
    /// assert!((front.t - 4.0).abs() < 1e-4 && (front.normal.z - 1.0).abs() < 1e-4);
    /// assert_eq!(hits[1], None);
    ///
    /// let all = scene.crossings(&rays, 1e-3, 8)?;
    /// assert_eq!(all[0].len(), 2); // into the ball and out of it
    /// assert_eq!(scene.occluded(&rays, 1e-3)?, [true, false]);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// See [`QueryError`].
    pub fn closest(&self, rays: &[Ray], width: f32) -> Result<Vec<Option<Hit>>, QueryError> {
        self.answer(rays, width, 1, |query, q| {
            let mut found = vec![None; q.queue.count];
            for (number, hit) in query.hits(q) {
                found[number] = Some(hit);
            }
            found
        })
    }

    /// All places where each ray crosses the surface, near ones first, `most` of them at most (and not more than 2048). Fractals, which
    /// are estimates, are met once.
    ///
    /// # Errors
    /// See [`QueryError`].
    pub fn crossings(
        &self,
        rays: &[Ray],
        width: f32,
        most: usize,
    ) -> Result<Vec<Vec<Hit>>, QueryError> {
        if most == 0 {
            return Ok(vec![Vec::new(); rays.len()]);
        }
        self.answer(rays, width, most.min(TILE_RAYS), |query, q| {
            let mut found = vec![Vec::new(); q.queue.count];
            for (number, hit) in query.hits(q) {
                found[number].push(hit);
            }
            for hits in &mut found {
                hits.sort_by(|a: &Hit, b: &Hit| a.t.total_cmp(&b.t));
            }
            found
        })
    }

    /// Whether anything stands in each ray's way. A ray that begins inside the solid stands in its own.
    ///
    /// # Errors
    /// See [`QueryError`].
    pub fn occluded(&self, rays: &[Ray], width: f32) -> Result<Vec<bool>, QueryError> {
        self.answer(rays, width, 1, |query, q| {
            query.with(q, |query, solid, q| {
                at_level!(query.picture.renderer.level, s => occluded(s, solid, q));
                q.lit[..q.queue.count]
                    .iter()
                    .map(|lit| *lit == 0.0)
                    .collect()
            })
        })
    }

    /// Answers a query in parts that fit the scratch memory, on all threads.
    fn answer<T: Send>(
        &self,
        rays: &[Ray],
        width: f32,
        most: usize,
        answer: impl Fn(&Query<'_>, &mut Scratch) -> Vec<T> + Sync,
    ) -> Result<Vec<T>, QueryError> {
        if !(width > 0.0 && width.is_finite()) {
            return Err(QueryError::Width(width));
        }
        let (mut size, mut far) = (0.0f32, 0.0f32);
        for (number, ray) in rays.iter().enumerate() {
            if !ray.origin.length().is_finite() || !ray.direction.is_finite() {
                return Err(QueryError::NotFinite(number));
            }
            if unit(ray.direction).is_none() {
                return Err(QueryError::NoDirection(number));
            }
            let (near, end) = (ray.near, ray.far);
            if !(near >= 0.0 && near < end && end.is_finite()) {
                return Err(QueryError::NoLength {
                    number,
                    near,
                    far: end,
                });
            }
            size = size.max(ray.origin.length());
            far = far.max(end);
        }
        let query = Query {
            picture: self,
            view: View::of_rays(width, size, far),
            most,
        };
        let part = |rays: &[Ray]| {
            let mut q = self.scratch();
            query.fill(rays, &mut q);
            let found = answer(&query, &mut q);
            self.give_back(q);
            found
        };
        let parts = rays.par_chunks((TILE_RAYS / most).max(1));
        Ok(self
            .renderer
            .pool
            .install(|| parts.flat_map_iter(part).collect()))
    }
}

/// The direction with length 1, however long or short it is.
fn unit(direction: Vec3) -> Option<Vec3> {
    (direction / direction.abs().max_element()).try_normalize()
}

impl Query<'_> {
    /// Puts rays into the queue, each from where the scene begins to where it ends.
    fn fill(&self, rays: &[Ray], q: &mut Scratch) {
        let (region, reach) = (&self.picture.region, self.view.threshold.at(0.0));
        q.queue.count = 0;
        q.queue.common = ray::Common::default();
        for ray in rays {
            let d = unit(ray.direction).unwrap_or(Vec3::Z);
            let [o, d] = [ray.origin, d].map(|c| v3(c.x, c.y, c.z));
            let start = region.enter(o, d, 0.0, reach).max(ray.near);
            let end = region.leave(o, d, 0.0, reach).min(ray.far);
            let ray = ray::WideRay {
                origin: o,
                direction: d,
                narrow: 1.0,
                travelled: 0.0,
            };
            q.queue.push(&ray, start, end);
        }
    }

    /// Does something with the solid as these rays see it.
    fn with<T>(
        &self,
        q: &mut Scratch,
        work: impl FnOnce(&Self, &Solid<'_>, &mut Scratch) -> T,
    ) -> T {
        let (picture, never) = (self.picture, AtomicBool::new(false));
        let instructions = picture.program.structure().values.instructions.len();
        let stop = Stop::new(&Silent, &never, instructions);
        let solid = Solid::new(
            picture.field(),
            picture.region,
            &self.view,
            picture.scene.settings().max_steps,
            picture.skins,
            1,
            &stop,
        );
        work(self, &solid, q)
    }

    /// Follows the rays of the queue: what they meet, with the number of the ray.
    fn hits(&self, q: &mut Scratch) -> Vec<(usize, Hit)> {
        self.with(q, |query, solid, q| {
            let settings = query.picture.scene.settings();
            let plan = Plan {
                march: settings.march,
                select: settings.hit_selection,
                steps: false,
            };
            at_level!(query.picture.renderer.level, s => {
                let (queue, memory) = q.split();
                if query.most == 1 {
                    closest(s, &plan, solid, queue, memory);
                } else {
                    crossings(s, query.most, solid, queue, memory);
                }
                place(s, solid, 0, false, q);
                normals(s, solid, Normals::Exact, q);
                marks(s, solid, q);
            });
            let number = |mark: f32| (mark >= 0.0).then_some(mark as usize);
            let vector = |columns: &[Box<Sheet>; 3], i: usize| {
                Vec3::from_array(columns.each_ref().map(|column| column[i]))
            };
            let hits = &q.hits;
            let hit = |i: usize| {
                let hit = Hit {
                    t: hits.t[i],
                    point: vector(&hits.point, i),
                    normal: vector(&hits.normal, i),
                    object: number(hits.object[i]),
                    material: number(hits.first[i]).map(|m| query.picture.material_of(m)),
                    inside: hits.word[i] & INSIDE != 0,
                };
                ((hits.word[i] & ORDINAL) as usize, hit)
            };
            (0..hits.count).map(hit).collect()
        })
    }
}
