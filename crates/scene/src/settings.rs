//! How a scene is rendered: every method of the papers is a choice here, the default is the best one.

use serde::{Deserialize, Serialize};

/// How a ray finds the surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum March {
    /// Constant steps, then bisection of the sign change (Tomczak 2012, 2.1; Munini 2021, 3.2).
    Fixed {
        /// Step, in scene units.
        step: f32,
    },
    /// Steps of the field's value (Hart 1996; Tomczak 2012, 2.2).
    Sphere,
    /// Over-relaxation (Keinert 2014, 3.1 and listing 2).
    Relaxed {
        /// Factor on every step, 1 to less than 2.
        omega: f32,
    },
    /// Steps from the planar guess (Balint and Valasek 2018).
    Enhanced {
        /// Share of the guess that is taken, about 0.88 to 0.95.
        share: f32,
    },
    /// Over-relaxation from the slope of the field along the ray (Ban and Valasek 2023).
    Auto {
        /// Smoothing of the slope, 0 to 1.
        beta: f32,
    },
}

/// How the normal of a hit is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Normals {
    /// Four samples at the corners of a tetrahedron.
    Tetrahedron,
    /// Six samples, central differences (Tomczak 2012, 3.1).
    Central,
    /// 18 samples (Tomczak 2012, 3.1).
    Samples18,
    /// 26 samples (Tomczak 2012, 3.1).
    Samples26,
    /// Dual numbers: the exact gradient. The default: in SIMD it costs less than four samples, and samples on both sides of a
    /// crease blend its normals to one that is lit more than either.
    #[default]
    Exact,
}

/// How a shadow is found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum Shadow {
    /// No shadow.
    None,
    /// Lit or not (Tomczak 2012, 3.2).
    Hard,
    /// `min(sharpness * d / t)` (Tomczak 2012, 3.3).
    Soft {
        /// Larger is sharper; about 2 to 128.
        sharpness: f32,
    },
    /// The closest approach between two samples (Aaltonen 2018).
    SoftClosest {
        /// Larger is sharper; about 2 to 128.
        sharpness: f32,
    },
}

/// How ambient occlusion is found. Lengths are scene units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum Occlusion {
    /// No occlusion.
    None,
    /// Samples along the normal with halving weights (Tomczak 2012, algorithm 3.4 and equation 3.31).
    Quilez {
        /// Number of samples.
        steps: u32,
        /// Distance between samples.
        step: f32,
        /// Strength.
        scale: f32,
    },
    /// Samples along a way that bends towards `up` (Tomczak 2012, algorithm 3.7).
    Bent {
        /// Number of samples.
        steps: u32,
        /// Distance between samples.
        step: f32,
        /// Strength.
        scale: f32,
        /// How far the way bends at each sample.
        bend: f32,
    },
    /// Exponential of weighted samples at doubling distances (Evans 2006, 9.6; Tomczak 2012, equation 3.26).
    Evans {
        /// Strength.
        scale: f32,
        /// First distance above zero.
        step: f32,
        /// How far the normal bends towards the sky.
        bend: f32,
    },
    /// From the slope of the surface alone (Tomczak 2012, 4.3).
    Upward {
        /// Strength.
        scale: f32,
    },
    /// Nine cones over the hemisphere (the default).
    Cones {
        /// How far a cone looks.
        reach: f32,
        /// Samples along a cone.
        steps: u32,
    },
    /// Cosine-weighted sampled visibility: the reference (Tomczak 2012, equation 3.18).
    Hemisphere {
        /// Number of rays.
        rays: u32,
        /// How far they look.
        reach: f32,
    },
    /// As `hemisphere`, with near occluders counting more: `1 - exp(-tau d)` (Tomczak 2012, equations 3.19 to 3.24).
    Obscurance {
        /// Number of rays.
        rays: u32,
        /// How far they look.
        reach: f32,
        /// Falloff over distance, > 0.
        tau: f32,
    },
}

/// Shape of a pixel's filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Filter {
    /// One pixel wide, constant.
    Box,
    /// Two pixels wide, linear.
    Tent,
    /// Four pixels wide, B = C = 1/3 (Mitchell and Netravali 1988).
    #[default]
    Mitchell,
}

/// How edges are smoothed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum Antialias {
    /// One ray through the middle of each pixel.
    None,
    /// Several jittered rays a pixel.
    Supersample {
        /// Rays a pixel.
        samples: u32,
        /// How they are weighted.
        filter: Filter,
    },
}

/// Which light model turns a hit into a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shading {
    /// Ambient, diffuse and Blinn's specular term with `facing` (Tomczak 2012, equations 3.1 to 3.5).
    #[default]
    Phong,
    /// Lambert's cosine law, albedo / pi, with inverse squares for point lights (Munini 2021, 3.3).
    Lambert,
    /// `(n . l) colour / (4 pi)` without falloff, as printed in Munini 2021, 3.3.
    LambertLegacy,
}

/// All choices of a rendering.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How a ray finds the surface.
    pub march: March,
    /// Whether whole tiles are marched as cones first, so that their rays start near the surface.
    pub prepass: bool,
    /// Most steps a ray may take.
    pub max_steps: u32,
    /// Whether a ray that runs out of steps takes its best candidate (Keinert 2014, 3.2).
    pub hit_selection: bool,
    /// Fixed-point steps after a hit that put it where its pixel's footprint meets the surface (Keinert 2014, 3.4).
    pub discontinuity_reduction: u32,
    /// A hit is nearer to the surface than this many pixel widths.
    pub footprint: f32,
    /// How normals are found.
    pub normals: Normals,
    /// How light becomes colour.
    pub shading: Shading,
    /// Ambient occlusion, where an object does not choose its own.
    pub occlusion: Occlusion,
    /// Edges.
    pub antialias: Antialias,
    /// Chooses other random numbers for everything that samples.
    pub seed: u32,
    /// Exposure in stops, applied when linear light becomes a picture.
    pub exposure: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            size: [512, 512],
            march: March::Auto { beta: 0.3 },
            prepass: true,
            max_steps: 256,
            hit_selection: true,
            discontinuity_reduction: 0,
            footprint: 0.5,
            normals: Normals::Exact,
            shading: Shading::Phong,
            occlusion: Occlusion::Cones {
                reach: 1.5,
                steps: 5,
            },
            antialias: Antialias::Supersample {
                samples: 4,
                filter: Filter::Mitchell,
            },
            seed: 0,
            exposure: 0.0,
        }
    }
}
