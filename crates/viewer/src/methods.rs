//! Every method of the papers that can be chosen, with its name, where it comes from, and what it does.
//!
//! One list for each choice makes both the table and the place of every variant in it: a variant that is left out does not
//! compile.

use zeroset_scene::film::Plane;
use zeroset_scene::settings::{Antialias, Filter, March, Normals, Occlusion, Shading, Shadow};

/// A method as a person reads of it.
#[derive(Clone, Copy, Debug)]
pub struct Method<T> {
    /// What it is called.
    pub name: &'static str,
    /// Where it comes from; empty where it is nobody's idea.
    pub source: &'static str,
    /// What it does, on one line.
    pub about: &'static str,
    /// The method, with numbers that are good to begin with.
    pub make: T,
}

/// A number of a method.
pub struct Dial<'a> {
    /// What it is called.
    pub name: &'static str,
    /// What it does, on one line.
    pub about: &'static str,
    /// Smallest and largest value.
    pub range: (f32, f32),
    /// Whether equal ratios are equal distances on the slider.
    pub is_logarithmic: bool,
    /// The number.
    pub number: Number<'a>,
}

/// A number that a slider moves.
pub enum Number<'a> {
    /// Any number.
    Real(&'a mut f32),
    /// A whole number.
    Whole(&'a mut u32),
    /// A number that there may be none of: the end of the slider stands for no limit.
    Limit(&'a mut Option<f32>),
}

/// A choice among methods.
pub trait Choice: Copy + Sized + 'static {
    /// All there are.
    fn methods() -> &'static [Method<Self>];
    /// Where this one is in the list.
    fn place(&self) -> usize;
    /// Its numbers.
    fn dials(&mut self) -> Vec<Dial<'_>> {
        Vec::new()
    }
}

macro_rules! choice {
    ($type:ty { $($pattern:pat => $make:expr, $name:literal, $source:literal, $about:literal;)+ } $(dials($this:ident) $dials:block)?) => {
        impl Choice for $type {
            fn methods() -> &'static [Method<Self>] {
                const ALL: &[Method<$type>] = &[
                    $(Method { name: $name, source: $source, about: $about, make: $make },)+
                ];
                ALL
            }
            fn place(&self) -> usize {
                // no variant is left out
                let name = match self { $($pattern => $name,)+ };
                Self::methods().iter().position(|m| m.name == name).unwrap_or(0)
            }
            $(fn dials(&mut self) -> Vec<Dial<'_>> { let $this = self; $dials })?
        }
    };
}

fn real<'a>(
    name: &'static str,
    about: &'static str,
    range: (f32, f32),
    number: &'a mut f32,
) -> Dial<'a> {
    Dial {
        name,
        about,
        range,
        is_logarithmic: false,
        number: Number::Real(number),
    }
}

fn ratio<'a>(
    name: &'static str,
    about: &'static str,
    range: (f32, f32),
    number: &'a mut f32,
) -> Dial<'a> {
    Dial {
        is_logarithmic: true,
        ..real(name, about, range, number)
    }
}

fn whole<'a>(
    name: &'static str,
    about: &'static str,
    range: (f32, f32),
    number: &'a mut u32,
) -> Dial<'a> {
    Dial {
        name,
        about,
        range,
        is_logarithmic: range.1 > 64.0,
        number: Number::Whole(number),
    }
}

choice! { March {
    March::Auto { .. } => March::Auto { beta: 0.3 }, "Auto", "Bán and Valasek 2023",
        "Longer steps, taken from the slope of the field along the ray.";
    March::Enhanced { .. } => March::Enhanced { share: 0.9 }, "Enhanced", "Bálint and Valasek 2018",
        "Steps as far as they would go if the surface were flat.";
    March::Relaxed { .. } => March::Relaxed { omega: 1.2 }, "Over-relaxation", "Keinert et al. 2014, 3.1",
        "Steps longer by a factor, taken back where they went too far.";
    March::Sphere => March::Sphere, "Sphere tracing", "Hart 1996; Tomczak 2012, 2.2",
        "Steps of the field's value: never beyond the nearest surface.";
    March::Fixed { .. } => March::Fixed { step: 0.02 }, "Fixed steps", "Tomczak 2012, 2.1; Munini 2021, 3.2",
        "Equal steps, then bisection where the sign changes.";
} dials(this) {
    match this {
        March::Sphere => Vec::new(),
        March::Auto { beta } => vec![real("Beta", "How fast the slope is followed.", (0.01, 1.0), beta)],
        March::Enhanced { share } => {
            vec![real("Share", "How much of the planar guess is taken.", (0.1, 1.0), share)]
        }
        March::Relaxed { omega } => vec![real("Omega", "The factor on every step.", (1.0, 1.99), omega)],
        March::Fixed { step } => vec![ratio("Step", "Length of a step, scene units.", (0.001, 0.5), step)],
    }
} }

