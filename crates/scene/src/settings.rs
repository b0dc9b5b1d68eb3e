//! How a scene is rendered: every method of the papers is a choice here, the default is the best one.

use crate::methods::{Allowed, Kind, LENGTH, Limit, Param, SAMPLES, Unit, Value, choice};
use serde::{Deserialize, Serialize};

choice! {
    /// How a ray finds the surface.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(tag = "method", deny_unknown_fields)]
    pub enum March("march", "a marching method", "Marching") {
        /// Longer steps, taken from the slope of the field along the ray.
        Auto("auto", "Auto", "Bán and Valasek 2023") {
            /// How fast the slope is followed: 1 takes that of the last step alone.
            beta: f32 = 0.3, Param::new("Beta", Unit::Ratio, Allowed::above(0.0, 1.0)).usual(0.01, 1.0)
        },
        /// Steps as far as they would go if the surface were flat.
        Enhanced("enhanced", "Enhanced", "Bálint and Valasek 2018") {
            /// How much of the planar guess is taken; at 1 spheres only touch, and rounding decides.
            share: f32 = 0.9, Param::new("Share", Unit::Ratio, Allowed::below(0.0, 1.0)).usual(0.1, 0.99)
        },
        /// Steps longer by a factor, taken back where they went too far.
        Relaxed("relaxed", "Over-relaxation", "Keinert et al. 2014, 3.1 and listing 2") {
            /// The factor on every step; spheres that are 2 radii apart do not overlap.
            omega: f32 = 1.2, Param::new("Omega", Unit::Ratio, Allowed::below(1.0, 2.0)).usual(1.0, 1.99)
        },
        /// Steps of the field's value: never beyond the nearest surface.
        Sphere("sphere" as "sphere_tracing", "Sphere tracing", "Hart 1996; Tomczak 2012, 2.2"),
        /// Equal steps, then bisection where the sign changes.
        Fixed("fixed", "Fixed steps", "Tomczak 2012, 2.1; Munini 2021, 3.2") {
            /// Length of a step.
            step: f32 = 0.02, Param::new("Step", Unit::Length, LENGTH).usual(0.001, 0.5).logarithmic()
        },
    }
}

choice! {
    /// How the normal of a hit is found.
    ///
    /// The exact gradient is the default: in SIMD it costs less than four samples, and samples on both sides of a crease
    /// blend its normals to one that is lit more than either.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    pub enum Normals("normals", "a way to find normals", "Normals") {
        /// The derivative of the field itself, without samples beside the point.
        Exact("exact", "Exact gradient", "dual numbers"),
        /// Differences between the corners of a tetrahedron.
        Tetrahedron("tetrahedron", "Tetrahedron", "4 samples"),
        /// Differences along the three axes.
        Central("central", "Central differences", "Tomczak 2012, 3.1; 6 samples"),
        /// Differences along axes and face diagonals: smooths creases.
        Samples18("samples18", "18 samples", "Tomczak 2012, 3.1"),
        /// Differences to all neighbours of a cube: smooths creases more.
        Samples26("samples26", "26 samples", "Tomczak 2012, 3.1"),
    }
}

/// How sharp a penumbra is.
const SHARPNESS: Param = Param::new("Sharpness", Unit::Ratio, Allowed::between(1.0, 1000.0))
    .usual(1.0, 128.0)
    .logarithmic();

