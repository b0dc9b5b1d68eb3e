//! Pictures that converge: rounds of independent samples, what is known of their error, and where the next samples go.
//!
//! Samples of one pixel are points of one low-discrepancy sequence: they know of each other, and their spread says nothing honest of
//! the error of their mean. So samples come in *rounds*. Each round scrambles the sequence anew, with a seed of its own, so that the
//! means of rounds are independent and alike: randomised quasi-Monte Carlo with replicates (Owen 1997; L'Ecuyer and Lemieux 2002).
//! Their spread gives the variance of their mean without bias, and Student's distribution the interval that holds the truth 95 times of
//! a hundred. A pixel is a ratio, of what its filter sums up to the filter's weights, and its variance that of a ratio's residuals
//! (Cochran 1977, equation 6.9), so that intervals are right for every filter.
//!
//! Where samples go ([`Progressive::plan`]) follows from the rounds before alone, and every round counts the same, however many samples
//! it took at a place. So the mean of the rounds is a sum of terms each of which is right on average given all before it: adaptive
//! sampling without the bias of plain means, whose numbers of samples depend on their values (Kirk and Arvo 1991). What is left is that
//! of ending when the error seems small, which a test measures.

mod noise;

pub use noise::{Interval, displayed, student};

use crate::accumulator::{self, Accumulator, Sum};
use crate::camera::Camera;
use crate::film::{Film, Plane};
use crate::render::{Observer, Prepared, RenderError, Statistics};
use crate::settings::{Antialias, Filter};

/// Width and height of the cells that samples are spread over: tiles of the CPU's renderer, pixels.
pub const CELL: [u32; 2] = [64, 32];
/// Rays a pixel of a round where nothing is known yet.
pub const USUAL: u32 = 16;
/// Rays a pixel of a round where there is little error.
pub const LEAST: u32 = 4;
/// Rays a pixel of a round where there is much of it.
pub const MOST: u32 = 64;
/// Rounds before which no error is believed: with fewer, a spread that is small by chance would end a picture.
pub const ROUNDS: u32 = 8;
/// The share of the pixels of a cell whose intervals are to be narrow.
pub const SHARE: f64 = 0.95;

/// How many rays a pixel has in each cell of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleMap {
    size: [u32; 2],
    counts: Vec<u32>,
}

impl SampleMap {
    /// The same number everywhere.
    pub fn even(size: [u32; 2], count: u32) -> SampleMap {
        SampleMap {
            size,
            counts: vec![count; cells(size)],
        }
    }

    /// Rays of the pixels of cell number `cell`, row by row from the top left.
    pub fn count(&self, cell: usize) -> u32 {
        self.counts[cell]
    }

    /// The most rays of a pixel.
    pub fn most(&self) -> u32 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// Rays of all pixels together.
    pub fn rays(&self) -> u64 {
        let of = |(cell, count): (usize, &u32)| pixels(cell, self.size) * u64::from(*count);
        self.counts.iter().enumerate().map(of).sum()
    }
}

/// Cells of a picture.
pub fn cells([width, height]: [u32; 2]) -> usize {
    width.div_ceil(CELL[0]) as usize * height.div_ceil(CELL[1]) as usize
}

/// Pixels of a cell.
fn pixels(cell: usize, size: [u32; 2]) -> u64 {
    let across = size[0].div_ceil(CELL[0]);
    let at = [cell as u32 % across, cell as u32 / across];
    let [w, h] = [0, 1].map(|k| u64::from(CELL[k].min(size[k] - at[k] * CELL[k])));
    w * h
}

/// The cell of pixel number `i`.
fn cell_of(i: usize, size: [u32; 2]) -> usize {
    let [width, high] = [size[0] as usize, CELL[1] as usize];
    let across = size[0].div_ceil(CELL[0]) as usize;
    (i / width / high) * across + i % width / CELL[0] as usize
}

/// What is known of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// The sum over all rounds of one over the rays that a pixel had.
    pub inverses: f64,
    /// The width that intervals have there; infinite before the first rounds.
    noise: f64,
}

/// Sums of the products of what a round gave a pixel: of the luminance of its filtered sum with itself, with the filter's weights, and of
/// these with themselves.
pub type Moments = [f64; 3];

/// A picture that converges.
#[derive(Clone, Debug)]
pub struct Progressive {
    seed: u32,
    /// Light is multiplied by this before it is shown.
    gain: f64,
    sums: Accumulator,
    /// The round that is being taken.
    round: Accumulator,
    rounds: u32,
    rays: u64,
    cells: Vec<Cell>,
    moments: Vec<Moments>,
}

