//! Materials: what a surface looks like.

use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A colour that may change over space. All colours are linear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Pattern {
    /// One colour.
    Solid {
        /// The colour.
        colour: Vec3,
    },
    /// Cubes of two colours, averaged over a pixel. The cube from the origin to (size, size, size) has the second colour; a
    /// face between two layers of cubes shows the one under it, so that a floor at y = 0 has the first colour where x and z
    /// are positive.
    Checker {
        /// The two.
        colours: [Vec3; 2],
        /// Side of a cube, scene units.
        size: f32,
    },
    /// Bands of two colours across a direction, averaged over a pixel. The band that begins at the origin has the second
    /// colour.
    Stripes {
        /// The two.
        colours: [Vec3; 2],
        /// Across which way; normalised.
        direction: Vec3,
        /// Width of a band, scene units.
        size: f32,
    },
    /// Fractal noise between two colours. An octave of features of size `s` counts `1 - 2 w / s`, where `w` is how far a
    /// pixel reaches over the surface: from half a feature on it is its mean.
    Noise {
        /// The two.
        colours: [Vec3; 2],
        /// Size of the largest feature, scene units.
        size: f32,
        /// Number of octaves, 1 to 8.
        octaves: u32,
    },
    /// From one colour to another between two points.
    Gradient {
        /// The two.
        colours: [Vec3; 2],
        /// Where the first one is.
        from: Vec3,
        /// Where the second one is.
        to: Vec3,
    },
    /// An image projected along the three axes, blended by powers of the normal's parts. Seen straight on, no face shows it
    /// mirrored: it is upright on walls, a floor shows it as a plan (up is -z), a ceiling with +z up. Copies meet at the
    /// origin. What is see-through in the file counts as its colour.
    Triplanar {
        /// The image.
        image: Arc<Image>,
        /// Side of a copy of the image, scene units.
        size: f32,
        /// How sharply the three projections are told apart; 1 is soft, 8 sharp.
        sharpness: f32,
    },
    /// Colours by the orbit of a fractal at the hit: blended by how near the orbit came to its traps.
    Orbit {
        /// Colours of the origin, the x = 0, y = 0 and z = 0 planes.
        colours: [Vec3; 4],
    },
}

/// An image in memory, linear colours, row by row from the top left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Image {
    /// The file it came from, relative to the scene's folder.
    pub path: String,
    /// Width in pixels.
    #[serde(skip)]
    pub width: u32,
    /// Height in pixels.
    #[serde(skip)]
    pub height: u32,
    /// Linear colours.
    #[serde(skip)]
    pub pixels: Vec<Vec3>,
}

/// What a surface looks like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Colour.
    pub pattern: Pattern,
    /// Strength of the highlight. Where shading is physical, 0.25 is what usual glass, stone or plastic reflects.
    pub specular: f32,
    /// Exponent of the highlight of the Phong model.
    pub shininess: f32,
    /// 0 plastic or stone, 1 metal: highlights and reflections take the surface's colour, and nothing else is reflected.
    pub metallic: f32,
    /// 0 mirror, 1 chalk: how wide reflections are.
    pub roughness: f32,
    /// 0 opaque, 1 glass: the share of light that is not reflected and goes on inside.
    #[serde(default)]
    pub transmission: f32,
    /// Index of refraction of what transmits: 1.33 water, 1.5 glass, 2.42 diamond.
    #[serde(default = "usual_ior")]
    pub ior: f32,
    /// What light loses inside over a scene unit: of each colour the exponent of Beer's law.
    #[serde(default)]
    pub attenuation: Vec3,
    /// Light of its own, linear.
    pub emission: Vec3,
}

/// That of glass.
const fn usual_ior() -> f32 {
    1.5
}

impl Default for Material {
    fn default() -> Self {
        Material {
            pattern: Pattern::Solid {
                colour: Vec3::new(0.62, 0.60, 0.57),
            },
            specular: 0.25,
            shininess: 40.0,
            metallic: 0.0,
            roughness: 0.5,
            transmission: 0.0,
            ior: usual_ior(),
            attenuation: Vec3::ZERO,
            emission: Vec3::ZERO,
        }
    }
}