choice! {
    /// How a shadow is found.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(tag = "method", deny_unknown_fields)]
    pub enum Shadow("shadow", "a shadow", "Shadows") {
        /// A penumbra from how near the ray came between two samples: no bands.
        SoftClosest("soft_closest", "Soft, closest approach", "Aaltonen 2018") {
            /// Larger is sharper: distance over way is multiplied by it.
            sharpness: f32 = 16.0, SHARPNESS
        },
        /// A penumbra from the smallest ratio of distance and way.
        Soft("soft", "Soft", "Quílez 2010; Tomczak 2012, 3.3") {
            /// Larger is sharper: distance over way is multiplied by it.
            sharpness: f32 = 16.0, SHARPNESS
        },
        /// Lit or not: one ray towards the light.
        Hard("hard", "Hard", "Tomczak 2012, 3.2"),
        /// Light that flows through a volume: soft shadows without rays, wherever the light is.
        Advected("advected", "Advected", "Evans 2006, 9.9 and figure 12") {
            /// Voxels along the longest side of the volume around what has an end.
            resolution: u32 = 64, Param::new("Resolution", Unit::Count, Allowed::between(16.0, 160.0)).usual(16.0, 160.0).logarithmic();
            /// How much of the light is blurred from voxel to voxel: shadows grow softer on their way.
            spread: f32 = 0.3, Param::new("Spread", Unit::Ratio, Allowed::between(0.0, 1.0));
            /// How far before surfaces light is read, in voxels: less, and they shadow themselves.
            bias: f32 = 2.0, Param::new("Bias", Unit::Ratio, Allowed::between(0.0, 8.0)).usual(0.0, 4.0)
        },
        /// Every surface that faces a light is lit.
        None("none", "None", "no rays"),
    }
}

/// Samples along a way.
const STEPS: Param = Param::new("Samples", Unit::Count, SAMPLES).usual(1.0, 32.0);
/// Distance between samples.
const STEP: Param = Param::new("Step", Unit::Length, LENGTH)
    .usual(0.005, 2.0)
    .logarithmic();
/// What a sum of lengths is multiplied by.
const SCALE: Param =
    Param::new("Strength", Unit::PerLength, Allowed::between(0.0, 1000.0)).usual(0.0, 4.0);
/// What is added of the way up.
const BEND: Param = Param::new("Bend", Unit::Ratio, Allowed::between(0.0, 10.0)).usual(0.0, 2.0);
/// How far occlusion looks.
const REACH: Param = Param::new("Reach", Unit::Length, LENGTH)
    .usual(0.001, 1000.0)
    .logarithmic();
/// Rays over the hemisphere.
const RAYS: Param = Param::new("Rays", Unit::Count, SAMPLES)
    .usual(1.0, 1024.0)
    .logarithmic();

