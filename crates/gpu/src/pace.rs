//! How much work a dispatch may be: measured, not guessed.
//!
//! A dispatch cannot be interrupted. One that takes seconds makes the desktop stand still, and the system may take the
//! device away. So a picture is dispatched in tiles, whose size follows from what earlier tiles took. What the rows of a
//! picture cost is remembered: the next sample of each pixel, and the next picture of a moving camera, cost much the same.

use std::ops::Range;
use zeroset_shader::entry::WORKGROUP;

/// What a dispatch should take at most, seconds.
pub(crate) const TARGET: f64 = 0.025;
/// What it may take.
pub(crate) const LIMIT: f64 = 0.050;
/// Parts of a picture's height whose costs are remembered.
const SLOTS: usize = 32;
/// Pixels of the first tile: a workgroup.
const FIRST: u64 = (WORKGROUP * WORKGROUP) as u64;
/// What a dispatch over unknown ground should take, seconds: at first and after a surprise, and when there was none. Should
/// it turn out fifty times as dear, nobody notices.
const FEELER: [f64; 2] = [0.001, 0.0018];
/// How fast it goes from the one to the other.
const COURAGE: f64 = 1.5;
/// How much larger a tile over unknown ground is than those before it.
const GROWTH: u64 = 4;
/// How much more than the nearest known rows unknown ones may cost.
const CAUTION: f64 = 2.0;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) corner: [u32; 2],
    pub(crate) size: [u32; 2],
}

impl Area {
    pub(crate) fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Workgroups across and down.
    pub(crate) fn groups(&self) -> [u32; 2] {
        self.size.map(|n| n.div_ceil(WORKGROUP))
    }

    fn rows(&self) -> Range<u32> {
        self.corner[1]..self.corner[1] + self.size[1]
    }
}

/// What the pixels of a picture cost in one stage: so much for a dispatch, and so much for each of its pixels.
#[derive(Clone, Debug)]
pub(crate) struct Costs {
    /// From the top of the picture to the bottom.
    slots: [Slot; SLOTS],
    /// Pixels of the largest tile that was measured.
    largest: u64,
    /// Seconds and pixels of the shortest dispatch.
    shortest: (f64, u64),
    /// Dispatches of twice its pixels that took no longer: then it is not pixels that took the time.
    steady: u32,
    /// Seconds a pixel of the last two tiles.
    recent: Option<[f64; 2]>,
    /// What a dispatch over unknown ground should take, seconds.
    feeler: f64,
}

impl Default for Costs {
    fn default() -> Costs {
        Costs {
            slots: Default::default(),
            largest: 0,
            shortest: (f64::MAX, 0),
            steady: 0,
            recent: None,
            feeler: FEELER[0],
        }
    }
}

/// Some rows of a picture.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    /// Seconds a pixel.
    rate: Option<f64>,
    /// Share of the rows that was measured; above 1 where it was more than once.
    covered: f64,
}

impl Costs {
    /// The dearest known pixel, seconds.
    pub(crate) fn dearest(&self) -> Option<f64> {
        (self.slots.iter()).filter_map(|s| s.rate).reduce(f64::max)
    }

    fn slots(rows: Range<u32>, height: u32) -> Range<usize> {
        // every slot has a row
        let (slots, height) = (SLOTS.min(height.max(1) as usize), height.max(1) as usize);
        let slot = |row: u32| (row as usize * slots / height).min(slots - 1);
        slot(rows.start)..slot(rows.end.saturating_sub(1).max(rows.start)) + 1
    }

    /// Seconds a pixel of a slot, and whether that was measured there.
    fn rate(&self, slot: usize) -> Option<(f64, bool)> {
        let known = |k: usize| {
            let Slot { rate, covered } = self.slots.get(k)?;
            rate.filter(|_| *covered > 0.5)
        };
        if let Some(rate) = known(slot) {
            return Some((rate, true));
        }
        let [last, before] = self.recent?;
        let near = |distance: usize| {
            let above = slot.checked_sub(distance).and_then(known);
            above
                .into_iter()
                .chain(known(slot + distance))
                .reduce(f64::max)
        };
        let near = (1..SLOTS).find_map(near).unwrap_or(0.0);
        Some((CAUTION * last.max(before).max(near), false))
    }