/// Rec. 709.
fn luminance([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}

/// The filter of a picture that converges: that of supersampling, and the default one where another antialiasing is stated.
pub fn filter(antialias: Antialias) -> Filter {
    if let Antialias::Supersample { filter, .. } = antialias {
        filter
    } else {
        Filter::default()
    }
}

/// Bytes that a picture that converges takes: two sets of sums, and what is known of its error.
pub fn bytes(size: [u32; 2], planes: &[Plane]) -> u64 {
    let moments = u64::from(size[0]) * u64::from(size[1]) * size_of::<Moments>() as u64;
    (2 * accumulator::bytes(size, planes)).saturating_add(moments)
}

impl Progressive {
    /// A picture without samples. `seed` chooses all its random numbers, `exposure` (stops) is how bright it is shown. It has colours,
    /// whichever planes it has beside them. The caller has checked the size against its limits.
    pub fn new(
        size: [u32; 2],
        filter: Filter,
        planes: &[Plane],
        seed: u32,
        exposure: f32,
    ) -> Progressive {
        let mut planes = planes.to_vec();
        if !planes.contains(&Plane::Colour) {
            planes.push(Plane::Colour);
        }
        let antialias = Antialias::Supersample {
            samples: MOST,
            filter,
        };
        let empty = Accumulator::new(size, antialias, &planes);
        Progressive {
            seed,
            gain: f64::from(exposure).exp2(),
            round: empty.clone(),
            sums: empty,
            rounds: 0,
            rays: 0,
            cells: vec![Cell::default(); cells(size)],
            moments: vec![[0.0; 3]; size[0] as usize * size[1] as usize],
        }
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.sums.size()
    }

    /// Rounds that are done.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Rays from the eye that were taken.
    pub fn rays(&self) -> u64 {
        self.rays
    }

    /// Rays that a pixel has on average.
    pub fn samples(&self) -> f64 {
        let [width, height] = self.size().map(f64::from);
        self.rays as f64 / (width * height)
    }

    /// Where the samples of the next round go: without a `target` everywhere alike. With one, few where 95 of 100 intervals are that
    /// narrow, and elsewhere as many as the variance of a sample there, over the mean of such places, asks for.
    pub fn plan(&self, target: Option<f64>) -> SampleMap {
        let mut map = SampleMap::even(self.size(), USUAL);
        let Some(target) = target.filter(|_| self.rounds >= ROUNDS) else {
            return map;
        };
        let rounds = f64::from(self.rounds);
        let variance = |cell: &Cell| cell.noise * cell.noise * rounds * rounds / cell.inverses;
        let open = || self.cells.iter().filter(|c| c.noise > target);
        let mean = open().map(variance).sum::<f64>() / open().count().max(1) as f64;
        for (count, cell) in map.counts.iter_mut().zip(&self.cells) {
            let share = if cell.noise > target && mean > 0.0 {
                variance(cell) / mean
            } else {
                0.0
            };
            // powers of two: such beginnings of the sequence are evenly spread
            let power = (f64::from(USUAL) * share).log2().round();
            let bounds = [LEAST, MOST].map(|n| f64::from(n.ilog2()));
            *count = 1 << power.clamp(bounds[0], bounds[1]) as u32;
        }
        map
    }

    /// Takes another round: of a scene that `prepared` has, as `camera` sees it. Where a renderer cannot spread samples unevenly, all
    /// pixels have as many.
    ///
    /// # Errors
    /// See [`RenderError`]. The picture is then as it was before.
    pub fn advance(
        &mut self,
        prepared: &mut dyn Prepared,
        camera: &Camera,
        target: Option<f64>,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let map = match prepared.is_adaptive() {
            true => self.plan(target),
            false => self.plan(None),
        };
        prepared.reseed(round_seed(self.seed, self.rounds))?;
        self.round.clear();
        let statistics = prepared.sample_where(camera, &map, &mut self.round, observer)?;
        self.take(&map);
        Ok(statistics)
    }

    /// Adds the round that was taken.
    fn take(&mut self, map: &SampleMap) {
        self.rounds += 1;
        self.rays += map.rays();
        for (cell, count) in self.cells.iter_mut().zip(&map.counts) {
            cell.inverses += 1.0 / f64::from(*count);
        }
        let colours = self.round.sum(Sum::Colour).as_chunks::<3>().0;
        let weights = self.round.sum(Sum::Weight);
        for ((moments, colour), weight) in self.moments.iter_mut().zip(colours).zip(weights) {
            let (y, w) = (luminance(*colour), f64::from(*weight));
            for (moment, x) in moments.iter_mut().zip([y * y, y * w, w * w]) {
                *moment += x;
            }
        }
        self.sums.add(&self.round);
        self.measure();
    }

    /// Finds how wide the intervals of the cells are.
    fn measure(&mut self) {
        let mut widths: Vec<Vec<f64>> = self.cells.iter().map(|_| Vec::new()).collect();
        for i in 0..self.moments.len() {
            let width = self.interval(i).noise(self.gain);
            widths[cell_of(i, self.size())].push(width);
        }
        for (cell, widths) in self.cells.iter_mut().zip(&mut widths) {
            let at = ((SHARE * widths.len() as f64).ceil() as usize).clamp(1, widths.len()) - 1;
            cell.noise = *widths.select_nth_unstable_by(at, f64::total_cmp).1;
        }
    }

    /// Where the luminance of pixel number `i` is, linear light, 95 times of a hundred.
    pub fn interval(&self, i: usize) -> Interval {
        let rounds = f64::from(self.rounds);
        let [r, g, b] = self.sums.sum(Sum::Colour).as_chunks::<3>().0[i];
        let weight = f64::from(self.sums.sum(Sum::Weight)[i]);
        if self.rounds < 2 || weight <= 0.0 {
            return Interval {
                mean: luminance([r, g, b]) / weight.max(1e-6),
                half: f64::INFINITY,
            };
        }
        let mean = luminance([r, g, b]) / weight;
        let [yy, yw, ww] = self.moments[i];
        let spread = (yy - 2.0 * mean * yw + mean * mean * ww).max(0.0);
        let variance = spread * rounds / (rounds - 1.0) / (weight * weight);
        Interval {
            mean,
            half: student(self.rounds - 1) * variance.sqrt(),
        }
    }

    /// How wide 95 % intervals are in the worst cell: of 100 pixels there, 95 are that near to what they converge to, as a share of white
    /// on a screen (see [`displayed`]). Infinite before there are [`ROUNDS`] rounds.
    pub fn noise(&self) -> f64 {
        if self.rounds < ROUNDS {
            return f64::INFINITY;
        }
        self.cells.iter().map(|c| c.noise).fold(0.0, f64::max)
    }

    /// The share of the cells whose intervals are that narrow.
    pub fn finished(&self, target: f64) -> f64 {
        let is_done = |cell: &&Cell| self.rounds >= ROUNDS && cell.noise <= target;
        self.cells.iter().filter(is_done).count() as f64 / self.cells.len().max(1) as f64
    }

    /// How much longer it takes until the noise is `target`, as a multiple of what it took so far: errors fall by the root of the samples.
    /// None where nothing is known yet.
    pub fn left(&self, target: f64) -> Option<f64> {
        let ratio = self.noise() / target;
        ratio.is_finite().then(|| (ratio * ratio - 1.0).max(0.0))
    }

    /// The picture as it is.
    pub fn film(&self) -> Film {
        self.sums.film()
    }

    /// As [`Progressive::film`], in the memory of the sums.
    pub fn into_film(self) -> Film {
        drop(self.round);
        self.sums.into_film()
    }

    /// What it holds, to be kept.
    pub fn state(&self) -> State<'_> {
        State {
            rounds: self.rounds,
            rays: self.rays,
            cells: &self.cells,
            moments: &self.moments,
            sums: &self.sums,
        }
    }

    /// Goes on from what was kept of a picture of the same size and planes, with the same seed: `fill` writes the numbers.
    ///
    /// # Errors
    /// What `fill` says; then there are no samples.
    pub fn restore<E>(
        &mut self,
        rounds: u32,
        rays: u64,
        fill: impl FnOnce(&mut [Cell], &mut [Moments], &mut Accumulator) -> Result<(), E>,
    ) -> Result<(), E> {
        let filled = fill(&mut self.cells, &mut self.moments, &mut self.sums);
        if filled.is_err() {
            self.sums.clear();
            self.cells.fill(Cell::default());
            self.moments.fill([0.0; 3]);
            (self.rounds, self.rays) = (0, 0);
            return filled;
        }
        self.sums.count(rounds.saturating_mul(MOST));
        (self.rounds, self.rays) = (rounds, rays);
        self.measure();
        Ok(())
    }
}

/// What a picture that converges holds.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Rounds that are done.
    pub rounds: u32,
    /// Rays from the eye that were taken.
    pub rays: u64,
    /// By cell, row by row.
    pub cells: &'a [Cell],
    /// By pixel, row by row.
    pub moments: &'a [Moments],
    /// The sums of all rounds.
    pub sums: &'a Accumulator,
}

/// The seed of a round: another one for each, of each seed of a picture.
fn round_seed(seed: u32, round: u32) -> u32 {
    // splitmix64 (Steele, Lea and Flood 2014) is a bijection of 64 bits; half of them collide once in four milliards
    let mut z = (u64::from(seed) << 32 | u64::from(round)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as u32
}

#[cfg(test)]
mod tests;
