//! A few colours for many: the colours that stand for all of an animation, and how they are mixed.
//!
//! Boxes of colours are cut in two, always the one whose colours differ most, at their mean (Wan, Wong and Prusinkiewicz 1988; Wu 1991), and the
//! means of the boxes are then moved to the middle of what is nearest to them (Lloyd 1982). Colours between two of them are mixed by a fixed
//! pattern (Bayer 1973): what stands still does so in every frame.

/// Bits of a channel that colours are told apart by.
const BITS: u32 = 6;
const BINS: usize = 1 << (3 * BITS);
/// How much a difference in red, green and blue is seen, about.
const SEEN: [f32; 3] = [0.6, 1.0, 0.45];
/// Times that colours are moved.
const ROUNDS: usize = 4;

type Colour = [f32; 3];

/// How often colours occur.
pub(super) struct Histogram {
    /// The number of pixels of each kind, and the sums of their channels.
    bins: Vec<[u64; 4]>,
}

fn bin(pixel: [u8; 3]) -> usize {
    let cut = 8 - BITS;
    pixel
        .iter()
        .fold(0, |n, x| n << BITS | usize::from(x >> cut))
}

impl Histogram {
    pub(super) fn new() -> Histogram {
        Histogram {
            bins: vec![[0; 4]; BINS],
        }
    }

    pub(super) fn add(&mut self, frame: &[u8]) {
        for pixel in frame.as_chunks::<3>().0 {
            let sums = &mut self.bins[bin(*pixel)];
            sums[0] += 1;
            for k in 0..3 {
                sums[k + 1] += u64::from(pixel[k]);
            }
        }
    }

    /// At most `most` colours for all of them.
    pub(super) fn colours(&self, most: usize) -> Vec<[u8; 3]> {
        let points: Vec<(f32, Colour)> = (self.bins.iter())
            .filter(|b| b[0] > 0)
            .map(|b| {
                let mean = [1, 2, 3].map(|k| b[k] as f32 / b[0] as f32);
                // what is rare is seen too: a highlight has few pixels
                (
                    (b[0] as f32).powf(0.75),
                    std::array::from_fn(|k| SEEN[k] * mean[k]),
                )
            })
            .collect();
        let mut boxes = vec![Part::new(points.clone())];
        while boxes.len() < most {
            let worst = (0..boxes.len()).max_by(|a, b| boxes[*a].error.total_cmp(&boxes[*b].error));
            let Some(at) = worst.filter(|at| boxes[*at].error > 0.0) else {
                break;
            };
            let (low, high) = boxes.swap_remove(at).cut();
            boxes.extend([low, high]);
        }
        let mut colours: Vec<Colour> = boxes.iter().map(|b| b.mean).collect();
        for _ in 0..ROUNDS {
            let mut sums = vec![(0.0, [0.0; 3]); colours.len()];
            for (weight, point) in &points {
                let (sum, at) = &mut sums[nearest(&colours, *point)];
                *sum += weight;
                (0..3).for_each(|k| at[k] += weight * point[k]);
            }
            for (colour, (weight, sum)) in colours.iter_mut().zip(sums) {
                if weight > 0.0 {
                    *colour = sum.map(|x| x / weight);
                }
            }
        }
        let whole = |c: Colour| std::array::from_fn(|k| (c[k] / SEEN[k]).round() as u8);
        let mut colours: Vec<[u8; 3]> = colours.into_iter().map(whole).collect();
        colours.sort_unstable();
        colours.dedup();
        colours
    }
}

/// Colours that one stands for.
struct Part {
    points: Vec<(f32, Colour)>,
    mean: Colour,
    /// Sum of squared distances to the mean.
    error: f32,
    /// The axis along which they differ most.
    axis: usize,
}

impl Part {
    fn new(points: Vec<(f32, Colour)>) -> Part {
        let weight: f32 = points.iter().map(|p| p.0).sum();
        let mean: Colour = std::array::from_fn(|k| {
            points.iter().map(|(w, p)| w * p[k]).sum::<f32>() / weight.max(f32::MIN_POSITIVE)
        });
        let spread: Colour = std::array::from_fn(|k| {
            points
                .iter()
                .map(|(w, p)| w * (p[k] - mean[k]).powi(2))
                .sum()
        });
        let axis = (0..3)
            .max_by(|a, b| spread[*a].total_cmp(&spread[*b]))
            .unwrap_or(1);
        Part {
            error: if points.len() > 1 {
                spread.iter().sum()
            } else {
                0.0
            },
            points,
            mean,
            axis,
        }
    }

    fn cut(self) -> (Part, Part) {
        let (axis, at) = (self.axis, self.mean[self.axis]);
        let (low, high) = self.points.into_iter().partition(|(_, p)| p[axis] < at);
        (Part::new(low), Part::new(high))
    }
}

