//! Pictures that converge in place: what was taken for them is kept until something else is seen.

use crate::engine::{Look, Request};
use std::sync::Arc;
use std::time::{Duration, Instant};
use zeroset_scene::film::Plane;
use zeroset_scene::progressive::{Progressive, filter};
use zeroset_scene::render::{Evaluations, Observer, Prepared, RenderError};

/// A new picture is shown so often: developing one takes time that rays could have.
pub(crate) const PAUSE: Duration = Duration::from_millis(400);

/// How near a picture is to what it converges to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// How wide 95 % intervals are, as a share of white; none before that is known.
    pub noise: Option<f64>,
    /// How wide they are to be.
    pub wanted: f64,
    /// Seconds that it takes until then, about.
    pub left: Option<f64>,
}

/// A look's picture.
pub(crate) struct Converging {
    pub(crate) look: Look,
    pub(crate) picture: Progressive,
    pub(crate) seconds: f64,
    pub(crate) evaluations: Evaluations,
}

impl Converging {
    fn new(look: &Look, size: [u32; 2]) -> Converging {
        let settings = &look.settings;
        let filter = filter(settings.antialias);
        let planes = &Plane::ALL;
        Converging {
            look: *look,
            picture: Progressive::new(size, filter, planes, settings.seed, settings.exposure),
            seconds: 0.0,
            evaluations: Evaluations::default(),
        }
    }

    pub(crate) fn is_done(&self, noise: f64) -> bool {
        self.picture.noise() <= noise
    }

    /// Takes another round. The renderer has its own seed again in the end, whatever happens.
    pub(crate) fn advance(
        &mut self,
        prepared: &mut dyn Prepared,
        request: &Request,
        noise: f64,
        observer: &dyn Observer,
    ) -> Result<(), RenderError> {
        let began = Instant::now();
        let taken = self
            .picture
            .advance(prepared, &request.camera, Some(noise), observer);
        prepared.reseed(self.look.settings.seed)?;
        self.seconds += began.elapsed().as_secs_f64();
        self.evaluations = self.evaluations.plus(&taken?.evaluations);
        Ok(())
    }

    pub(crate) fn convergence(&self, wanted: f64) -> Convergence {
        let times = self.picture.left(wanted);
        Convergence {
            noise: Some(self.picture.noise()).filter(|noise| noise.is_finite()),
            wanted,
            left: times.map(|times| times * self.seconds),
        }
    }
}

/// The pictures that converge.
#[derive(Default)]
pub(crate) struct Kept {
    seen: Option<Arc<Request>>,
    pub(crate) pictures: Vec<Converging>,
}

impl Kept {
    /// One for each look of a request, of which those that were begun go on.
    pub(crate) fn turn_to(&mut self, request: &Arc<Request>) {
        let mut before = std::mem::take(&mut self.pictures);
        if self.seen.as_ref().is_none_or(|seen| !seen.sees_as(request)) {
            before.clear();
        }
        for look in &request.looks {
            // how bright it is shown decides what counts as noise
            let is_it = |c: &Converging| {
                c.look.has_rays_of(look) && c.look.settings.exposure == look.settings.exposure
            };
            let found = before.iter().position(is_it);
            let picture = match found {
                Some(at) => before.swap_remove(at),
                None => Converging::new(look, request.size),
            };
            self.pictures.push(picture);
        }
        self.seen = Some(Arc::clone(request));
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        *self = Kept::default();
    }
}
