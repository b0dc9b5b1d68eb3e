//! Materials: what a surface looks like.

use glam::Vec3;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::sync::Arc;
use zeroset_field::formula::ColourFormula;

/// A colour that may change over space. All colours are linear. Patterns lie in the space of what was painted: what is moved, turned,
/// scaled, bent or repeated after it was painted takes its pattern along.
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
        colours: [Ink; 2],
        /// Side of a cube, scene units.
        size: f32,
    },
    /// Bands of two colours across a direction, averaged over a pixel. The band that begins at the origin has the second
    /// colour.
    Stripes {
        /// The two.
        colours: [Ink; 2],
        /// Across which way; normalised.
        direction: Vec3,
        /// Width of a band, scene units.
        size: f32,
    },
    /// Fractal noise between two colours. An octave of features of size `s` counts `1 - 2 w / s`, where `w` is how far a
    /// pixel reaches over the surface: from half a feature on it is its mean.
    Noise {
        /// The two.
        colours: [Ink; 2],
        /// Size of the largest feature, scene units.
        size: f32,
        /// Number of octaves, 1 to 8.
        octaves: u32,
    },
    /// From one colour to another between two points.
    Gradient {
        /// The two.
        colours: [Ink; 2],
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
        colours: [Ink; 4],
    },
    /// What a formula gives at the point. It is not averaged over a pixel. As a colour its numbers are clamped to 0 to 1; as
    /// a height they are taken as they are.
    Formula {
        /// The formula, linear. Whoever reads a scene from a file brings it.
        #[serde(skip, default = "black")]
        formula: Arc<ColourFormula>,
    },
    /// A pattern that was moved, turned or scaled: it shows at `p` what it shows at `rows p + offset` where it is not.
    Placed {
        /// The pattern.
        pattern: Box<Pattern>,
        /// Rows of a matrix whose determinant is not zero.
        rows: [Vec3; 3],
        /// Added to its product with the point.
        offset: Vec3,
    },
}

fn black() -> Arc<ColourFormula> {
    Arc::new(ColourFormula::black())
}

/// The formulas of materials, each once.
pub fn formulas(materials: &[Material]) -> Vec<Arc<ColourFormula>> {
    let mut all: Vec<Arc<ColourFormula>> = Vec::new();
    let patterns = materials.iter().flat_map(Material::patterns);
    for part in patterns.flat_map(|(_, pattern)| pattern.parts()) {
        if let Pattern::Formula { formula } = part
            && !all.iter().any(|known| Arc::ptr_eq(known, formula))
        {
            all.push(Arc::clone(formula));
        }
    }
    all
}

/// What a pattern shows somewhere: a colour, or another pattern.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Ink {
    /// One colour.
    Colour(Vec3),
    /// A pattern.
    Pattern(Box<Pattern>),
}

impl From<Vec3> for Ink {
    fn from(colour: Vec3) -> Ink {
        Ink::Colour(colour)
    }
}

impl From<Pattern> for Ink {
    fn from(pattern: Pattern) -> Ink {
        Ink::Pattern(Box::new(pattern))
    }
}

// Three numbers or an object. (Derived for untagged enums, errors would not say what is wrong with either.)
impl<'de> Deserialize<'de> for Ink {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Ink, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Ink;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("three numbers or a pattern")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Ink, A::Error> {
                Vec3::deserialize(SeqAccessDeserializer::new(list)).map(Ink::Colour)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Ink, A::Error> {
                Pattern::deserialize(MapAccessDeserializer::new(map)).map(Ink::from)
            }
        }
        from.deserialize_any(Either)
    }
}

impl Pattern {
    /// Patterns that a pattern may consist of, itself among them.
    pub const MOST: usize = 24;

    /// What it shows where its place in space says so; nothing else of it.
    pub fn inks(&self) -> &[Ink] {
        match self {
            Pattern::Checker { colours, .. }
            | Pattern::Stripes { colours, .. }
            | Pattern::Noise { colours, .. }
            | Pattern::Gradient { colours, .. } => colours,
            Pattern::Orbit { colours } => colours,
            Pattern::Solid { .. }
            | Pattern::Triplanar { .. }
            | Pattern::Formula { .. }
            | Pattern::Placed { .. } => &[],
        }
    }