fn nearest(colours: &[Colour], to: Colour) -> usize {
    let far = |c: &Colour| (0..3).map(|k| (c[k] - to[k]).powi(2)).sum::<f32>();
    (0..colours.len())
        .min_by(|a, b| far(&colours[*a]).total_cmp(&far(&colours[*b])))
        .unwrap_or_default()
}

/// Finds colours for pixels.
pub(super) struct Mixer {
    colours: Vec<Colour>,
    /// The nearest colour of each bin that was asked for.
    known: Vec<u8>,
}

/// A bin that was not asked for; no colour has this number.
const UNKNOWN: u8 = u8::MAX;

impl Mixer {
    /// Of at most 255 colours.
    pub(super) fn new(colours: &[[u8; 3]]) -> Mixer {
        let seen = |c: &[u8; 3]| std::array::from_fn(|k| SEEN[k] * f32::from(c[k]));
        Mixer {
            colours: colours.iter().map(seen).collect(),
            known: vec![UNKNOWN; BINS],
        }
    }

    fn nearest(&mut self, pixel: [u8; 3]) -> usize {
        let number = bin(pixel);
        if self.known[number] == UNKNOWN {
            // the middle of the bin
            let cut = 8 - BITS;
            let middle: Colour = std::array::from_fn(|k| {
                SEEN[k] * (f32::from(pixel[k] >> cut << cut) + 0.5 * ((1 << cut) - 1) as f32)
            });
            self.known[number] = nearest(&self.colours, middle) as u8;
        }
        self.known[number].into()
    }

    /// The colour of a pixel in this column and row.
    pub(super) fn colour(&mut self, pixel: [u8; 3], x: usize, y: usize) -> u8 {
        let first = self.nearest(pixel);
        let near = self.colours[first];
        // what lies on the other side of the pixel
        for far in [1.0, 2.0, 4.0, 8.0, 16.0] {
            let beyond = std::array::from_fn(|k| {
                let c = f32::from(pixel[k]);
                (c + far * (c - near[k] / SEEN[k])).clamp(0.0, 255.0) as u8
            });
            let second = self.nearest(beyond);
            if second == first {
                continue;
            }
            let other = self.colours[second];
            let (mut along, mut whole) = (0.0, 0.0);
            for k in 0..3 {
                let way = other[k] - near[k];
                along += (SEEN[k] * f32::from(pixel[k]) - near[k]) * way;
                whole += way * way;
            }
            let share = along / whole.max(f32::MIN_POSITIVE);
            return if share > threshold(x, y) {
                second
            } else {
                first
            } as u8;
        }
        first as u8
    }
}

/// The pattern of 8 x 8, each number between 0 and 1 once (Bayer 1973).
fn threshold(x: usize, y: usize) -> f32 {
    let mut n = 0;
    for bit in 0..3 {
        let (a, b) = (x >> bit & 1, y >> bit & 1);
        n = n << 2 | (a ^ b) << 1 | b;
    }
    (n as f32 + 0.5) / 64.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let frame = [255, 0, 0, 0, 255, 0, 12, 34, 56, 12, 34, 56];
        let mut histogram = Histogram::new();
        histogram.add(&frame);
        let colours = histogram.colours(255);
        assert_eq!(colours, [[0, 255, 0], [12, 34, 56], [255, 0, 0]]);
        let mut mixer = Mixer::new(&colours);
        for pixel in frame.as_chunks::<3>().0 {
            for (x, y) in [(0, 0), (3, 5), (7, 7)] {
                assert_eq!(colours[usize::from(mixer.colour(*pixel, x, y))], *pixel);
            }
        }
    }

    #[test]
    fn the_pattern_has_every_number_once() {
        let mut all: Vec<u32> = (0..64)
            .map(|i| (64.0 * threshold(i % 8, i / 8)) as u32)
            .collect();
        all.sort_unstable();
        assert_eq!(all, (0..64).collect::<Vec<u32>>());
    }

    /// A ramp in many more colours than there are keeps its mean everywhere.
    #[test]
    fn mixtures_have_the_mean_of_what_they_stand_for() {
        let mut histogram = Histogram::new();
        let ramp: Vec<u8> = (0..=255).flat_map(|i| [i, 255 - i, 128]).collect();
        histogram.add(&ramp);
        let colours = histogram.colours(12);
        assert_eq!(colours.len(), 12);
        let mut mixer = Mixer::new(&colours);
        for pixel in ramp.as_chunks::<3>().0 {
            let mut sum = [0.0; 3];
            for i in 0..64 {
                let c = colours[usize::from(mixer.colour(*pixel, i % 8, i / 8))];
                (0..3).for_each(|k| sum[k] += f32::from(c[k]) / 64.0);
            }
            // the ends of the ramp lie beyond the last colours
            let end = pixel[0] < 16 || pixel[0] > 239;
            for k in 0..3 {
                let off = (sum[k] - f32::from(pixel[k])).abs();
                assert!(off < if end { 16.0 } else { 4.0 }, "{pixel:?}: {sum:?}");
            }
        }
    }
}
