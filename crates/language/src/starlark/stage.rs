//! What is on stage: objects, the camera, lights, the sky.

use super::mistake::{Run, mistake};
use super::native::{Call, Given, Native, Slot, slot};
use super::spoken;
use super::value::{Thing, Value};
use crate::draft::{CameraDraft, FOV, Focus, MOMENTS, unit};
use crate::framing::axes_of;
use crate::images;
use glam::{DMat3, DQuat, DVec3, EulerRot, Vec3};
use zeroset_catalogue::{Dimension, LARGE, SMALL};
use zeroset_scene::environment::{Environment, STRENGTH as STRONGEST, Surroundings};
use zeroset_scene::light::{Fog, Light, Sky, Source};
use zeroset_scene::material::Material;
use zeroset_scene::scene::{self, Object};
use zeroset_scene::settings::Shadow;
use zeroset_scene::valid::LIGHTS;

const GROUP: &str = "Stage";

/// [`zeroset_scene::environment::TURBIDITY`] and [`zeroset_scene::valid::LAMP`], as people write them.
const TURBIDITY: (f64, f64) = (1.7, 10.0);
const LAMP: (f64, f64) = (1e-6, 1e6);

macro_rules! function {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native { name: $name, doc: $doc, group: GROUP, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run }
    };
}

const COLOR: Slot = slot("color", "\"white\"", "Its colour.");
const STRENGTH: Slot = slot("strength", "1", "How strong it is.");
const SHADOW: Slot = slot(
    "shadow",
    "soft_closest()",
    "How its shadow is found: a method of the group Shadows, or none().",
);

const NEAR_STRENGTH: Slot = slot(
    "strength",
    "10",
    "What a white surface shows that faces it at a distance of 1, if all of it were at its middle.",
);
const LAMP_SHADOW: Slot = slot(
    "shadow",
    "hard()",
    "none() for none; all others are as soft as the lamp is wide, by one ray to it from each surface.",
);
const VISIBLE: Slot = slot("visible", "True", "Whether it is seen, in mirrors too.");

