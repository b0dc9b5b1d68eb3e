//! Views: every plane of a film as a picture that a person can read numbers from.
//!
//! Steps are what Munini 2021, fig. 12 and Keinert 2014, fig. 9 show, the residual is Keinert's fig. 7, the occlusion alone
//! is Tomczak 2012, fig. 3.11. The colour maps grow evenly in lightness (viridis, magma and plasma), so that equal steps
//! look equal, in grey too.

mod legend;
mod scale;
pub mod section;
mod text;

use crate::picture::Picture;
use colorous::Gradient;
pub(crate) use legend::Legend;
pub use legend::LegendKey;
pub(crate) use scale::Scale;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::settings::ViewTransform;

/// Where nothing is hit: a slate that no colour map holds.
pub const NOTHING: [f32; 3] = [0.16, 0.18, 0.22];

/// How a plane is shown.
#[derive(Clone, Copy, Debug)]
pub struct PlaneView<'a> {
    /// Which one.
    pub plane: Plane,
    /// For [`Plane::Colour`]: how light becomes a picture.
    pub transform: ViewTransform,
    /// Whether a strip at the right side explains the colours. It makes the picture wider, and is left out where there
    /// are no numbers to explain or the picture is less than 64 pixels high.
    pub legend: bool,
    /// For [`Plane::Object`]: names, by object number.
    pub objects: &'a [String],
}

/// The planes that a film must have for the view of one of them.
pub fn needed(plane: Plane) -> &'static [Plane] {
    const ALL: &[Plane] = &Plane::ALL;
    match plane {
        // a residual is one of a hit
        Plane::Residual => &[Plane::Residual, Plane::Depth],
        other => &ALL[other as usize..][..1],
    }
}

impl PlaneView<'_> {
    /// Shows a film's plane; of a film that does not have it, [`NOTHING`].
    pub fn of(&self, film: &Film) -> Picture {
        let plane = film.plane(self.plane);
        if plane.is_empty() {
            return Picture::filled(film.width(), film.height(), NOTHING);
        }
        let depth = film.plane(Plane::Depth);
        let is_hit = |i: usize| depth.get(i).is_none_or(|d| d.is_finite());
        let (triples, _) = plane.as_chunks::<3>();
        match self.plane {
            Plane::Colour => Picture::develop(film, self.transform),
            Plane::Albedo => at_pixels(film, |i| triples[i].map(crate::tone::encode)),
            Plane::Normal => at_pixels(film, |i| match triples[i] {
                [0.0, 0.0, 0.0] => NOTHING,
                normal => normal.map(|n| (0.5 * n + 0.5).clamp(0.0, 1.0)),
            }),
            // shares, not light: equal differences look equal
            Plane::Coverage | Plane::Occlusion | Plane::Shadow => {
                at_pixels(film, |i| [plane[i].clamp(0.0, 1.0); 3])
            }
            Plane::Depth => self.mapped(film, |i| plane[i].is_finite()),
            Plane::Steps => self.mapped(film, |_| true),
            Plane::Residual => self.mapped(film, is_hit),
            Plane::Object => {
                let picture = at_pixels(film, |i| object_colour(plane[i]));
                if self.legend {
                    legend::names(picture, self.objects, plane)
                } else {
                    picture
                }
            }
        }
    }

    /// What the colours of this view mean, with at most about `most` ticks; `None` where they are no numbers.
    pub fn key(&self, film: &Film, most: usize) -> Option<LegendKey> {
        self.legend_of(film).map(|legend| legend.key(most))
    }

    fn legend_of(&self, film: &Film) -> Option<Legend> {
        let plane = film.plane(self.plane);
        match self.plane {
            Plane::Depth => {
                let scale = Scale::between(plane.iter().copied());
                Some(Legend::new("depth", scale, near_is_bright, Some("none")))
            }
            Plane::Steps => {
                let scale = Scale::from_zero(plane.iter().copied());
                let colours = |t| map(colorous::VIRIDIS, t);
                Some(Legend::new("steps", scale, colours, None))
            }
            Plane::Residual => {
                let depth = film.plane(Plane::Depth);
                let is_hit = |i: &usize| depth.get(*i).is_none_or(|d| d.is_finite());
                let scale = Scale::decades((0..plane.len()).filter(is_hit).map(|i| plane[i]));
                let colours = |t| map(colorous::MAGMA, t);
                Some(Legend::new("|f|", scale, colours, Some("none")))
            }
            _ => None,
        }
    }

    /// The plane through its legend's colours, with the legend beside it.
    fn mapped(&self, film: &Film, shown: impl Fn(usize) -> bool) -> Picture {
        let plane = film.plane(self.plane);
        let Some(legend) = self.legend_of(film) else {
            return Picture::filled(film.width(), film.height(), NOTHING);
        };
        let picture = at_pixels(film, |i| {
            if shown(i) {
                legend.colour(plane[i])
            } else {
                NOTHING
            }
        });
        if self.legend {
            legend.beside(picture)
        } else {
            picture
        }
    }
}

fn at_pixels(film: &Film, colour: impl Fn(usize) -> [f32; 3]) -> Picture {
    let width = film.width() as usize;
    Picture::from_fn(film.width(), film.height(), |x, y| {
        colour(y as usize * width + x as usize)
    })
}

/// A colour map at `t` from 0 to 1.
pub(crate) fn map(gradient: Gradient, t: f32) -> [f32; 3] {
    gradient
        .eval_continuous(f64::from(t))
        .into_array()
        .map(|c| f32::from(c) / 255.0)
}

fn near_is_bright(t: f32) -> [f32; 3] {
    map(colorous::PLASMA, 1.0 - t)
}

/// A colour for an object's number plus 1; 0 is nothing. Hues a golden angle apart never meet, and three lightnesses tell
/// neighbours in hue apart.
fn object_colour(number: f32) -> [f32; 3] {
    let number = number.round();
    if number < 1.0 {
        return NOTHING;
    }
    let hue = 0.08 + (number - 1.0) * 0.618_034;
    let value = [0.95, 0.75, 0.55][number as usize % 3];
    let saturation = [0.60, 0.75, 0.65][(number / 3.0) as usize % 3];
    [0.0, 2.0 / 3.0, 1.0 / 3.0].map(|phase| {
        let ramp = ((hue + phase).fract() * 6.0 - 3.0).abs() - 1.0;
        value * (1.0 - saturation * (1.0 - ramp.clamp(0.0, 1.0)))
    })
}
