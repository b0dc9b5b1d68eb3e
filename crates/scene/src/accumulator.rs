//! Sums of samples: what a renderer adds to, and what films are developed from.
//!
//! More samples can be added at any time, by any renderer, so that a picture can begin coarse and become finer, or go on where it
//! was left.

use crate::film::{Film, Plane};
use crate::settings::{Antialias, Filter};

/// One sum of every pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sum {
    /// Of linear colours, each times the weight that the filter gives its sample; 3 numbers.
    Colour,
    /// Of the weights of samples that hit.
    Coverage,
    /// Of all weights.
    Weight,
    /// Samples that hit.
    Hits,
    /// The smallest distance of a hit; infinite where there is none.
    Depth,
    /// Of normals; 3 numbers.
    Normal,
    /// Of the colours of surfaces; 3 numbers.
    Albedo,
    /// Of ambient visibilities.
    Occlusion,
    /// Of visibilities of the lights.
    Shadow,
    /// Of evaluations that primary rays took.
    Steps,
    /// |f| at the nearest hit.
    Residual,
    /// Number of the object of the nearest hit plus 1; 0 where there is none.
    Object,
}

impl Sum {
    /// All sums, in the order in which they are kept.
    pub const ALL: [Sum; 12] = [
        Sum::Colour,
        Sum::Coverage,
        Sum::Weight,
        Sum::Hits,
        Sum::Depth,
        Sum::Normal,
        Sum::Albedo,
        Sum::Occlusion,
        Sum::Shadow,
        Sum::Steps,
        Sum::Residual,
        Sum::Object,
    ];

    /// Numbers a pixel.
    pub const fn channels(self) -> usize {
        match self {
            Sum::Colour | Sum::Normal | Sum::Albedo => 3,
            _ => 1,
        }
    }

    /// Whether it is a sum over the samples around a pixel, not over its own.
    pub const fn is_filtered(self) -> bool {
        matches!(self, Sum::Colour | Sum::Coverage | Sum::Weight)
    }

    /// What it is before any sample.
    const fn start(self) -> f32 {
        match self {
            Sum::Depth => f32::INFINITY,
            _ => 0.0,
        }
    }

    /// The sums that a plane is developed from.
    const fn of(plane: Plane) -> &'static [Sum] {
        match plane {
            Plane::Colour => &[Sum::Colour, Sum::Weight],
            Plane::Coverage => &[Sum::Coverage, Sum::Weight],
            Plane::Depth => &[Sum::Depth],
            Plane::Normal => &[Sum::Normal],
            Plane::Albedo => &[Sum::Albedo, Sum::Hits],
            Plane::Occlusion => &[Sum::Occlusion, Sum::Hits],
            Plane::Shadow => &[Sum::Shadow, Sum::Hits],
            Plane::Steps => &[Sum::Steps],
            Plane::Residual => &[Sum::Residual, Sum::Depth],
            Plane::Object => &[Sum::Object, Sum::Depth],
        }
    }

    /// The sums that these planes are developed from, in the order in which they are kept.
    pub fn of_planes(planes: &[Plane]) -> Vec<Sum> {
        let needed = |sum: &Sum| planes.iter().any(|plane| Sum::of(*plane).contains(sum));
        Sum::ALL.into_iter().filter(needed).collect()
    }
}

/// Bytes of the sums that these planes are developed from.
pub fn bytes([width, height]: [u32; 2], planes: &[Plane]) -> u64 {
    let numbers: usize = Sum::of_planes(planes).iter().map(|s| s.channels()).sum();
    let pixels = u64::from(width) * u64::from(height);
    pixels.saturating_mul(4 * numbers as u64)
}

/// Sums of the samples of a picture, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Accumulator {
    size: [u32; 2],
    antialias: Antialias,
    planes: Vec<Plane>,
    samples: u32,
    /// By the number of the sum; empty for those that no plane needs.
    sums: Vec<Vec<f32>>,
}

