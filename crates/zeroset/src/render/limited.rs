//! `--time-limit`: the best picture that there is time for.
//!
//! Pictures are made from a small one of a ray a pixel to the one that was asked for, each within moments of the time that
//! the next one takes: the small ones together cost a few hundredths of it. The one that the time ends in gives its finished
//! tiles, the one before all other places. So every pixel is right for the rays that it has, and none is left black.

use crate::backend::{ChosenRenderer, Used};
use crate::failure::{Exit, Failure};
use crate::file::Progress;
use std::time::{Duration, Instant};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Frame, Observer, RenderError, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Settings};

/// The longer side of the first picture, pixels: one tile.
const FIRST: u32 = 32;
/// How much longer the sides of a picture are at least than those of the one before.
const GROWTH: u32 = 3;

/// What a picture lacks.
pub(crate) struct Lack {
    /// Seconds that it was given.
    limit: f64,
    /// Share of its pixels that have all their rays.
    pub(crate) finished: f64,
    /// What all other pixels have.
    rest: Rung,
    wanted: Rung,
}

impl Lack {
    /// For a person.
    pub(crate) fn words(&self) -> String {
        // what is not finished is never rounded away
        let (percent, [width, height]) = ((100.0 * self.finished).floor(), self.rest.size);
        let rest = if self.rest.size != self.wanted.size {
            format!("is from a picture of {width}x{height}")
        } else {
            format!(
                "has {} of {} rays a pixel",
                self.rest.samples(),
                self.wanted.samples()
            )
        };
        format!(
            "ended by the time limit of {} s: {percent:.0} % of it is finished, the rest {rest}",
            self.limit
        )
    }
}

/// One picture on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rung {
    size: [u32; 2],
    antialias: Antialias,
}

impl Rung {
    fn samples(&self) -> u32 {
        self.antialias.samples()
    }
}

/// From the smallest picture to the one that is wanted.
fn rungs(size: [u32; 2], antialias: Antialias) -> Vec<Rung> {
    let longer = size[0].max(size[1]);
    let mut side = longer;
    let mut sides = Vec::new();
    while side > FIRST {
        sides.push(side);
        side = (side / GROWTH).max(FIRST);
    }
    sides.push(side);
    let of = |side: u32| {
        let scaled = |n: u32| u64::from(n) * u64::from(side) / u64::from(longer.max(1));
        size.map(|n| scaled(n).max(1) as u32)
    };
    let mut rungs: Vec<Rung> = (sides.iter().rev())
        .map(|&side| Rung {
            size: of(side),
            antialias: Antialias::None,
        })
        .collect();
    if antialias != Antialias::None {
        rungs.push(Rung { size, antialias });
    }
    rungs
}

/// Ends a rendering when its time is over.
struct Deadline<'a> {
    progress: &'a Progress<'a>,
    at: Instant,
}

impl Observer for Deadline<'_> {
    fn advance(&self, done: u64, total: u64) {
        self.progress.advance(done, total);
    }

    fn is_cancelled(&self) -> bool {
        self.progress.is_cancelled() || Instant::now() >= self.at
    }
}

/// Renders as much as the time allows.
///
/// # Errors
/// The scene cannot be rendered, not even the first small picture is finished in time, `progress` says to stop.
pub(crate) fn render(
    engine: &ChosenRenderer,
    scene: &Scene,
    planes: &[Plane],
    limit: Duration,
    progress: &Progress<'_>,
    restart: &(dyn Fn() + Sync),
) -> Result<(Frame, Used, Option<Lack>), Failure> {
    let began = Instant::now();
    let deadline = Deadline {
        progress,
        at: began + limit,
    };
    let wanted = Rung {
        size: scene.settings().size,
        antialias: scene.settings().antialias,
    };
    let mut statistics = Statistics::default();
    let mut best: Option<(Film, Rung)> = None;
    let mut used = Used::Cpu;
    for rung in rungs(wanted.size, wanted.antialias) {
        let scene = scene.clone().with_settings(Settings {
            size: rung.size,
            antialias: rung.antialias,
            ..*scene.settings()
        })?;
        progress.bar.reset();
        let part = match engine.render_part(&scene, planes, &deadline, restart) {
            Ok(part) => part,
            // a renderer that keeps no part of a picture
            Err(RenderError::Cancelled) if !progress.is_cancelled() => None,
            Err(error) => return Err(error.into()),
        };
        if progress.is_cancelled() {
            return Err(Failure::silent(Exit::Interrupted));
        }
        let (film, finished) = match part {
            Some(part) => {
                statistics = sum(&statistics, &part.statistics);
                used = part.used;
                if part.finished.is_none() {
                    best = Some((part.film, rung));
                    continue;
                }
                (Some(part.film), part.finished.unwrap_or_default())
            }
            None => (None, Vec::new()),
        };
        let Some((base, rest)) = best else {
            let [width, height] = rung.size;
            let message = format!(
                "in {} s not even a picture of {width}x{height} with a ray a pixel could be rendered",
                limit.as_secs_f64()
            );
            let help = "raise --time-limit, or make the scene simpler";
            return Err(Failure::with_help(Exit::Unfinished, message, help));
        };
        let mut all = enlarged(base, rung.size);
        if let Some(film) = film {
            finished.iter().for_each(|tile| lay(&film, &mut all, *tile));
        }
        let pixels: u64 = finished
            .iter()
            .map(|[_, _, w, h]| u64::from(*w) * u64::from(*h))
            .sum();
        let whole = u64::from(rung.size[0]) * u64::from(rung.size[1]);
        // tiles of a picture on the way are not finished ones
        let finished = if rung == wanted {
            pixels as f64 / whole as f64
        } else {
            0.0
        };
        let film = enlarged(all, wanted.size);
        let lack = Lack {
            limit: limit.as_secs_f64(),
            finished,
            rest,
            wanted,
        };
        statistics.seconds = began.elapsed().as_secs_f64();
        return Ok((Frame { film, statistics }, used, Some(lack)));
    }
    statistics.seconds = began.elapsed().as_secs_f64();
    match best {
        Some((film, _)) => Ok((Frame { film, statistics }, used, None)),
        None => Err(RenderError::Cancelled.into()),
    }
}