/// The functions.
pub(crate) const ALL: &[Native] = &[
    function!(
        "show",
        "Puts an object on stage: a field with a material.",
        [
            slot("field", "", "What is shown, a solid."),
            slot(
                "material",
                "material()",
                "A material, a pattern or a colour."
            ),
            slot("name", "its number", "What it is called."),
            slot(
                "ao",
                "that of render()",
                "An ambient occlusion method of its own."
            )
        ],
        show
    ),
    function!(
        "camera",
        "Where it is seen from. What is left out follows from what is to be seen.",
        [
            slot("eye", "framed", "Where the camera stands, (x, y, z)."),
            slot("target", "the middle", "Where it looks."),
            slot("up", "\"y\"", "Which way is up."),
            slot("fov", "40", "Height of what it sees, degrees, 1 to 170."),
            slot(
                "direction",
                "(0.51, -0.48, -1)",
                "Which way it looks, in place of an eye."
            ),
            slot(
                "turn",
                "None",
                "Its orientation: degrees about x, y, z, or a quaternion (x, y, z, w)."
            ),
            slot(
                "lens",
                "perspective",
                "orthographic(height) for parallel rays."
            ),
            slot("near", "0", "Where rays begin, scene units."),
            slot("far", "1000 or more", "Where rays end, scene units."),
            slot(
                "aperture",
                "0",
                "Radius of the lens, scene units: what is out of focus is blurred, with several rays a pixel."
            ),
            slot(
                "focus",
                "the target",
                "What is sharp then: a distance along the way it looks, or a point (x, y, z)."
            ),
            slot(
                "shutter",
                "0",
                "Seconds of time() that the shutter is open, from the picture's own time on: what moves is blurred."
            ),
            slot(
                "moments",
                "32",
                "Moments of that time, 1 to 1024: each ray of a pixel sees one of them."
            )
        ],
        camera
    ),
    function!(
        "orthographic",
        "A lens with parallel rays.",
        [slot("height", "", "Height of what it sees, scene units.")],
        |c| {
            let given = c.need("height")?;
            let height = c.ranged("height", given, SMALL, LARGE)?;
            c.machine.thing(Thing::Orthographic(height))
        }
    ),
    function!(
        "sun",
        "Light from far away.",
        [
            slot("direction", "(0.6, -1, -0.5)", "The way the light travels."),
            COLOR,
            STRENGTH,
            SHADOW
        ],
        |c| {
            let direction = c
                .get("direction")
                .map_or(Ok([0.6, -1.0, -0.5]), |g| c.direction("direction", g))?;
            let direction = unit(direction).as_vec3();
            light(c, Source::Directional { direction })
        }
    ),
    function!(
        "point_light",
        "Light from a point; it falls off with the square of the distance.",
        [
            slot("position", "", "Where, (x, y, z)."),
            COLOR,
            slot("strength", "10", "How strong it is at a distance of 1."),
            SHADOW
        ],
        |c| {
            let given = c.need("position")?;
            let position = c.point("position", given)?.as_vec3();
            light(c, Source::Point { position })
        }
    ),
    function!(
        "rectangle_light",
        "A lamp that is a rectangle, such as a window or a soft box. It shines from its front and is no body.",
        [
            slot("position", "", "Its middle, (x, y, z)."),
            slot("target", "None", "What it faces, a point."),
            slot(
                "direction",
                "(0, -1, 0)",
                "The way it faces, in place of a target."
            ),
            slot(
                "size",
                "1",
                "Width and height, or one for both, scene units."
            ),
            slot("up", "\"y\"", "Which way its height goes."),
            COLOR,
            NEAR_STRENGTH,
            LAMP_SHADOW,
            VISIBLE
        ],
        rectangle_light
    ),
    function!(
        "disc_light",
        "A lamp that is a disc. It shines from its front and is no body.",
        [
            slot("position", "", "Its middle, (x, y, z)."),
            slot("target", "None", "What it faces, a point."),
            slot(
                "direction",
                "(0, -1, 0)",
                "The way it faces, in place of a target."
            ),
            slot("radius", "0.5", "Its radius, scene units."),
            COLOR,
            NEAR_STRENGTH,
            LAMP_SHADOW,
            VISIBLE
        ],
        |c| {
            let given = c.need("position")?;
            let position = c.point("position", given)?;
            let direction = facing(c, position)?.as_vec3();
            let source = Source::Disc {
                position: position.as_vec3(),
                direction,
                radius: radius(c)?,
                visible: c.flag_or("visible", true)?,
            };
            light(c, source)
        }
    ),
    function!(
        "sphere_light",
        "A lamp that is a sphere. It shines all around and is no body.",
        [
            slot("position", "", "Its middle, (x, y, z)."),
            slot("radius", "0.5", "Its radius, scene units."),
            COLOR,
            NEAR_STRENGTH,
            LAMP_SHADOW,
            VISIBLE
        ],
        |c| {
            let given = c.need("position")?;
            let source = Source::Sphere {
                position: c.point("position", given)?.as_vec3(),
                radius: radius(c)?,
                visible: c.flag_or("visible", true)?,
            };
            light(c, source)
        }
    ),
    function!(
        "sky",
        "What is behind everything, and lights it from everywhere.",
        [
            slot("top", "a clear blue", "Colour straight up."),
            slot("horizon", "between top and white", "Colour at the horizon."),
            slot("bottom", "a third of the horizon", "Colour straight down."),
            slot(
                "ambient",
                "0.5",
                "How much of its light reaches a surface, 0 to 10."
            ),
            slot("color", "None", "One colour for all three."),
            slot(
                "sun",
                "0",
                "Degrees across of the disc of the first sun(), 0 to 180; the real one has 0.53."
            ),
            slot(
                "image",
                "None",
                "An equirectangular image of all directions in place of colours: .hdr, .png or .jpg in the scene's folder."
            ),
            slot(
                "turbidity",
                "None",
                "The clear sky of a day in place of colours, around the first sun(): 1.7 to 10, 2 clear, 10 hazy."
            ),
            slot(
                "ground",
                "\"#6b6660\"",
                "Colour of the ground below such a sky."
            ),
            slot(
                "strength",
                "1",
                "What the light of an image or of such a sky is multiplied by."
            ),
            slot(
                "turn",
                "0",
                "Degrees that an image is turned about the vertical; without, its middle is seen along -z."
            )
        ],
        sky
    ),
    function!(
        "fog",
        "Fog, everywhere or near the ground.",
        [
            slot("color", "that of the horizon", "Its colour."),
            slot(
                "density",
                "0.05",
                "What it takes of the light over a scene unit: 0.05 leaves a third after 20."
            ),
            slot(
                "height",
                "None",
                "How far up a third of it is left; the same everywhere without."
            ),
            slot("base", "0", "Height at which it has its density."),
            slot(
                "glow",
                "0",
                "How much it glows towards the first sun(), 0 to 10."
            )
        ],
        fog
    ),
];