choice! { Normals {
    Normals::Exact => Normals::Exact, "Exact gradient", "dual numbers",
        "The derivative of the field itself, without samples beside the point.";
    Normals::Tetrahedron => Normals::Tetrahedron, "Tetrahedron", "4 samples",
        "Differences between the corners of a tetrahedron.";
    Normals::Central => Normals::Central, "Central differences", "Tomczak 2012, 3.1; 6 samples",
        "Differences along the three axes.";
    Normals::Samples18 => Normals::Samples18, "18 samples", "Tomczak 2012, 3.1",
        "Differences along axes and face diagonals: smooths creases.";
    Normals::Samples26 => Normals::Samples26, "26 samples", "Tomczak 2012, 3.1",
        "Differences to all neighbours of a cube: smooths creases more.";
} }

choice! { Shadow {
    Shadow::SoftClosest { .. } => Shadow::SoftClosest { sharpness: 16.0 }, "Soft, closest approach", "Aaltonen 2018",
        "A penumbra from how near the ray came between two samples.";
    Shadow::Soft { .. } => Shadow::Soft { sharpness: 16.0 }, "Soft", "Tomczak 2012, 3.3",
        "A penumbra from the smallest ratio of distance and way.";
    Shadow::Hard => Shadow::Hard, "Hard", "Tomczak 2012, 3.2",
        "Lit or not: one ray towards the light.";
    Shadow::None => Shadow::None, "None", "no rays",
        "Every surface that faces a light is lit.";
} dials(this) {
    match this {
        Shadow::None | Shadow::Hard => Vec::new(),
        Shadow::Soft { sharpness } | Shadow::SoftClosest { sharpness } => {
            vec![ratio("Sharpness", "Larger is sharper.", (1.0, 128.0), sharpness)]
        }
    }
} }

const STEP: &str = "Distance between samples, scene units.";
const REACH: &str = "How far they look, scene units; at the end of the slider without limit.";

choice! { Occlusion {
    Occlusion::Cones { .. } => Occlusion::Cones { reach: None, steps: 14 }, "Cones", "distance field occlusion, 11 cones",
        "Eleven cones, each as open as the field leaves its axis clear.";
    Occlusion::Quilez { .. } => Occlusion::Quilez { steps: 5, step: 0.1, scale: 1.0 }, "Quilez", "Tomczak 2012, 3.4",
        "Samples along the normal with halving weights.";
    Occlusion::Bent { .. } => Occlusion::Bent { steps: 5, step: 0.1, scale: 0.5, bend: 0.2 }, "Bent", "Tomczak 2012, 3.7",
        "Samples along a way that bends upwards.";
    Occlusion::Evans { .. } => Occlusion::Evans { scale: 1.0, step: 0.1, bend: 0.5 }, "Evans", "Evans 2006, 9.6",
        "Weighted samples at doubling distances, under an exponential.";
    Occlusion::Upward { .. } => Occlusion::Upward { scale: 0.5 }, "Upward", "Tomczak 2012, 4.3",
        "From the slope of the surface alone.";
    Occlusion::Hemisphere { .. } => Occlusion::Hemisphere { rays: 64, reach: None }, "Hemisphere", "Tomczak 2012, 3.18",
        "Sampled visibility of the hemisphere: the reference.";
    Occlusion::Obscurance { .. } => Occlusion::Obscurance { rays: 64, reach: None, tau: 2.0 }, "Obscurance",
        "Iones 2003; Tomczak 2012, 3.19", "As hemisphere, near things counting more.";
    Occlusion::None => Occlusion::None, "None", "no samples",
        "The sky reaches every surface.";
} dials(this) {
    match this {
        Occlusion::None => Vec::new(),
        Occlusion::Quilez { steps, step, scale } => {
            vec![samples(steps), along(step), strength(scale)]
        }
        Occlusion::Bent { steps, step, scale, bend } => vec![
            samples(steps),
            along(step),
            strength(scale),
            real("Bend", "How far the way bends at each sample.", (0.0, 2.0), bend),
        ],
        Occlusion::Evans { scale, step, bend } => vec![
            strength(scale),
            ratio("Step", "First distance above zero, scene units.", (0.005, 2.0), step),
            real("Bend", "How far the normal bends towards the sky.", (0.0, 2.0), bend),
        ],
        Occlusion::Upward { scale } => vec![strength(scale)],
        Occlusion::Cones { reach, steps } => vec![far(reach), samples(steps)],
        Occlusion::Hemisphere { rays, reach } => vec![many(rays), far(reach)],
        Occlusion::Obscurance { rays, reach, tau } => vec![
            many(rays),
            far(reach),
            ratio("Tau", "Falloff over distance.", (0.05, 50.0), tau),
        ],
    }
} }

fn samples(steps: &mut u32) -> Dial<'_> {
    whole(
        "Samples",
        "How many samples along a way.",
        (1.0, 32.0),
        steps,
    )
}

fn along(step: &mut f32) -> Dial<'_> {
    ratio("Step", STEP, (0.005, 2.0), step)
}

fn strength(scale: &mut f32) -> Dial<'_> {
    real(
        "Strength",
        "How dark closed places become.",
        (0.0, 4.0),
        scale,
    )
}