choice! {
    /// How ambient occlusion is found.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(tag = "method", deny_unknown_fields)]
    pub enum Occlusion("ao", "an occlusion method", "Ambient occlusion") {
        /// Eleven cones, each as open as the field leaves its axis clear.
        Cones("cones", "Cones", "distance field occlusion, 11 cones") {
            /// How far they look; unlimited, to the end of the scene.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            reach: Limit = None, REACH;
            /// Samples along a cone, at most.
            steps: u32 = 24, STEPS
        },
        /// Samples along the normal with halving weights.
        Quilez("quilez", "Quilez", "Tomczak 2012, algorithm 3.4 and equation 3.31") {
            /// Number of samples.
            steps: u32 = 5, STEPS;
            /// Distance between samples.
            step: f32 = 0.1, STEP;
            /// How dark closed places become.
            scale: f32 = 1.0, SCALE
        },
        /// Samples along a way that bends upwards.
        Bent("bent", "Bent", "Tomczak 2012, algorithm 3.7") {
            /// Number of samples.
            steps: u32 = 5, STEPS;
            /// Distance between samples.
            step: f32 = 0.1, STEP;
            /// How dark closed places become.
            scale: f32 = 0.5, SCALE;
            /// How far the way bends at each sample.
            bend: f32 = 0.2, BEND
        },
        /// Weighted samples at doubling distances, under an exponential.
        Evans("evans", "Evans", "Evans 2006, 9.6; Tomczak 2012, equation 3.26") {
            /// How dark closed places become.
            scale: f32 = 1.0, SCALE;
            /// First distance above zero.
            step: f32 = 0.1, STEP;
            /// How far the normal bends towards the sky.
            bend: f32 = 0.5, BEND
        },
        /// Distances of a volume with mips, read along a way that bends towards the sky.
        Skylight("skylight", "Skylight", "Evans 2006, 9.6, 9.9 and listing 1") {
            /// Voxels along the longest side of the volume around what has an end.
            resolution: u32 = 128, Param::new("Resolution", Unit::Count, Allowed::between(16.0, 256.0)).usual(16.0, 256.0).logarithmic();
            /// First distance above zero, in voxels; each of the next three is twice as far.
            step: f32 = 2.0, Param::new("Step", Unit::Ratio, Allowed::between(0.25, 16.0)).usual(0.5, 8.0).logarithmic();
            /// How dark closed places become: e to the power of minus this.
            strength: f32 = 3.0, Param::new("Strength", Unit::Ratio, Allowed::between(0.0, 100.0)).usual(0.0, 8.0);
            /// How far the normal bends towards the sky.
            bend: f32 = 0.5, BEND;
            /// How much of the light that near things take comes back in their colours.
            bleed: f32 = 0.0, Param::new("Colour bleeding", Unit::Ratio, Allowed::between(0.0, 1.0))
        },
        /// Creases dark and ridges light, from how much a blurred volume of distances is off at the surface.
        Curvature("curvature", "Curvature", "Evans 2006, 9.5 and figure 5") {
            /// Voxels along the longest side of the volume around what has an end.
            resolution: u32 = 64, Param::new("Resolution", Unit::Count, Allowed::between(16.0, 256.0)).usual(16.0, 256.0).logarithmic();
            /// Which mip is read: each is blurred twice as far, and shows creases twice as wide.
            blur: u32 = 1, Param::new("Blur", Unit::Count, Allowed::between(0.0, 3.0));
            /// How much creases and ridges differ: what a distance of a voxel of that mip is multiplied by.
            strength: f32 = 3.0, Param::new("Strength", Unit::Ratio, Allowed::between(0.0, 100.0)).usual(0.0, 10.0)
        },
        /// From the slope of the surface alone.
        Upward("upward", "Upward", "Tomczak 2012, 4.3") {
            /// How dark surfaces that face down become.
            scale: f32 = 0.5, Param { unit: Unit::Ratio, ..SCALE }
        },
        /// Sampled visibility of the hemisphere, weighted by the cosine: the reference.
        Hemisphere("hemisphere", "Hemisphere", "Tomczak 2012, equation 3.18") {
            /// Number of rays.
            rays: u32 = 64, RAYS;
            /// How far they look; unlimited, to the end of the scene.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            reach: Limit = None, REACH
        },
        /// As hemisphere, near things counting more: `1 - exp(-tau d)`.
        Obscurance("obscurance", "Obscurance", "Iones 2003; Tomczak 2012, equations 3.19 to 3.24") {
            /// Number of rays.
            rays: u32 = 64, RAYS;
            /// How far they look; unlimited, to the end of the scene.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            reach: Limit = None, REACH;
            /// Falloff over distance.
            tau: f32 = 2.0, Param::new("Tau", Unit::PerLength, Allowed::above(0.0, 1000.0)).usual(0.05, 50.0).logarithmic()
        },
        /// The sky reaches every surface.
        None("none", "None", "no samples"),
    }
}

choice! {
    /// Shape of a pixel's filter.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    pub enum Filter("filter", "a filter", "Filters") {
        /// Falls off evenly: no rings around what is brighter than white.
        Tent("tent", "Tent", "two pixels wide"),
        /// Four pixels wide, B = C = 1/3: sharp, with little ringing.
        Mitchell("mitchell", "Mitchell", "Mitchell and Netravali 1988"),
        /// Every ray of the pixel counts alike.
        Box("box", "Box", "one pixel wide"),
    }
}