impl Call<'_, '_> {
    /// A point of space.
    pub(crate) fn point(&self, param: &str, given: Given) -> Run<DVec3> {
        let p: [f64; 3] = self.numbers(param, given)?;
        for x in p {
            self.ranged(
                param,
                Given {
                    value: Value::Float(x),
                    ..given
                },
                -LARGE,
                LARGE,
            )?;
        }
        Ok(DVec3::from(p))
    }

    /// States something that a scene has once.
    pub(crate) fn once(&mut self, what: &'static str) -> Run<()> {
        let Some(first) = self.machine.draft.stated.insert(what, self.place) else {
            return Ok(());
        };
        let source = self.machine.draft.sources.get(first.file as usize);
        let whereabouts = source.map_or(String::new(), |s| {
            let (line, _) = s.position(first.start as usize);
            format!(" in {} at line {line}", s.name)
        });
        Err(mistake(format!("{what} is stated already{whereabouts}"))
            .help("leave one of the two out"))
    }
}

fn show(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("field")?;
    let field = c.field("field", given)?;
    if field.facts().dimension == Dimension::Two {
        let m = mistake("a plane shape has no surface to show").at(given.place);
        return Err(m.help("make a solid of it: show(shape.extrude(1))"));
    }
    if field.facts().nodes > c.machine.limits.nodes {
        let message = format!(
            "this field has {} nodes (a shape used twice counts twice), at most {} are allowed",
            field.facts().nodes,
            c.machine.limits.nodes
        );
        let help = "use .repeat(...) or .polar(...) for many copies, or raise the limit `nodes`";
        return Err(mistake(message).help(help).at(given.place));
    }
    let limit = c.machine.limits.objects.min(u64::from(u16::MAX));
    let count = c.machine.draft.objects.len();
    if count as u64 >= limit {
        let help = "join shapes with union([...]) and show them as one";
        return Err(mistake(format!("more than {limit} objects")).help(help));
    }
    let material = match c.get("material") {
        Some(given) => c.material("material", given)?,
        None => Material::default().into(),
    };
    if c.get("material").is_none() && field.facts().materials == 0 {
        c.machine.draft.plain.push(count);
    }
    let material = c
        .machine
        .draft
        .number(&material)
        .ok_or_else(|| mistake("the scene has too many materials"))?;
    let name = match c.get("name") {
        Some(given) => {
            let name = c.text("name", given)?.to_string();
            let fits = c.machine.limits.check_name(&name);
            fits.map_err(|m| mistake(m).at(given.place))?;
            name
        }
        None => (count + 1).to_string(),
    };
    let occlusion = (c.get("ao").map(|_| c.method(Thing::occlusion))).transpose()?;
    let place = c.machine.draft.position(c.place);
    c.machine.grow(512 + name.len())?;
    c.machine.draft.objects.push(Object {
        name,
        field,
        material,
        occlusion,
        place,
    });
    Ok(Value::None)
}