fn far(reach: &mut Option<f32>) -> Dial<'_> {
    Dial {
        name: "Reach",
        about: REACH,
        range: (0.001, 1000.0),
        is_logarithmic: true,
        number: Number::Limit(reach),
    }
}

fn many(rays: &mut u32) -> Dial<'_> {
    whole(
        "Rays",
        "How many rays over the hemisphere.",
        (1.0, 1024.0),
        rays,
    )
}

choice! { Shading {
    Shading::Phong => Shading::Phong, "Phong", "Tomczak 2012, 3.1 to 3.5",
        "Ambient, diffuse and Blinn's highlight.";
    Shading::Lambert => Shading::Lambert, "Lambert", "Munini 2021, 3.3",
        "The cosine law, albedo over pi, lights with inverse squares.";
    Shading::LambertLegacy => Shading::LambertLegacy, "Lambert as printed", "Munini 2021, 3.3",
        "(n . l) colour / 4 pi, without falloff.";
} }

choice! { Antialias {
    Antialias::Supersample { .. } => Antialias::Supersample { samples: 4, filter: Filter::Mitchell }, "Supersampling",
        "several rays a pixel", "Jittered rays, weighted by a filter.";
    Antialias::None => Antialias::None, "None", "one ray a pixel",
        "One ray through the middle of each pixel.";
} dials(this) {
    match this {
        Antialias::None => Vec::new(),
        Antialias::Supersample { samples, .. } => {
            vec![whole("Rays a pixel", "How many rays each pixel takes.", (1.0, 256.0), samples)]
        }
    }
} }

choice! { Filter {
    Filter::Mitchell => Filter::Mitchell, "Mitchell", "Mitchell and Netravali 1988",
        "Four pixels wide: sharp, with little ringing.";
    Filter::Tent => Filter::Tent, "Tent", "two pixels wide", "Falls off evenly: a little soft.";
    Filter::Box => Filter::Box, "Box", "one pixel wide", "Every ray of the pixel counts alike.";
} }

choice! { Plane {
    Plane::Colour => Plane::Colour, "Picture", "", "What a camera would see.";
    Plane::Steps => Plane::Steps, "Steps", "Munini 2021, fig. 12; Keinert 2014, fig. 9",
        "Evaluations of the field that each ray took.";
    Plane::Occlusion => Plane::Occlusion, "Ambient occlusion", "Tomczak 2012, fig. 3.11", "White where the sky is open.";
    Plane::Shadow => Plane::Shadow, "Shadow", "", "White where it is lit.";
    Plane::Normal => Plane::Normal, "Normals", "", "Which way the surface faces.";
    Plane::Depth => Plane::Depth, "Depth", "", "How far away the surface is.";
    Plane::Albedo => Plane::Albedo, "Albedo", "", "The colour of the material.";
    Plane::Residual => Plane::Residual, "Residual", "Keinert 2014, fig. 7", "How far from zero the field is at the hit.";
    Plane::Object => Plane::Object, "Objects", "", "Which object was hit.";
    Plane::Coverage => Plane::Coverage, "Coverage", "", "How much of the pixel a surface covers.";
} }

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;
    use zeroset_language::starlark::words;

    fn table<T: Choice + PartialEq + std::fmt::Debug>() {
        let names: HashSet<_> = T::methods().iter().map(|m| m.name).collect();
        assert_eq!(names.len(), T::methods().len(), "two have one name");
        for (i, method) in T::methods().iter().enumerate() {
            assert_eq!(method.make.place(), i, "{}", method.name);
            let is_plane = std::any::type_name::<T>().ends_with("Plane");
            assert!(is_plane || !method.source.is_empty(), "{}", method.name);
            assert!(
                method.about.ends_with('.') && method.about.len() < 75,
                "{}",
                method.about
            );
            let mut made = method.make;
            for dial in made.dials() {
                let value = match dial.number {
                    Number::Real(x) => *x,
                    Number::Whole(n) => *n as f32,
                    Number::Limit(x) => x.unwrap_or(dial.range.1),
                };
                assert!(
                    dial.range.0 <= value && value <= dial.range.1,
                    "{}",
                    dial.name
                );
                assert!(!dial.is_logarithmic || dial.range.0 > 0.0, "{}", dial.name);
                assert!(dial.about.ends_with('.'), "{}", dial.about);
            }
        }
    }

    #[test]
    fn every_method_is_where_it_says() {
        table::<March>();
        table::<Normals>();
        table::<Shadow>();
        table::<Occlusion>();
        table::<Shading>();
        table::<Antialias>();
        table::<Filter>();
        table::<Plane>();
        assert_eq!(Plane::methods().len(), Plane::ALL.len());
    }

    /// The scene language and the window offer the same methods.
    #[test]
    fn the_language_has_as_many() {
        let count = |group| words().iter().filter(|w| w.group == group).count();
        assert_eq!(count("Marching"), March::methods().len());
        // none() stands in another group
        assert_eq!(count("Shadows") + 1, Shadow::methods().len());
        assert_eq!(count("Ambient occlusion") + 1, Occlusion::methods().len());
    }
}
