//! Rays from anywhere to anywhere, and the columns that hold many of them.

use crate::simd::{Chosen, Numbers, Sheet, first_lanes, load, load3, splat, splat3};
use crate::tile::RaySpans;
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_number::{Lanes, Real, Vec3, v3};

/// A ray: where it begins, where it goes, and how wide the footprint of its pixel is along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WideRay<R> {
    pub(crate) origin: Vec3<R>,
    /// Of length 1.
    pub(crate) direction: Vec3<R>,
    /// How much narrower the footprint is than in the middle of the picture, see [`zeroset_shade::view::View::narrow`].
    pub(crate) narrow: R,
    /// The way from the eye to the origin: the footprint grows along all of it. (A flat mirror leaves it as it is; what a
    /// curved one does to it is not known here.)
    pub(crate) travelled: R,
}

impl<R: Real<Scalar = f32>> WideRay<R> {
    /// The way from the eye to the place at `t`.
    #[inline(always)]
    pub(crate) fn way(&self, t: R) -> R {
        t + self.travelled
    }
}

/// What all rays of a stream have in common, and what is not stored for each of them then: rays from a pinhole have an origin, parallel
/// ones a direction, and those from the eye come from nowhere else.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Common {
    pub(crate) origin: Option<[f32; 3]>,
    pub(crate) direction: Option<[f32; 3]>,
    pub(crate) narrow: Option<f32>,
    pub(crate) travelled: Option<f32>,
}

/// Rays, a column for each of their numbers.
pub(crate) struct RayColumns<C> {
    origin: [C; 3],
    direction: [C; 3],
    narrow: C,
    travelled: C,
}

impl<C: Numbers> RayColumns<C> {
    /// Columns, each of them made by `column`.
    pub(crate) fn new(column: impl Fn() -> C) -> Self {
        RayColumns {
            origin: std::array::from_fn(|_| column()),
            direction: std::array::from_fn(|_| column()),
            narrow: column(),
            travelled: column(),
        }
    }

    /// The rays from number `i` on.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&self, s: S, common: &Common, i: usize) -> WideRay<Lanes<S>> {
        WideRay {
            origin: match common.origin {
                Some(c) => splat3(s, c),
                None => load3(s, &self.origin, i),
            },
            direction: match common.direction {
                Some(c) => splat3(s, c),
                None => load3(s, &self.direction, i),
            },
            narrow: match common.narrow {
                Some(c) => splat(s, c),
                None => load(s, self.narrow.numbers(), i),
            },
            travelled: match common.travelled {
                Some(c) => splat(s, c),
                None => load(s, self.travelled.numbers(), i),
            },
        }
    }

    /// Writes the rays from number `at` on.
    #[inline(always)]
    pub(crate) fn store<S: Simd>(&mut self, common: &Common, ray: &WideRay<Lanes<S>>, at: usize) {
        let s = ray.narrow.0.token();
        self.put(Chosen::new(first_lanes(s, S::f32s::LEN)), common, ray, at);
    }

    /// Writes the chosen rays, closed up, from number `at` on. Those behind them become garbage.
    #[inline(always)]
    pub(crate) fn put<S: Simd>(
        &mut self,
        chosen: Chosen<S>,
        common: &Common,
        ray: &WideRay<Lanes<S>>,
        at: usize,
    ) {
        if common.origin.is_none() {
            chosen.put3(ray.origin, &mut self.origin, at);
        }
        if common.direction.is_none() {
            chosen.put3(ray.direction, &mut self.direction, at);
        }
        if common.narrow.is_none() {
            chosen.put(ray.narrow, self.narrow.numbers_mut(), at);
        }
        if common.travelled.is_none() {
            chosen.put(ray.travelled, self.travelled.numbers_mut(), at);
        }
    }

    /// Ray number `i`.
    pub(crate) fn get(&self, common: &Common, i: usize) -> WideRay<f32> {
        let vector = |common: Option<[f32; 3]>, columns: &[C; 3]| {
            let [x, y, z] = common.unwrap_or_else(|| columns.each_ref().map(|c| c.numbers()[i]));
            v3(x, y, z)
        };
        WideRay {
            origin: vector(common.origin, &self.origin),
            direction: vector(common.direction, &self.direction),
            narrow: common.narrow.unwrap_or_else(|| self.narrow.numbers()[i]),
            travelled: (common.travelled).unwrap_or_else(|| self.travelled.numbers()[i]),
        }
    }

    /// Writes ray number `i`.
    pub(crate) fn set(&mut self, i: usize, ray: &WideRay<f32>) {
        let columns = self.columns_mut();
        let numbers = (ray.origin.array().into_iter())
            .chain(ray.direction.array())
            .chain([ray.narrow, ray.travelled]);
        columns.zip(numbers).for_each(|(column, x)| column[i] = x);
    }

    /// Copies a range of rays to the front.
    pub(crate) fn move_to_front(&mut self, range: Range<usize>) {
        self.columns_mut()
            .for_each(|column| column.copy_within(range.clone(), 0));
    }

    /// All columns.
    pub(crate) fn columns_mut(&mut self) -> impl Iterator<Item = &mut [f32]> {
        (self.origin.iter_mut())
            .chain(&mut self.direction)
            .chain([&mut self.narrow, &mut self.travelled])
            .map(C::numbers_mut)
    }
}

/// Rays that wait to be followed, as many as a tile has at most: from anywhere to anywhere.
pub(crate) struct Queue {
    pub(crate) count: usize,
    /// What all of them have in common.
    pub(crate) common: Common,
    pub(crate) rays: RayColumns<Box<Sheet>>,
    /// Where they start and end, and what is known of the field there. One that ends before it starts is not followed.
    pub(crate) spans: RaySpans,
    /// Where they meet solids in closed form, if [`Queue::limited`]: see [`crate::closed`].
    pub(crate) limit: Box<Sheet>,
    /// Whether rays end there.
    pub(crate) limited: bool,
}

impl Queue {
    /// One without rays.
    pub(crate) fn new() -> Queue {
        Queue {
            count: 0,
            common: Common::default(),
            rays: RayColumns::new(Sheet::boxed),
            spans: RaySpans::new(),
            limit: Sheet::boxed(),
            limited: false,
        }
    }

    /// The rays from number `i` on.
    #[inline(always)]
    pub(crate) fn ray<S: Simd>(&self, s: S, i: usize) -> WideRay<Lanes<S>> {
        self.rays.load(s, &self.common, i)
    }

    /// Adds a ray that is followed from `start` to `end`. Nothing but the field says on which side of a surface it starts.
    pub(crate) fn push(&mut self, ray: &WideRay<f32>, start: f32, end: f32) {
        let (i, spans) = (self.count, &mut self.spans);
        self.rays.set(i, ray);
        (spans.start[i], spans.end[i]) = (start, end);
        (spans.slope[i], spans.radius[i]) = (-1.0, 0.0);
        self.count += 1;
    }
}