choice! {
    /// How edges are smoothed.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(tag = "method", deny_unknown_fields)]
    pub enum Antialias("aa", "an antialiasing method", "Antialiasing") {
        /// Jittered rays, weighted by a filter.
        Supersample("supersample", "Supersampling", "several rays a pixel") {
            /// Rays a pixel.
            samples: u32 = 4, Param::new("Rays a pixel", Unit::Count, SAMPLES).usual(1.0, 256.0).logarithmic();
            /// How they are weighted.
            filter: Filter = Filter::Tent, Param::new("Filter", Unit::Count, Allowed::between(0.0, 0.0))
        },
        /// Pixels that an edge goes through are parted by it, and each part is seen once.
        Coverage("coverage", "Coverage", "Hart 1996; Tomczak 2012, 5") {
            /// Edges that a pixel may be parted by.
            layers: u32 = 4, Param::new("Layers", Unit::Count, Allowed::between(1.0, 8.0))
        },
        /// One ray through the middle of each pixel.
        None("none", "None", "one ray a pixel"),
    }
}

impl Antialias {
    /// Rays a pixel that are spread over it.
    pub fn samples(self) -> u32 {
        match self {
            Antialias::None | Antialias::Coverage { .. } => 1,
            Antialias::Supersample { samples, .. } => samples.max(1),
        }
    }

    /// How they are weighted; none where there are no such rays.
    pub fn filter(self) -> Option<Filter> {
        match self {
            Antialias::None | Antialias::Coverage { .. } => None,
            Antialias::Supersample { filter, .. } => Some(filter),
        }
    }
}

choice! {
    /// Which light model turns a hit into a colour.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    pub enum Shading("shading", "a light model", "Shading") {
        /// Small mirrors over a matte body, with Fresnel's law and all light that mirrors send on.
        Physical("physical", "Physical", "Cook and Torrance 1982; Walter et al. 2007; Turquin 2019"),
        /// Ambient, diffuse and Blinn's highlight, none where the light is behind the surface.
        Phong("phong", "Phong", "Tomczak 2012, equations 3.1 to 3.5"),
        /// The cosine law, albedo over pi, point lights with inverse squares.
        Lambert("lambert", "Lambert", "Munini 2021, 3.3"),
        /// `(n . l) colour / (4 pi)`, without falloff.
        LambertLegacy("lambert_legacy", "Lambert as printed", "Munini 2021, 3.3"),
    }
}

/// How often a ray goes on.
const BOUNCES: Param =
    Param::new("Bounces", Unit::Count, Allowed::between(0.0, 32.0)).usual(0.0, 16.0);

choice! {
    /// Which ways light takes to the eye.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(tag = "method", deny_unknown_fields)]
    pub enum Integrator("integrator", "an integrator", "Integrators") {
        /// From lights and sky, and on over smooth surfaces and through clear bodies.
        Whitted("whitted", "Reflections", "Whitted 1980; Keinert et al. 2014, 4") {
            /// How often a ray is reflected.
            reflections: u32 = 2, BOUNCES;
            /// How often a ray passes the surface of a clear body, or is reflected within it.
            refractions: u32 = 8, BOUNCES
        },
        /// All ways, one of many chosen at random at each surface: the picture that the others are near to.
        Path("path", "Path tracing", "Kajiya 1986; Keinert et al. 2014, 4; Burley 2020") {
            /// Surfaces that light meets on its way, at most.
            depth: u32 = 10, Param::new("Depth", Unit::Count, Allowed::between(1.0, 1000.0)).usual(1.0, 32.0).logarithmic();
            /// The most that light counts which was scattered: less noise, and darker where it clamps.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            clamp: Limit = None, Param::new("Clamp", Unit::Ratio, Allowed::above(0.0, 1e6)).usual(0.1, 100.0).logarithmic()
        },
        /// From lights and sky, reflected once.
        Direct("direct", "Direct light", "Tomczak 2012, 3"),
    }
}