pub(super) fn sum(a: &Statistics, b: &Statistics) -> Statistics {
    Statistics {
        rays: a.rays + b.rays,
        hits: a.hits + b.hits,
        evaluations: a.evaluations.plus(&b.evaluations),
        seconds: a.seconds + b.seconds,
        threads: b.threads,
    }
}

/// A film of another size with the nearest pixels of this one: what is coarse is to be seen as coarse.
fn enlarged(film: Film, [width, height]: [u32; 2]) -> Film {
    if [film.width(), film.height()] == [width, height] {
        return film;
    }
    let held = Plane::ALL.map(|plane| (plane, film.has(plane)));
    let held: Vec<Plane> = held
        .iter()
        .filter(|(_, has)| *has)
        .map(|(plane, _)| *plane)
        .collect();
    let mut out = Film::with(width, height, &held);
    let nearest = |at: u32, to: u32, from: u32| {
        ((2 * u64::from(at) + 1) * u64::from(from) / (2 * u64::from(to))) as usize
    };
    for plane in held {
        let (from, channels) = (film.plane(plane), plane.channels());
        let rows = out
            .plane_mut(plane)
            .chunks_exact_mut(width as usize * channels);
        for (y, row) in (0..).zip(rows) {
            let line = nearest(y, height, film.height()) * film.width() as usize;
            for (x, pixel) in (0..).zip(row.chunks_exact_mut(channels)) {
                let at = (line + nearest(x, width, film.width())) * channels;
                pixel.copy_from_slice(&from[at..at + channels]);
            }
        }
    }
    out
}

/// Copies a tile from one film to another of the same size.
fn lay(from: &Film, to: &mut Film, [x, y, width, height]: [u32; 4]) {
    let line = from.width() as usize;
    for plane in Plane::ALL.into_iter().filter(|plane| from.has(*plane)) {
        let channels = plane.channels();
        for row in y..y + height {
            let at = (row as usize * line + x as usize) * channels;
            let range = at..at + width as usize * channels;
            to.plane_mut(plane)[range.clone()].copy_from_slice(&from.plane(plane)[range]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_scene::settings::Filter;

    #[test]
    fn pictures_on_the_way_are_cheap() {
        let smooth = Antialias::Supersample {
            samples: 16,
            filter: Filter::Mitchell,
        };
        for size in [
            [1, 1],
            [32, 18],
            [33, 1],
            [640, 360],
            [512, 512],
            [8192, 8192],
            [1, 60_000],
        ] {
            for antialias in [Antialias::None, smooth] {
                let all = rungs(size, antialias);
                assert_eq!(all.last(), Some(&Rung { size, antialias }));
                assert!(
                    all[0].size.iter().all(|n| (1..=FIRST).contains(n)),
                    "{all:?}"
                );
                let cost =
                    |r: &Rung| f64::from(r.size[0]) * f64::from(r.size[1]) * f64::from(r.samples());
                let (last, before) = all.split_last().unwrap();
                if cost(last) > 1e5 {
                    let before: f64 = before.iter().map(cost).sum();
                    assert!(
                        before < 0.15 * cost(last),
                        "{size:?}: {before} of {}",
                        cost(last)
                    );
                }
            }
        }
    }

    #[test]
    fn an_enlarged_film_has_the_nearest_pixels() {
        let mut small = Film::new(2, 2);
        small
            .plane_mut(Plane::Depth)
            .copy_from_slice(&[1.0, 2.0, 3.0, 4.0]);
        let large = enlarged(small, [4, 5]);
        let row = |a, b| [a, a, b, b];
        let right = [
            row(1.0, 2.0),
            row(1.0, 2.0),
            row(3.0, 4.0),
            row(3.0, 4.0),
            row(3.0, 4.0),
        ];
        assert_eq!(large.plane(Plane::Depth), right.as_flattened());
        let mut out = Film::new(4, 5);
        lay(&large, &mut out, [1, 1, 2, 2]);
        let depth = out.plane(Plane::Depth);
        assert_eq!(
            (depth[5], depth[6], depth[9], depth[10]),
            (1.0, 2.0, 3.0, 4.0)
        );
        assert_eq!(depth.iter().sum::<f32>(), 10.0);
    }
}