fn camera(c: &mut Call<'_, '_>) -> Run<Value> {
    c.once("the camera")?;
    let point = |name| c.get(name).map(|g| c.point(name, g)).transpose();
    let direction = |name| {
        c.get(name)
            .map(|g| c.direction(name, g).map(unit))
            .transpose()
    };
    let turn = c.get("turn").map(|g| orientation(c, g)).transpose()?;
    let height = match c.get("lens") {
        None => None,
        Some(given) => match given.value {
            Value::Thing(i) => match c.machine.store.thing(i) {
                Thing::Orthographic(height) => Some(*height),
                _ => return Err(c.unfit("lens", "orthographic(height)", given)),
            },
            _ => return Err(c.unfit("lens", "orthographic(height)", given)),
        },
    };
    let far = c
        .get("far")
        .map(|g| c.ranged("far", g, SMALL, 1e3 * LARGE))
        .transpose()?;
    let view = CameraDraft {
        eye: point("eye")?,
        target: point("target")?,
        up: direction("up")?.unwrap_or(DVec3::Y),
        direction: direction("direction")?,
        axes: turn,
        fov: c.number_or("fov", FOV, 1.0, 170.0)?.to_radians(),
        height,
        near: c.number_or("near", 0.0, 0.0, 1e9)?,
        far,
        aperture: c.number_or("aperture", 0.0, 0.0, LARGE)?,
        focus: c.get("focus").map(|g| focus(c, g)).transpose()?,
        shutter: c.number_or("shutter", 0.0, 0.0, LARGE)?,
        moments: c.count_or("moments", MOMENTS, 1, scene::MOMENTS)?,
    };
    let names = [
        ("turn", view.axes.is_some()),
        ("direction", view.direction.is_some()),
        ("eye and target", both(&view)),
    ];
    let stated: Vec<&str> = names.iter().filter(|n| n.1).map(|n| n.0).collect();
    if let [first, second, ..] = stated[..] {
        let m = mistake(format!(
            "`{first}` and `{second}` both say which way the camera looks"
        ));
        return Err(m.help("leave one of them out"));
    }
    if view.eye.is_some() && view.eye == view.target {
        return Err(mistake(
            "the camera stands where it looks: `eye` and `target` must differ",
        ));
    }
    if far.is_some_and(|far| far <= view.near) {
        return Err(mistake("`near` must be less than `far`"));
    }
    let axes = view.direction.map(|d| axes_of(-d, view.up));
    if axes == Some(None) {
        return Err(mistake("`direction` of camera() points nowhere"));
    }
    c.machine.draft.view = Some(view);
    Ok(Value::None)
}

fn both(view: &CameraDraft) -> bool {
    view.eye.is_some() && view.target.is_some()
}

/// A distance, or a point.
fn focus(c: &Call<'_, '_>, given: Given) -> Run<Focus> {
    if c.machine.store.items(given.value).is_some() {
        return c.point("focus", given).map(Focus::Point);
    }
    c.ranged("focus", given, SMALL, LARGE).map(Focus::Distance)
}

/// Columns right, up, backwards from degrees about x, y and z, or from a quaternion.
fn orientation(c: &Call<'_, '_>, given: Given) -> Run<DMat3> {
    if c.machine
        .store
        .items(given.value)
        .is_some_and(|items| items.len() == 4)
    {
        let q = DQuat::from_array(c.numbers("turn", given)?);
        if q.length_squared() < 1e-30 {
            return Err(
                mistake("`turn` of camera() is (0, 0, 0, 0), which turns nothing").at(given.place),
            );
        }
        return Ok(DMat3::from_quat(q.normalize()));
    }
    let [x, y, z]: [f64; 3] = c.numbers("turn", given)?;
    // about x, then y, then z, as .turn(...) of a field does
    Ok(DMat3::from_euler(
        EulerRot::ZYX,
        z.to_radians(),
        y.to_radians(),
        x.to_radians(),
    ))
}