    /// What every dispatch takes, seconds.
    fn fixed(&self) -> f64 {
        match (self.recent, self.steady) {
            (None, _) => 0.0,
            (_, ..3) => 0.5 * self.shortest.0,
            _ => 0.9 * self.shortest.0,
        }
    }

    /// What the pixels of an area should cost, seconds, and whether all of it was measured before; `None` where nothing was.
    fn predict(&self, area: &Area, height: u32) -> Option<(f64, bool)> {
        let mut dearest = (0.0, true);
        for slot in Costs::slots(area.rows(), height) {
            let (rate, measured) = self.rate(slot)?;
            dearest = (f64::max(dearest.0, rate), dearest.1 && measured);
        }
        Some((dearest.0 * area.pixels() as f64, dearest.1))
    }

    /// Takes in what an area took, which was predicted to take so long.
    pub(crate) fn learn(
        &mut self,
        area: &Area,
        [width, height]: [u32; 2],
        seconds: f64,
        predicted: Option<f64>,
    ) {
        if area.pixels() == 0 {
            return;
        }
        if let Some(predicted) = predicted
            && seconds > LIMIT
            && seconds > CAUTION * predicted
        {
            // the picture became dearer; the rest of it probably did too
            let dearer = (seconds / predicted.max(1e-9)).min(8.0);
            let rates = self.slots.iter_mut().filter_map(|s| s.rate.as_mut());
            rates.for_each(|rate| *rate *= dearer);
        }
        self.feeler = match predicted {
            Some(predicted) if seconds <= predicted => (self.feeler * COURAGE).min(FEELER[1]),
            _ => FEELER[0],
        };
        let (shortest, pixels) = self.shortest;
        if seconds < 0.8 * shortest {
            (self.shortest, self.steady) = ((seconds, area.pixels()), 0);
        } else if seconds < 1.15 * shortest && area.pixels() >= 2 * pixels {
            self.steady += 1;
        }
        let before = self.recent.map_or(0.0, |r| r[0]);
        self.recent = Some([0.0, before]);
        let rate = (seconds - self.fixed()).max(1e-9) / area.pixels() as f64;
        self.recent = Some([rate, before]);
        let slots = Costs::slots(area.rows(), height);
        let whole = f64::from(width) * f64::from(height) / f64::from(height.min(SLOTS as u32));
        let share = area.pixels() as f64 / (whole * slots.len() as f64).max(1.0);
        for slot in &mut self.slots[slots] {
            // a small part of some rows says little about the rest of them, unless it is dear
            let before = slot.rate.unwrap_or(0.0) * (1.0 - share).max(0.0);
            slot.rate = Some(rate.max(before));
            slot.covered += share;
        }
        self.largest = self.largest.max(area.pixels());
    }
}

/// A part of the work, small enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tile {
    pub(crate) area: Area,
    /// What it should take, seconds, if that can be said.
    pub(crate) predicted: Option<f64>,
    /// Whether that is only a guess: then its true cost must be known before the next tile is chosen.
    pub(crate) is_guess: bool,
}

/// Cuts an area into tiles, one at a time, each as large as what is known by then allows. It begins in the middle, where
/// pictures are dearest, and goes to the bottom, then from the middle to the top: on unknown ground tiles grow, and where
/// they began on a cheap sky they would be too large by the time that they reach something.
#[derive(Clone, Debug)]
pub(crate) struct Cutter {
    area: Area,
    /// The picture's height.
    height: u32,
    /// Rows of workgroups left below the middle, from top to bottom.
    below: Range<u32>,
    /// Rows of workgroups left above it, from bottom to top.
    above: Range<u32>,
    /// Workgroups of the current row that are done.
    done: u32,
    /// Pixels of a tile at most, whatever they cost.
    most: u64,
}