impl Accumulator {
    /// Without any samples. The caller has checked the size against its limits.
    pub fn new(size: [u32; 2], antialias: Antialias, planes: &[Plane]) -> Accumulator {
        let kept = Sum::of_planes(planes);
        let pixels = size[0] as usize * size[1] as usize;
        let sums = Sum::ALL.map(|sum| match kept.contains(&sum) {
            true => vec![sum.start(); pixels * sum.channels()],
            false => Vec::new(),
        });
        Accumulator {
            size,
            antialias,
            planes: Plane::ALL
                .into_iter()
                .filter(|p| planes.contains(p))
                .collect(),
            samples: 0,
            sums: sums.into(),
        }
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.samples = 0;
        for (sum, numbers) in Sum::ALL.into_iter().zip(&mut self.sums) {
            numbers.fill(sum.start());
        }
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// How samples are spread over a pixel and weighted.
    pub fn antialias(&self) -> Antialias {
        self.antialias
    }

    /// The filter of the samples; none where there is one sample, in the middle of its pixel.
    pub fn filter(&self) -> Option<Filter> {
        self.antialias.filter()
    }

    /// How many samples a pixel of the finished picture has.
    pub fn wanted(&self) -> u32 {
        self.antialias.samples()
    }

    /// The planes that can be developed.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Samples that every pixel has.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The sums that are kept.
    pub fn kept(&self) -> impl Iterator<Item = Sum> {
        let is_kept = |sum: &Sum| !self.sums[*sum as usize].is_empty();
        Sum::ALL.into_iter().filter(is_kept)
    }

    /// The numbers of all sums that are kept, for a renderer to add to.
    pub fn sums_mut(&mut self) -> impl Iterator<Item = (Sum, &mut [f32])> {
        (Sum::ALL.into_iter().zip(&mut self.sums))
            .filter(|(_, numbers)| !numbers.is_empty())
            .map(|(sum, numbers)| (sum, numbers.as_mut_slice()))
    }

    /// The numbers of a sum, channels interleaved; empty if it is not kept.
    pub fn sum(&self, sum: Sum) -> &[f32] {
        &self.sums[sum as usize]
    }

    /// Adds the samples of sums of the same size, filter and planes.
    pub fn add(&mut self, other: &Accumulator) {
        let numbers: Vec<f32> = other.sums.iter().flatten().copied().collect();
        self.add_rows(0, self.size[1], &numbers);
        self.samples += other.samples;
    }

    /// All samples count so many times.
    pub fn weigh(&mut self, times: u32) {
        self.samples *= times;
        for (sum, numbers) in Sum::ALL.into_iter().zip(&mut self.sums) {
            if !matches!(sum, Sum::Depth | Sum::Residual | Sum::Object) {
                numbers.iter_mut().for_each(|x| *x *= times as f32);
            }
        }
    }

    /// Every pixel has as many more samples.
    pub fn count(&mut self, samples: u32) {
        self.samples += samples;
    }

    /// Adds sums of as many more samples, of `rows` rows from row `first` on: the numbers of all sums that are kept, one after
    /// the other.
    pub fn add_rows(&mut self, first: u32, rows: u32, mut numbers: &[f32]) {
        let (from, to) = (first as usize, (first + rows) as usize);
        let row = self.size[0] as usize;
        let sums = &mut self.sums;
        let is_kept: Vec<Sum> = Sum::ALL
            .into_iter()
            .filter(|sum| !sums[*sum as usize].is_empty())
            .collect();
        let mut given: [&[f32]; Sum::ALL.len()] = [&[]; Sum::ALL.len()];
        for sum in is_kept {
            let (own, rest) = numbers.split_at(row * sum.channels() * rows as usize);
            (given[sum as usize], numbers) = (own, rest);
        }
        // what belongs to the nearest hit is that of the nearer one
        let depths = given[Sum::Depth as usize];
        for nearest in [Sum::Residual, Sum::Object] {
            let before = std::mem::take(&mut sums[nearest as usize]);
            let mut after = before;
            if !after.is_empty() {
                let held = sums[Sum::Depth as usize][from * row..to * row].iter();
                let own = after[from * row..to * row].iter_mut();
                for ((x, new), (held, depth)) in
                    own.zip(given[nearest as usize]).zip(held.zip(depths))
                {
                    if depth < held {
                        *x = *new;
                    }
                }
            }
            sums[nearest as usize] = after;
        }
        for sum in Sum::ALL {
            let channels = sum.channels();
            let held = &mut sums[sum as usize];
            if held.is_empty() || matches!(sum, Sum::Residual | Sum::Object) {
                continue;
            }
            let own = held[from * row * channels..to * row * channels].iter_mut();
            let pairs = own.zip(given[sum as usize]);
            if sum == Sum::Depth {
                pairs.for_each(|(x, new)| *x = x.min(*new));
            } else {
                pairs.for_each(|(x, new)| *x += new);
            }
        }
    }

    /// The film of the samples that there are.
    pub fn film(&self) -> Film {
        self.clone().into_film()
    }

    /// As [`Accumulator::film`], in the memory of the sums.
    pub fn into_film(mut self) -> Film {
        let samples = self.samples.max(1) as f32;
        let mut take = |sum: Sum| std::mem::take(&mut self.sums[sum as usize]);
        let (hits, weight) = (take(Sum::Hits), take(Sum::Weight));
        // where nothing is hit, nothing is occluded or in shadow
        let mean = |mut sum: Vec<f32>| {
            for (x, n) in sum.iter_mut().zip(&hits) {
                *x = if *n > 0.0 { *x / n } else { 1.0 };
            }
            sum
        };
        let mut planes = Vec::with_capacity(self.planes.len());
        for plane in &self.planes {
            let numbers = match plane {
                Plane::Colour => {
                    let mut colour = take(Sum::Colour);
                    for (pixel, w) in colour.as_chunks_mut::<3>().0.iter_mut().zip(&weight) {
                        // the filter's negative lobes can make a dark pixel beside a bright one less than black
                        for c in pixel {
                            *c = (*c / w.max(1e-6)).max(0.0);
                        }
                    }
                    colour
                }
                Plane::Coverage => {
                    let mut coverage = take(Sum::Coverage);
                    for (x, w) in coverage.iter_mut().zip(&weight) {
                        *x = (*x / w.max(1e-6)).clamp(0.0, 1.0);
                    }
                    coverage
                }
                Plane::Depth => take(Sum::Depth),
                Plane::Normal => {
                    let mut normal = take(Sum::Normal);
                    for n in normal.as_chunks_mut::<3>().0 {
                        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
                        for x in n {
                            *x /= length.max(f32::MIN_POSITIVE);
                        }
                    }
                    normal
                }
                Plane::Albedo => {
                    let mut albedo = take(Sum::Albedo);
                    for (pixel, n) in albedo.as_chunks_mut::<3>().0.iter_mut().zip(&hits) {
                        for x in pixel {
                            *x /= n.max(1.0);
                        }
                    }
                    albedo
                }
                Plane::Occlusion => mean(take(Sum::Occlusion)),
                Plane::Shadow => mean(take(Sum::Shadow)),
                Plane::Steps => {
                    let mut steps = take(Sum::Steps);
                    steps.iter_mut().for_each(|x| *x /= samples);
                    steps
                }
                Plane::Residual => take(Sum::Residual),
                Plane::Object => take(Sum::Object),
            };
            planes.push((*plane, numbers));
        }
        Film::from_planes(self.size, planes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled() -> Accumulator {
        let mut sums = Accumulator::new([2, 3], Antialias::None, &Plane::ALL);
        let row = |colour: f32, depth: f32, object: f32, hits: f32| {
            let mut numbers = Vec::new();
            for sum in Sum::ALL {
                let x = match sum {
                    Sum::Colour => colour,
                    Sum::Weight => 1.0,
                    Sum::Depth => depth,
                    Sum::Hits | Sum::Coverage => hits,
                    Sum::Object => object,
                    _ => 0.5 * hits,
                };
                numbers.extend(vec![x; 2 * sum.channels()]);
            }
            numbers
        };
        sums.add_rows(1, 1, &row(3.0, 5.0, 1.0, 1.0));
        sums.add_rows(1, 1, &row(1.0, 4.0, 2.0, 1.0));
        sums.add_rows(1, 1, &row(2.0, f32::INFINITY, 0.0, 0.0));
        sums.count(3);
        sums
    }

    #[test]
    fn films_are_means_and_the_nearest() {
        let film = filled().into_film();
        assert_eq!(film.plane(Plane::Colour)[6..12], [2.0; 6]);
        let third = 2.0 / 3.0;
        assert_eq!(film.plane(Plane::Coverage)[2..4], [third; 2]);
        assert_eq!(film.plane(Plane::Depth)[2..4], [4.0; 2]);
        assert_eq!(film.plane(Plane::Object)[2..4], [2.0; 2]);
        assert_eq!(film.plane(Plane::Occlusion)[2..4], [0.5; 2]);
        // where no sample hits anything
        assert_eq!(film.plane(Plane::Occlusion)[..2], [1.0; 2]);
        assert_eq!(film.plane(Plane::Depth)[..2], [f32::INFINITY; 2]);
        assert_eq!(film.plane(Plane::Object)[..2], [0.0; 2]);
    }

    #[test]
    fn only_what_is_needed_is_kept() {
        let sums = Accumulator::new([4, 4], Antialias::None, &[Plane::Object]);
        assert_eq!(sums.kept().collect::<Vec<_>>(), [Sum::Depth, Sum::Object]);
        let film = sums.into_film();
        assert!(film.has(Plane::Object) && !film.has(Plane::Depth));
        assert_eq!(bytes([4, 4], &[Plane::Colour]), 16 * 4 * 4);
    }

    #[test]
    fn cleared_sums_are_new_ones() {
        let mut sums = filled();
        sums.clear();
        assert_eq!(sums, Accumulator::new([2, 3], Antialias::None, &Plane::ALL));
    }
}