choice! {
    /// How light that is brighter than a screen can show is shown.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    pub enum Tone("tone", "a tone curve", "Tone curves") {
        /// As it is up to seven tenths of white, then ever more slowly.
        Soft("soft", "Soft", "a shoulder above 0.7"),
        /// With the contrast of film.
        Filmic("filmic", "Filmic", "ACES as fitted by Narkowicz 2016"),
        /// Bright colours grow pale, as on film.
        Agx("agx", "AgX", "Sobotka 2022, as fitted by Wrensch 2023"),
        /// As it is, cut off at white.
        Standard("standard", "Standard", "IEC 61966-2-1"),
    }
}

/// How linear light becomes a picture on a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewTransform {
    /// Stops brighter or darker.
    pub exposure: f32,
    /// What becomes of light beyond white.
    pub tone: Tone,
}

impl ViewTransform {
    /// Light as it is, so many stops brighter, cut off at white.
    pub const fn standard(exposure: f32) -> ViewTransform {
        ViewTransform {
            exposure,
            tone: Tone::Standard,
        }
    }
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
    /// Which ways light takes.
    pub integrator: Integrator,
    /// Ambient occlusion, where an object does not choose its own.
    pub occlusion: Occlusion,
    /// Edges.
    pub antialias: Antialias,
    /// Chooses other random numbers for everything that samples.
    pub seed: u32,
    /// Exposure in stops, applied when linear light becomes a picture.
    pub exposure: f32,
    /// What becomes then of light that is brighter than a screen can show.
    pub tone: Tone,
}

impl Settings {
    /// The settings of a scene that states none.
    pub const DEFAULT: Settings = Settings {
        size: [512, 512],
        march: March::ALL[0],
        prepass: true,
        max_steps: 256,
        hit_selection: true,
        discontinuity_reduction: 0,
        footprint: 0.5,
        normals: Normals::ALL[0],
        shading: Shading::ALL[0],
        integrator: Integrator::ALL[0],
        occlusion: Occlusion::ALL[0],
        antialias: Antialias::ALL[0],
        seed: 0,
        exposure: 0.0,
        tone: Tone::ALL[0],
    };

    /// How linear light becomes a picture on a screen.
    pub fn view_transform(&self) -> ViewTransform {
        ViewTransform {
            exposure: self.exposure,
            tone: self.tone,
        }
    }

    /// [`Settings::max_steps`] as a parameter.
    pub const MAX_STEPS: Param = Param {
        name: "max_steps",
        doc: "Most steps of a ray.",
        kind: Kind::Whole,
        default: Value::Whole(Settings::DEFAULT.max_steps),
        ..Param::new("Most steps", Unit::Count, Allowed::between(1.0, 1e5))
            .usual(1.0, 2048.0)
            .logarithmic()
    };

    /// [`Settings::discontinuity_reduction`] as a parameter.
    pub const DISCONTINUITY_REDUCTION: Param = Param {
        name: "discontinuity_reduction",
        doc: "Steps that put a hit where its pixel meets the surface (Keinert et al. 2014, 3.4).",
        kind: Kind::Whole,
        default: Value::Whole(Settings::DEFAULT.discontinuity_reduction),
        ..Param::new("Hit repair", Unit::Count, Allowed::between(0.0, 16.0)).usual(0.0, 8.0)
    };

    /// [`Settings::footprint`] as a parameter.
    pub const FOOTPRINT: Param = Param {
        name: "footprint",
        doc: "A hit is nearer to the surface than so many pixel widths.",
        default: Value::Real(Settings::DEFAULT.footprint),
        ..Param::new("Hit within", Unit::Pixels, Allowed::between(1e-3, 4.0))
            .usual(0.05, 4.0)
            .logarithmic()
    };

    /// [`Settings::exposure`] as a parameter.
    pub const EXPOSURE: Param = Param {
        name: "exposure",
        doc: "Stops brighter or darker.",
        default: Value::Real(Settings::DEFAULT.exposure),
        ..Param::new("Exposure", Unit::Stops, Allowed::between(-20.0, 20.0)).usual(-6.0, 6.0)
    };
}

impl Default for Settings {
    fn default() -> Self {
        Settings::DEFAULT
    }
}