impl Cutter {
    pub(crate) fn new(area: Area, height: u32) -> Cutter {
        let rows = area.groups()[1];
        Cutter {
            area,
            height,
            below: rows / 2..rows,
            above: 0..rows / 2,
            done: 0,
            most: u64::MAX,
        }
    }

    /// With at most so many pixels a tile, but a workgroup at least.
    pub(crate) fn at_most(self, pixels: u64) -> Cutter {
        Cutter {
            most: pixels.max(FIRST),
            ..self
        }
    }

    /// The next tile; `None` when the area is done.
    pub(crate) fn next(&mut self, costs: &Costs) -> Option<Tile> {
        if self.area.size[0] == 0 || (self.below.is_empty() && self.above.is_empty()) {
            return None;
        }
        let [across, down] = self.area.groups();
        if self.below.len() + self.above.len() == down as usize
            && self.done == 0
            && self.allows(&self.area, costs)
        {
            (self.below, self.above) = (0..0, 0..0);
            return Some(self.tile(self.area, costs));
        }
        if self.done == 0 {
            let rows = if self.below.is_empty() {
                &self.above
            } else {
                &self.below
            };
            let left = rows.end - rows.start;
            if let Some(rows) = largest(left, |n| self.allows(&self.rows(n), costs)) {
                let area = self.rows(rows);
                self.advance(rows);
                return Some(self.tile(area, costs));
            }
        }
        let left = across - self.done;
        let groups = largest(left, |n| self.allows(&self.part(n), costs)).unwrap_or(1);
        let area = self.part(groups);
        self.done += groups;
        if self.done == across {
            self.done = 0;
            self.advance(1);
        }
        Some(self.tile(area, costs))
    }

    fn tile(&self, area: Area, costs: &Costs) -> Tile {
        let predicted = costs.predict(&area, self.height);
        Tile {
            area,
            predicted: predicted.map(|(seconds, _)| costs.fixed() + seconds),
            is_guess: predicted.is_none_or(|(_, measured)| !measured),
        }
    }

    fn allows(&self, area: &Area, costs: &Costs) -> bool {
        let [across, down] = area.groups();
        if across > 65_535 || down > 65_535 {
            return false;
        }
        let pixels = area.pixels();
        if pixels > self.most {
            return false;
        }
        match costs.predict(area, self.height) {
            None => pixels <= FIRST,
            Some((seconds, true)) => costs.fixed() + seconds <= TARGET,
            Some((seconds, false)) => {
                // twice the pixels of a tile that took no longer than the shortest one
                let twice = 2.0 * CAUTION * costs.fixed();
                seconds <= costs.feeler.max(twice) && pixels <= GROWTH * costs.largest
            }
        }
    }

    /// The next rows of workgroups.
    fn rows(&self, count: u32) -> Area {
        let first = if self.below.is_empty() {
            self.above.end - count
        } else {
            self.below.start
        };
        self.clip([0, first], [self.area.groups()[0], count])
    }

    /// The next workgroups of the current row.
    fn part(&self, count: u32) -> Area {
        let row = if self.below.is_empty() {
            self.above.end - 1
        } else {
            self.below.start
        };
        self.clip([self.done, row], [count, 1])
    }

    /// Workgroups as pixels.
    fn clip(&self, first: [u32; 2], count: [u32; 2]) -> Area {
        let start = first.map(|n| n * WORKGROUP);
        let size = |k: usize| (count[k] * WORKGROUP).min(self.area.size[k] - start[k]);
        let corner = |k: usize| self.area.corner[k] + start[k];
        Area {
            corner: [corner(0), corner(1)],
            size: [size(0), size(1)],
        }
    }

    fn advance(&mut self, rows: u32) {
        if self.below.is_empty() {
            self.above.end -= rows;
        } else {
            self.below.start += rows;
        }
    }
}