/// The radius of a lamp.
fn radius(c: &Call<'_, '_>) -> Run<f32> {
    let (least, most) = LAMP;
    let radius = c.number_or("radius", 0.5, least, most)?;
    Ok(radius as f32)
}

/// The way a lamp faces that stands at a place.
fn facing(c: &Call<'_, '_>, position: DVec3) -> Run<DVec3> {
    let target = match c
        .get("target")
        .filter(|given| !matches!(given.value, Value::None))
    {
        Some(given) => given,
        None => {
            let direction = c.get("direction").map(|g| c.direction("direction", g));
            return Ok(unit(direction.unwrap_or(Ok([0.0, -1.0, 0.0]))?));
        }
    };
    if c.get("direction").is_some() {
        let m = mistake("`target` and `direction` both say which way the lamp faces");
        return Err(m.help("leave one of them out").at(target.place));
    }
    let to = c.point("target", target)? - position;
    if to.length_squared() > 0.0 {
        return Ok(unit(to.to_array()));
    }
    Err(
        mistake("the lamp stands where it faces: `position` and `target` must differ")
            .at(target.place),
    )
}

fn rectangle_light(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("position")?;
    let position = c.point("position", given)?;
    let front = facing(c, position)?;
    let size: [f64; 2] = match c.get("size") {
        None => [1.0; 2],
        Some(given) if c.machine.store.items(given.value).is_none() => {
            [c.number("size", given)?; 2]
        }
        Some(given) => c.numbers("size", given)?,
    };
    let (least, most) = LAMP;
    for side in size {
        let half = 0.5 * side;
        if !(least <= half && half <= most) {
            let m = mistake(format!(
                "`size` of rectangle_light() is {}, allowed is {} to {}",
                spoken(side),
                spoken(2.0 * least),
                spoken(2.0 * most)
            ));
            return Err(match c.get("size") {
                Some(given) => m.at(given.place),
                None => m,
            });
        }
    }
    let up = c.get("up").map(|g| c.direction("up", g).map(unit));
    // seen by who looks at its front, `right` goes to the right: `right x up` is the front
    let axes = axes_of(front, up.unwrap_or(Ok(DVec3::Y))?);
    let Some(axes) = axes else {
        return Err(mistake("`direction` of rectangle_light() points nowhere"));
    };
    let source = Source::Rectangle {
        position: position.as_vec3(),
        right: (axes.x_axis * (0.5 * size[0])).as_vec3(),
        up: (axes.y_axis * (0.5 * size[1])).as_vec3(),
        visible: c.flag_or("visible", true)?,
    };
    light(c, source)
}

fn light(c: &mut Call<'_, '_>, source: Source) -> Run<Value> {
    let strength = if source.is_near() { 10.0 } else { 1.0 };
    let strength = c.number_or("strength", strength, 0.0, 1e6)? as f32;
    let shadow = match c.get("shadow") {
        None if source.is_lamp() => Shadow::Hard,
        _ => c.method(Thing::shadow)?,
    };
    let radiance = c.colour_or("color", "white")? * strength;
    let lights = c.machine.draft.lights.get_or_insert_default();
    if lights.len() >= LIGHTS {
        return Err(mistake(format!("more than {LIGHTS} lights")));
    }
    lights.push(Light {
        source,
        radiance,
        shadow,
    });
    Ok(Value::None)
}

