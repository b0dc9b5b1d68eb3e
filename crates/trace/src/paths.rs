//! Rays that go on from hits, and what the light is worth that they bring.

use crate::ray::{Common, Queue, WideRay};
use crate::simd::TILE_RAYS;
use crate::tile::Solid;
use zeroset_number::{Vec3, v3};

/// A ray that goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathRay {
    pub(crate) ray: WideRay<f32>,
    pub(crate) state: PathState,
    /// Where along it there may be something: infinity where there is nothing.
    pub(crate) start: f32,
}

/// What is known of the way from the eye to where a ray begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathState {
    /// Number of the pixel in its tile.
    pub(crate) pixel: usize,
    /// The share of the light along the ray that comes to the eye.
    pub(crate) weight: Vec3<f32>,
    /// Reflections on the way.
    pub(crate) reflections: u32,
    /// Surfaces of clear bodies that were passed, or met from inside.
    pub(crate) refractions: u32,
    /// The material of the clear body that the ray is in, by number.
    pub(crate) medium: Option<f32>,
    /// Surfaces on the way.
    pub(crate) bounces: u32,
    /// Whether a matte body scattered the light: then the sky counts as what lights the scene, else as what is seen.
    pub(crate) is_scattered: bool,
    /// Whether the last surface was that of a clear body, behind which no ray looks for lights.
    pub(crate) sees_lights: bool,
    /// The density over directions with which the last surface chose the ray's, where lights are looked for from there too.
    pub(crate) density: Option<f32>,
    /// Whether the ray comes from the eye: it shows a part of its pixel.
    pub(crate) is_from_eye: bool,
}

/// The rays that go on in a tile.
pub(crate) struct Paths {
    /// Those of the queue, in its order; none where it holds those from the eye.
    followed: Vec<PathRay>,
    /// Those to come, outside and inside of clear bodies. The last come first: so there are never many.
    waiting: [Vec<PathRay>; 2],
    /// Which of the queue met a surface.
    met: Vec<bool>,
    /// How much of their pixels the rays of the queue show that come from the eye.
    shares: Vec<f32>,
    /// The pixels whose share is not the whole.
    parted: Vec<usize>,
}

impl Paths {
    pub(crate) fn new() -> Paths {
        Paths {
            followed: Vec::with_capacity(TILE_RAYS),
            waiting: [(); 2].map(|()| Vec::with_capacity(TILE_RAYS)),
            met: vec![false; TILE_RAYS],
            shares: vec![1.0; TILE_RAYS],
            parted: Vec::new(),
        }
    }

    /// The queue holds rays from the eye, which show all of their pixels, and none goes on yet.
    pub(crate) fn begin(&mut self) {
        self.followed.clear();
        self.waiting.iter_mut().for_each(Vec::clear);
        for pixel in self.parted.drain(..) {
            self.shares[pixel] = 1.0;
        }
    }

    /// The ray of the queue through a pixel shows this part of it.
    pub(crate) fn set_share(&mut self, pixel: usize, share: f32) {
        self.shares[pixel] = share;
        self.parted.push(pixel);
    }

    /// The pixels that the rays of the queue from the eye show a part of only, and how much.
    pub(crate) fn parted(&self) -> impl Iterator<Item = (usize, f32)> {
        self.parted.iter().map(|&pixel| (pixel, self.shares[pixel]))
    }

    /// Whether the queue holds rays from the eye.
    pub(crate) fn is_from_eye(&self) -> bool {
        self.followed.is_empty()
    }

    /// The state of a ray of the queue.
    pub(crate) fn state(&self, number: usize) -> PathState {
        match self.followed.get(number) {
            Some(path) => path.state,
            None => PathState::from_eye(number, self.shares[number]),
        }
    }

    /// Number of the pixel of a ray of the queue.
    pub(crate) fn pixel(&self, number: usize) -> usize {
        self.followed
            .get(number)
            .map_or(number, |path| path.state.pixel)
    }

    /// A ray that goes on from a surface.
    pub(crate) fn push(&mut self, ray: WideRay<f32>, state: PathState) {
        let state = PathState {
            is_from_eye: false,
            ..state
        };
        let start = 0.0;
        self.waiting[usize::from(state.medium.is_some())].push(PathRay { ray, state, start });
    }

    /// A ray from the eye that is followed later than those of the queue.
    pub(crate) fn push_from_eye(&mut self, path: PathRay) {
        self.waiting[0].push(path);
    }

    /// Fills the queue with rays that wait, as many as it holds, all of them inside clear bodies or none (these go through `outside`). Gives whether they are inside;
    /// none where no ray waits.
    pub(crate) fn next(
        &mut self,
        solid: &Solid<'_>,
        outside: &Solid<'_>,
        queue: &mut Queue,
    ) -> Option<bool> {
        let inside = self.waiting[1].len() > self.waiting[0].len();
        let solid = if inside { solid } else { outside };
        let waiting = &mut self.waiting[usize::from(inside)];
        let from = waiting.len().saturating_sub(TILE_RAYS);
        self.followed.clear();
        self.followed.extend(waiting.drain(from..));
        queue.count = 0;
        queue.common = Common::default();
        let reach = solid.view.threshold;
        for PathRay { ray, start, .. } in &self.followed {
            let end = solid
                .region
                .leave(
                    ray.origin,
                    ray.direction,
                    reach.slope,
                    reach.at(ray.travelled),
                )
                .min(solid.view.far);
            queue.push(ray, *start, end);
        }
        self.met[..queue.count].fill(false);
        (queue.count > 0).then_some(inside)
    }

    /// That a ray of the queue met a surface.
    pub(crate) fn meets(&mut self, number: usize) {
        self.met[number] = true;
    }

    /// The rays of the queue that met nothing.
    pub(crate) fn missed(&self) -> impl Iterator<Item = &PathRay> {
        (self.followed.iter().zip(&self.met)).filter_map(|(path, met)| (!met).then_some(path))
    }
}

impl PathState {
    /// That of a ray from the eye which shows this much of its pixel.
    pub(crate) fn from_eye(pixel: usize, share: f32) -> PathState {
        PathState {
            pixel,
            weight: v3(share, share, share),
            reflections: 0,
            refractions: 0,
            medium: None,
            bounces: 0,
            is_scattered: false,
            sees_lights: false,
            density: None,
            is_from_eye: true,
        }
    }
}