/// The largest number from 1 to `most` that is allowed, if larger ones are allowed less.
fn largest(most: u32, allowed: impl Fn(u32) -> bool) -> Option<u32> {
    let (mut good, mut bad) = (0, most + 1);
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if allowed(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    (good > 0).then_some(good)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Dispatches a whole area on a device where pixels cost what `cost` says, and returns how long each tile took.
    fn run(
        costs: &mut Costs,
        size: [u32; 2],
        fixed: f64,
        cost: impl Fn(u32, u32) -> f64,
    ) -> Vec<(Tile, f64)> {
        let area = Area {
            corner: [0, 0],
            size,
        };
        let mut cutter = Cutter::new(area, size[1]);
        let mut seen = vec![false; (size[0] * size[1]) as usize];
        let mut tiles = Vec::new();
        while let Some(tile) = cutter.next(costs) {
            let ([x0, y0], [w, h]) = (tile.area.corner, tile.area.size);
            let mut seconds = fixed;
            for y in y0..y0 + h {
                for x in x0..x0 + w {
                    let seen = &mut seen[(y * size[0] + x) as usize];
                    assert!(!*seen, "{x}, {y} twice");
                    *seen = true;
                    seconds += cost(x, y);
                }
            }
            costs.learn(&tile.area, size, seconds, tile.predicted);
            tiles.push((tile, seconds));
        }
        assert!(seen.iter().all(|s| *s));
        tiles
    }

    fn longest(tiles: &[(Tile, f64)]) -> f64 {
        tiles.iter().map(|t| t.1).fold(0.0, f64::max)
    }

    #[test]
    fn tiles_stay_short_whatever_the_picture_costs() {
        for size in [[1, 1], [9, 17], [640, 360], [512, 512], [1999, 30]] {
            for (price, fixed) in [
                (1e-9, 1e-5),
                (1e-7, 1e-5),
                (1e-6, 1e-5),
                (1e-6, 2e-3),
                (1e-7, 8e-3),
                (1e-4, 1e-5),
            ] {
                // a sky that costs a fiftieth of the thing in its middle
                let cost = |x: u32, y: u32| {
                    let dx = x as f64 / size[0] as f64 - 0.5;
                    let dy = y as f64 / size[1] as f64 - 0.5;
                    price * if dx * dx + dy * dy < 0.1 { 1.0 } else { 0.02 }
                };
                let mut costs = Costs::default();
                // a workgroup at least
                let most = 1.2 * LIMIT.max(64.0 * price) + fixed;
                for pass in 0..3 {
                    let tiles = run(&mut costs, size, fixed, cost);
                    let longest = longest(&tiles);
                    assert!(longest <= most, "{size:?}, {price}, {pass}: {longest}");
                    let work: f64 = tiles.iter().map(|t| t.1 - fixed).sum();
                    let count = tiles.len() as f64;
                    assert!(count <= 60.0 + 4.0 * work / FEELER[0], "{count}, {work}");
                    if pass == 2 && fixed < 1e-4 && price * f64::from(size[0] * size[1]) < 0.01 {
                        assert!(tiles.len() == 1, "{size:?}, {price}: {}", tiles.len());
                    }
                }
            }
        }
    }

    #[test]
    fn a_picture_that_becomes_dearer_costs_a_few_long_tiles_at_most() {
        let mut costs = Costs::default();
        run(&mut costs, [512, 512], 1e-5, |_, _| 1e-8);
        let tiles = run(&mut costs, [512, 512], 1e-5, |_, _| 5e-6);
        let long = tiles.iter().filter(|(_, seconds)| *seconds > LIMIT);
        assert!(long.count() <= 3);
        let tiles = run(&mut costs, [512, 512], 1e-5, |_, _| 5e-6);
        assert!(longest(&tiles) <= LIMIT);
    }

    #[test]
    fn nothing_is_cut_into_nothing() {
        for size in [[0, 0], [0, 5], [5, 0]] {
            let area = Area {
                corner: [3, 4],
                size,
            };
            assert_eq!(Cutter::new(area, 10).next(&Costs::default()), None);
        }
    }

    #[test]
    fn the_largest_allowed_number_is_found() {
        for most in 1..40 {
            for limit in 0..45 {
                let found = largest(most, |n| n <= limit);
                assert_eq!(found.unwrap_or(0), limit.min(most));
            }
        }
    }
}