fn sky(c: &mut Call<'_, '_>) -> Run<Value> {
    c.once("the sky")?;
    let environment = environment(c)?;
    let usual = match environment {
        Some(_) => 1.0,
        None => f64::from(Sky::default().ambient),
    };
    let coloured = ["color", "top", "horizon", "bottom"].map(|name| c.get(name));
    if let (Some(_), Some(given)) = (&environment, coloured.into_iter().flatten().next()) {
        let m = mistake("an image or a clear sky has its own colours").at(given.place);
        return Err(m.help("leave the colours of sky() out, or `image` and `turbidity`"));
    }
    c.machine.draft.environment = environment;
    let default = Sky::default();
    let colour = |name| c.get(name).map(|g| c.colour(name, g)).transpose();
    let (one, top) = (colour("color")?, colour("top")?);
    let top = top.or(one);
    // a sky is brighter where there is more air
    let horizon = colour("horizon")?
        .or(one)
        .or(top.map(|t| t.lerp(Vec3::ONE, 0.5)));
    let sky = Sky {
        top: top.unwrap_or(default.top),
        horizon: horizon.unwrap_or(default.horizon),
        // the ground that nobody modelled, in the same light
        bottom: colour("bottom")?
            .or(one)
            .or(horizon.map(|h| h / 3.0))
            .unwrap_or(default.bottom),
        ambient: c.number_or("ambient", usual, 0.0, 10.0)? as f32,
        sun: c.number_or("sun", 0.0, 0.0, 180.0)?.to_radians() as f32,
        fog: None,
    };
    c.machine.draft.sky = Some(sky);
    Ok(Value::None)
}

/// What sky() says of an image or of a clear sky.
fn environment(c: &mut Call<'_, '_>) -> Run<Option<Environment>> {
    let stated = |name| {
        c.get(name)
            .filter(|given| !matches!(given.value, Value::None))
    };
    let source = match (stated("image"), stated("turbidity")) {
        (None, None) => {
            let only = ["ground", "strength", "turn"].into_iter().find_map(|name| {
                let given = c.get(name)?;
                Some((name, given))
            });
            let Some((name, given)) = only else {
                return Ok(None);
            };
            let m = mistake(format!(
                "`{name}` of sky() is of an image or of a clear sky"
            ));
            return Err(m.at(given.place).help("state `image` or `turbidity` too"));
        }
        (Some(_), Some(given)) => {
            let m = mistake("`image` and `turbidity` both say what the sky looks like");
            return Err(m.help("leave one of them out").at(given.place));
        }
        (Some(given), None) => {
            let name = c.text("image", given)?.to_string();
            let limits = c.machine.limits;
            let image = images::load(&mut c.machine.draft.files, &name, &limits)
                .map_err(|m| mistake(m).at(given.place))?;
            Surroundings::Image { image }
        }
        (None, Some(given)) => {
            let (least, most) = TURBIDITY;
            let turbidity = c.ranged("turbidity", given, least, most)?;
            Surroundings::Clear {
                turbidity: turbidity as f32,
                ground: c.colour_or("ground", "#6b6660")?,
            }
        }
    };
    Ok(Some(Environment {
        source,
        strength: c.number_or("strength", 1.0, 0.0, f64::from(STRONGEST))? as f32,
        turn: c.number_or("turn", 0.0, -3600.0, 3600.0)?.to_radians() as f32,
    }))
}

fn fog(c: &mut Call<'_, '_>) -> Run<Value> {
    c.once("the fog")?;
    let default = Fog::default();
    let height = match c
        .get("height")
        .filter(|given| !matches!(given.value, Value::None))
    {
        Some(given) => Some(c.ranged("height", given, SMALL, LARGE)? as f32),
        None => None,
    };
    let fog = Fog {
        colour: c.get("color").map(|g| c.colour("color", g)).transpose()?,
        density: c.number_or("density", f64::from(default.density), 0.0, 1e6)? as f32,
        height,
        base: c.number_or("base", f64::from(default.base), -LARGE, LARGE)? as f32,
        glow: c.number_or("glow", f64::from(default.glow), 0.0, 10.0)? as f32,
    };
    c.machine.draft.fog = Some(fog);
    Ok(Value::None)
}