    /// The patterns that it consists of: itself, and then theirs.
    pub fn parts(&self) -> impl Iterator<Item = &Pattern> {
        let mut waiting = vec![self];
        std::iter::from_fn(move || {
            let next = waiting.pop()?;
            if let Pattern::Placed { pattern, .. } = next {
                waiting.push(pattern);
            }
            waiting.extend(next.inks().iter().filter_map(|ink| match ink {
                Ink::Pattern(pattern) => Some(&**pattern),
                Ink::Colour(_) => None,
            }));
            Some(next)
        })
    }

    /// Calls `f` with every image that it shows.
    ///
    /// # Errors
    /// That of `f`.
    pub fn images_mut<E>(
        &mut self,
        f: &mut impl FnMut(&mut Arc<Image>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.each_mut(&mut |part| match part {
            Pattern::Triplanar { image, .. } => f(image),
            _ => Ok(()),
        })
    }

    /// Calls `f` with every pattern that it consists of, each before those that it shows, and these in their order.
    ///
    /// # Errors
    /// That of `f`.
    pub fn each_mut<E>(
        &mut self,
        f: &mut impl FnMut(&mut Pattern) -> Result<(), E>,
    ) -> Result<(), E> {
        f(self)?;
        let inks: &mut [Ink] = match self {
            Pattern::Placed { pattern, .. } => return pattern.each_mut(f),
            Pattern::Checker { colours, .. }
            | Pattern::Stripes { colours, .. }
            | Pattern::Noise { colours, .. }
            | Pattern::Gradient { colours, .. } => colours,
            Pattern::Orbit { colours } => colours,
            Pattern::Solid { .. } | Pattern::Triplanar { .. } | Pattern::Formula { .. } => &mut [],
        };
        for ink in inks {
            if let Ink::Pattern(pattern) = ink {
                pattern.each_mut(f)?;
            }
        }
        Ok(())
    }

    /// Whether it depends on where it is. (The orbit of a fractal is the same wherever the fractal was moved.)
    pub fn is_spatial(&self) -> bool {
        self.parts().any(|part| {
            !matches!(
                part,
                Pattern::Solid { .. } | Pattern::Orbit { .. } | Pattern::Placed { .. }
            )
        })
    }
}

/// Heights of a surface that is shown as if it had them: they turn its normal and move nothing (Blinn 1978).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bump {
    /// The height is the luminance of this, or the value of its formula.
    pub pattern: Pattern,
    /// How high 1 is, scene units. Less than 0 is deep.
    pub depth: f32,
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
    /// The roughness from place to place, as the luminance of a pattern, in the stead of `roughness`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness_map: Option<Pattern>,
    /// The same of `metallic`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub metallic_map: Option<Pattern>,
    /// Heights that turn the normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bump: Option<Bump>,
}

impl Material {
    /// Its patterns, with the names of the fields that they are in.
    pub fn patterns(&self) -> impl Iterator<Item = (&'static str, &Pattern)> {
        let maps = [
            ("pattern", Some(&self.pattern)),
            ("roughness_map", self.roughness_map.as_ref()),
            ("metallic_map", self.metallic_map.as_ref()),
            ("bump", self.bump.as_ref().map(|b| &b.pattern)),
        ];
        maps.into_iter()
            .filter_map(|(name, pattern)| Some((name, pattern?)))
    }

    /// The same, to change them.
    pub fn patterns_mut(&mut self) -> impl Iterator<Item = (&'static str, &mut Pattern)> {
        let maps = [
            ("pattern", Some(&mut self.pattern)),
            ("roughness_map", self.roughness_map.as_mut()),
            ("metallic_map", self.metallic_map.as_mut()),
            ("bump", self.bump.as_mut().map(|b| &mut b.pattern)),
        ];
        maps.into_iter()
            .filter_map(|(name, pattern)| Some((name, pattern?)))
    }

    /// Whether it looks different from place to place.
    pub fn is_spatial(&self) -> bool {
        self.patterns().any(|(_, pattern)| pattern.is_spatial())
    }

    /// The least roughness that it may have somewhere.
    pub fn least_roughness(&self) -> f32 {
        match self.roughness_map {
            Some(_) => 0.0,
            None => self.roughness,
        }
    }
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
            roughness_map: None,
            metallic_map: None,
            bump: None,
        }
    }
}
