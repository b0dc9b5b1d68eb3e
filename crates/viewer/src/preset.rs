//! Methods that go together: fast ones, good ones, and the reference.

use zeroset_scene::settings::{Antialias, Integrator, Occlusion, Settings, Shadow};

/// Methods that go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// One ray a pixel, hard shadows, no occlusion: to look for a view.
    Fast,
    /// The defaults of scenes.
    Good,
    /// Paths of light, many rays a pixel.
    Reference,
}

impl Preset {
    /// All, from fast to slow.
    pub const ALL: [Preset; 3] = [Preset::Fast, Preset::Good, Preset::Reference];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Preset::Fast => "Fast",
            Preset::Good => "Good",
            Preset::Reference => "Reference",
        }
    }

    /// What it is for.
    pub fn about(self) -> &'static str {
        match self {
            Preset::Fast => "One ray a pixel, hard shadows, no occlusion and no reflections.",
            Preset::Good => "The methods that scenes have which choose none.",
            Preset::Reference => {
                "Paths of light (Kajiya 1986), 256 rays a pixel; with Converge, until there is little noise."
            }
        }
    }

    /// Puts its methods into settings, and gives the shadow of all lights, if it has one. Size, seed, exposure and tone stay.
    pub fn apply(self, settings: &mut Settings) -> Option<Shadow> {
        let Settings {
            size,
            seed,
            exposure,
            tone,
            ..
        } = *settings;
        *settings = Settings {
            size,
            seed,
            exposure,
            tone,
            ..Settings::DEFAULT
        };
        match self {
            Preset::Fast => {
                settings.occlusion = Occlusion::None;
                settings.antialias = Antialias::None;
                settings.integrator = Integrator::Direct;
                Some(Shadow::Hard)
            }
            Preset::Good => None,
            Preset::Reference => {
                settings.integrator = Integrator::Path {
                    depth: 10,
                    clamp: None,
                };
                let filter = settings.antialias.filter().unwrap_or_default();
                settings.antialias = Antialias::Supersample {
                    samples: 256,
                    filter,
                };
                None
            }
        }
    }
}
