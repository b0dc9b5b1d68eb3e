//! The statistics, with a renderer whose truth is known.

use super::*;
use crate::scene::Scene;
use std::ops::Range;
use std::sync::Arc;

const SIZE: [u32; 2] = [128, 32];

/// Draws independent numbers of a known mean, spread very unevenly over the two cells of the picture.
struct Dice {
    seed: u32,
    is_adaptive: bool,
}

/// What every pixel converges to.
const TRUTH: f64 = 0.25;

impl Dice {
    /// Sample number `index` of pixel `i`: on the right 1 one time in four, on the left nearly the truth.
    fn draw(&self, i: usize, index: u32) -> f32 {
        let random = round_seed(self.seed ^ round_seed(index, 77), i as u32);
        let unit = (random >> 8) as f32 / (1 << 24) as f32;
        if i % SIZE[0] as usize >= 64 {
            return f32::from(unit < 0.25);
        }
        0.25 + 0.02 * (unit - 0.5)
    }

    fn fill(&self, into: &mut Accumulator, count: impl Fn(usize) -> u32) {
        for (sum, numbers) in into.sums_mut() {
            for i in 0..(SIZE[0] * SIZE[1]) as usize {
                let n = count(i);
                let total: f32 = (0..n).map(|index| self.draw(i, index)).sum();
                match sum {
                    Sum::Colour => {
                        numbers[3 * i..3 * i + 3].fill(total * MOST as f32 / n as f32);
                    }
                    Sum::Weight => numbers[i] = MOST as f32,
                    _ => {}
                }
            }
        }
        into.count(MOST);
    }
}

impl Prepared for Dice {
    fn update(&mut self, _: Arc<Scene>) -> Result<(), RenderError> {
        Ok(())
    }

    fn sample(
        &mut self,
        _: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        _: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        // as a renderer leaves it: not weighed yet
        let n = samples.end;
        self.fill(into, |_| n);
        for (_, numbers) in into.sums_mut() {
            numbers
                .iter_mut()
                .for_each(|x| *x *= n as f32 / MOST as f32);
        }
        Ok(Statistics::default())
    }

    fn reseed(&mut self, seed: u32) -> Result<(), RenderError> {
        self.seed = seed;
        Ok(())
    }

    fn is_adaptive(&self) -> bool {
        self.is_adaptive
    }

    fn sample_where(
        &mut self,
        _: &Camera,
        map: &SampleMap,
        into: &mut Accumulator,
        _: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        self.fill(into, |i| map.count(cell_of(i, SIZE)));
        Ok(Statistics::default())
    }
}

fn camera() -> Camera {
    Camera {
        eye: glam::Vec3::ZERO,
        axes: glam::Mat3::IDENTITY,
        lens: crate::camera::Lens::Pinhole { fov: 1.0 },
        near: 0.0,
        far: 1.0,
        aperture: 0.0,
        focus: 0.0,
    }
}

fn converged(seed: u32, target: f64, is_adaptive: bool) -> Progressive {
    let mut dice = Dice {
        seed: 0,
        is_adaptive,
    };
    let mut picture = Progressive::new(SIZE, Filter::Box, &[Plane::Colour], seed, 0.0);
    while picture.noise() > target {
        let silent = crate::render::Silent;
        (picture.advance(&mut dice, &camera(), Some(target), &silent)).unwrap();
        assert!(picture.rounds() < 1000, "it never ends");
    }
    picture
}

/// A picture that ended because its error seemed small enough: its intervals hold the truth as often as they say, and its mean is the
/// truth, where samples were few and where they were many.
#[test]
fn intervals_hold_the_truth_and_means_are_not_biased() {
    let (mut held, mut sum, mut square) = ([0u32; 2], [0.0; 2], [0.0; 2]);
    let seeds = 200;
    for seed in 0..seeds {
        let picture = converged(seed, 0.06, true);
        for i in (0..(SIZE[0] * SIZE[1]) as usize).step_by(7) {
            let side = usize::from(i % SIZE[0] as usize >= 64);
            let interval = picture.interval(i);
            held[side] += u32::from(interval.holds(TRUTH));
            sum[side] += interval.mean - TRUTH;
            square[side] += (interval.mean - TRUTH).powi(2);
        }
    }
    let all = f64::from(SIZE[0] * SIZE[1] / 14 * seeds);
    for side in 0..2 {
        let share = f64::from(held[side]) / all;
        assert!((share - 0.95).abs() < 0.02, "side {side}: {share}");
        // four standard errors of the mean
        let bias = sum[side] / all;
        let error = (square[side] / all / all).sqrt();
        assert!(bias.abs() < 4.0 * error, "side {side}: {bias}, {error}");
    }
}

