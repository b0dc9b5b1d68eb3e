//! The part of a ray in which the field changes its sign, of one ray: for the few whose places are not found at once.
//! `normal::refine` does the same to vectors of rays; the shaders' twin is `stage/bracket.wgsl`.

use zeroset_shade::march::{MIDDLE, root};

/// Such a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bracket {
    /// The place before the surface, and the value there.
    pub(crate) t: f32,
    pub(crate) above: f32,
    /// How much farther the place behind it is, and the value there.
    pub(crate) beyond: f32,
    pub(crate) below: f32,
    /// 1 where the last guess was before the surface, -1 where it was behind it, 0 where there was none.
    pub(crate) last: f32,
}

impl Bracket {
    /// None.
    pub(crate) const NONE: Bracket = Bracket {
        t: 0.0,
        above: 0.0,
        beyond: 0.0,
        below: 0.0,
        last: 0.0,
    };

    /// Where the line through the values at both ends is zero, from the first.
    fn root(&self) -> f32 {
        self.beyond * root(self.above, self.below)
    }

    /// Where the next sample is, from the first end: false position, or the middle.
    pub(crate) fn guess(&self, round: u32) -> f32 {
        if round.is_multiple_of(MIDDLE) {
            0.5 * self.beyond
        } else {
            self.root()
        }
    }

    /// Takes in a sample `value` that far from the first end; the value at the end that stays a second time is halved
    /// (Illinois; Dowell and Jarratt 1971). Whether a line from the end that moved to the sample leads to the surface within
    /// `wanted`, or nothing else is left.
    pub(crate) fn narrow(&mut self, by: f32, value: f32, wanted: f32) -> bool {
        let past = value < 0.0;
        let (length, fall) = if past {
            (self.beyond - by, value - self.below)
        } else {
            (by, self.above - value)
        };
        if past {
            self.above *= if self.last < 0.0 { 0.5 } else { 1.0 };
            (self.beyond, self.below, self.last) = (by, value, -1.0);
        } else {
            self.below *= if self.last > 0.0 { 0.5 } else { 1.0 };
            (self.t, self.beyond) = (self.t + by, self.beyond - by);
            (self.above, self.last) = (value, 1.0);
        }
        value.abs() * length < fall * wanted || self.beyond < wanted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_shade::march::REFINEMENTS;

    /// A function that falls through zero, the ends of the part, and the root.
    type Case = (fn(f32) -> f32, [f32; 2], f32);

    #[test]
    fn finds_the_root_of_what_is_far_from_straight() {
        let cases: [Case; 6] = [
            (|t| 0.3 - t, [0.0, 1.0], 0.3),
            (|t| (0.3 - t) * 1e-6, [0.0, 1.0], 0.3),
            // a triple root far from one end, as that of a heart
            (|t| (0.9 - t).powi(3), [0.0, 1.0], 0.9),
            (|t| (0.05 - t).powi(3) * 1e-3, [0.0, 1.0], 0.05),
            (|t| (0.2 - t).cbrt(), [0.0, 1.0], 0.2),
            (|t| if t < 0.77 { 1e-6 } else { -10.0 }, [0.0, 1.0], 0.77),
        ];
        for (number, (f, [from, to], root)) in cases.into_iter().enumerate() {
            let mut part = Bracket {
                t: from,
                above: f(from),
                beyond: to - from,
                below: f(to),
                last: 0.0,
            };
            for round in 1..=REFINEMENTS {
                let by = part.guess(round);
                if part.narrow(by, f(part.t + by), 1e-4) {
                    break;
                }
            }
            let found = part.t + part.root();
            assert!(
                (found - root).abs() < 5e-3,
                "case {number}: {found} instead of {root}"
            );
        }
    }
}