/// Samples go where the error is, and a renderer that cannot spread them takes more for the same.
#[test]
fn samples_go_where_the_error_is() {
    let (adaptive, even) = (converged(5, 0.03, true), converged(5, 0.03, false));
    let map = adaptive.plan(Some(0.03));
    assert_eq!(map.count(0), LEAST);
    assert!(adaptive.noise() <= 0.03 && even.noise() <= 0.03);
    assert!(even.rays() as f64 > 1.3 * adaptive.rays() as f64);
    // nothing is known before there are some rounds, and without an aim there is nothing to prefer
    let fresh = Progressive::new(SIZE, Filter::Box, &[Plane::Colour], 5, 0.0);
    assert_eq!(fresh.plan(Some(0.03)), SampleMap::even(SIZE, USUAL));
    assert_eq!(adaptive.plan(None), SampleMap::even(SIZE, USUAL));
    assert_eq!((fresh.noise(), fresh.left(0.1)), (f64::INFINITY, None));
}

#[test]
fn errors_fall_by_the_root_of_the_samples() {
    let mut dice = Dice {
        seed: 0,
        is_adaptive: true,
    };
    let mut picture = Progressive::new(SIZE, Filter::Box, &[Plane::Colour], 9, 0.0);
    let mut noise = Vec::new();
    for round in 1..=256 {
        let silent = crate::render::Silent;
        picture
            .advance(&mut dice, &camera(), None, &silent)
            .unwrap();
        if [64, 256].contains(&round) {
            noise.push(picture.noise());
        }
    }
    // twice, times what 95 of 100 estimates of it from 63 and 255 differences are below, times Student's quantiles
    let chance = |n: f64| 1.0 + 1.645 / (2.0 * n).sqrt();
    let wanted = 2.0 * chance(63.0) / chance(255.0) * student(63) / student(255);
    assert!(
        (noise[0] / noise[1] - wanted).abs() < 0.08,
        "{noise:?}, {wanted}"
    );
    let left = picture.left(0.5 * picture.noise()).unwrap();
    assert!((left - 3.0).abs() < 1e-9);
}

#[test]
fn cells_cover_the_picture() {
    for size in [[1, 1], [64, 32], [65, 33], [200, 7], [3, 100]] {
        let all: u64 = (0..cells(size)).map(|cell| pixels(cell, size)).sum();
        assert_eq!(all, u64::from(size[0]) * u64::from(size[1]));
        let mut count = vec![0; cells(size)];
        for i in 0..(size[0] * size[1]) as usize {
            count[cell_of(i, size)] += 1;
        }
        for (cell, n) in count.into_iter().enumerate() {
            assert_eq!(n, pixels(cell, size));
        }
        assert_eq!(SampleMap::even(size, 3).rays(), 3 * all);
    }
}

/// What was kept goes on as if nothing had happened.
#[test]
fn a_picture_goes_on_from_what_was_kept() {
    let whole = converged(3, 0.05, true);
    let mut dice = Dice {
        seed: 0,
        is_adaptive: true,
    };
    let mut first = Progressive::new(SIZE, Filter::Box, &[Plane::Colour], 3, 0.0);
    let silent = crate::render::Silent;
    for _ in 0..whole.rounds() - 3 {
        (first.advance(&mut dice, &camera(), Some(0.05), &silent)).unwrap();
    }
    let mut second = Progressive::new(SIZE, Filter::Box, &[Plane::Colour], 3, 0.0);
    let state = first.state();
    let fill = |cells: &mut [Cell], moments: &mut [Moments], sums: &mut Accumulator| {
        cells.copy_from_slice(state.cells);
        moments.copy_from_slice(state.moments);
        for (sum, numbers) in sums.sums_mut() {
            numbers.copy_from_slice(state.sums.sum(sum));
        }
        Ok::<(), ()>(())
    };
    second.restore(state.rounds, state.rays, fill).unwrap();
    while second.noise() > 0.05 {
        (second.advance(&mut dice, &camera(), Some(0.05), &silent)).unwrap();
    }
    assert_eq!(second.rounds(), whole.rounds());
    assert!(second.film() == whole.film());
    // what cannot be restored leaves nothing
    assert!(second.restore(1, 1, |_, _, _| Err(())).is_err());
    let fresh = Progressive::new(SIZE, Filter::Box, &[Plane::Colour], 3, 0.0);
    assert!(second.film() == fresh.film() && second.rounds() == 0);
}
