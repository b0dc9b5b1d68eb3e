//! Cameras, colours and comparisons in double precision, written anew.

use glam::{DVec2, DVec3};
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::scene::Scene;

/// A renderer.
pub type Draw<'a> = &'a dyn Fn(&Scene) -> Film;

/// What a check found.
pub type Found = Result<(), String>;

/// Something that must hold on every renderer.
#[derive(Clone, Copy)]
pub struct Check {
    /// Its name.
    pub name: &'static str,
    /// Renders and compares.
    pub run: fn(Draw) -> Found,
}

/// Pixels of a picture.
pub const SIZE: [u32; 2] = [48, 36];

/// A camera, by what a scene file says of it.
#[derive(Clone, Copy)]
pub struct Eye {
    pub at: DVec3,
    pub target: DVec3,
    pub up: DVec3,
    pub lens: Lens,
    pub size: [u32; 2],
}

#[derive(Clone, Copy)]
pub enum Lens {
    /// Height of what it sees, degrees.
    Fov(f64),
    /// Height of what it sees, scene units.
    Height(f64),
}

/// Where a face is seen from, straight on: the axis towards the eye, and what is up.
pub const FACES: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
    // a plan: who stands in front of it sees what is far above what is near
    (DVec3::Y, DVec3::NEG_Z),
    // a ceiling, seen by who looks up
    (DVec3::NEG_Y, DVec3::Z),
];

impl Eye {
    /// Parallel rays onto what lies around `target`, from the side that `from` points to.
    pub fn straight(from: DVec3, up: DVec3, target: DVec3, height: f64) -> Eye {
        Eye {
            at: target + from * 8.0,
            target,
            up,
            lens: Lens::Height(height),
            size: SIZE,
        }
    }

    pub fn with_size(self, size: [u32; 2]) -> Eye {
        Eye { size, ..self }
    }

    /// Right, up, backwards.
    pub fn axes(&self) -> [DVec3; 3] {
        let back = (self.at - self.target).normalize();
        let right = self.up.cross(back).normalize();
        [right, back.cross(right), back]
    }

    /// Side of a pixel on the plane at distance 1, or anywhere.
    pub fn pixel(&self) -> f64 {
        let height = match self.lens {
            Lens::Fov(degrees) => 2.0 * (0.5 * degrees.to_radians()).tan(),
            Lens::Height(height) => height,
        };
        height / f64::from(self.size[1])
    }

    /// Right and down from the middle of the picture, in units of the plane.
    pub fn on_plane(&self, x: f64, y: f64) -> DVec2 {
        let [width, height] = self.size.map(f64::from);
        DVec2::new(x - 0.5 * width, y - 0.5 * height) * self.pixel()
    }

    /// Origin and direction of the ray through a place on the picture, in pixels from the top left corner.
    pub fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let [right, up, back] = self.axes();
        let q = self.on_plane(x, y);
        let aside = right * q.x - up * q.y;
        match self.lens {
            Lens::Fov(_) => (self.at, (aside - back).normalize()),
            Lens::Height(_) => (self.at + aside, -back),
        }
    }

    /// The line of a scene file.
    pub fn line(&self) -> String {
        let vector = |v: DVec3| format!("({}, {}, {})", v.x, v.y, v.z);
        let lens = match self.lens {
            Lens::Fov(degrees) => format!("fov = {degrees}"),
            Lens::Height(height) => format!("lens = orthographic({height})"),
        };
        let (at, target, up) = (vector(self.at), vector(self.target), vector(self.up));
        format!("camera(eye = {at}, target = {target}, up = {up}, {lens})\n")
    }

    /// The middles of all pixels: column, row, place.
    pub fn pixels(&self) -> impl Iterator<Item = (usize, usize, f64, f64)> + use<> {
        let [width, height] = self.size;
        let all = (0..height as usize).flat_map(move |y| (0..width as usize).map(move |x| (x, y)));
        all.map(|(x, y)| (x, y, x as f64 + 0.5, y as f64 + 0.5))
    }
}

/// A scene from the lines of its file, one ray through the middle of every pixel, hits as close to the surface as can be.
pub fn scene(text: &str, eye: &Eye) -> Scene {
    with(text, eye, "aa = none(), ao = none()")
}

/// A scene with other choices of rendering.
pub fn with(text: &str, eye: &Eye, choices: &str) -> Scene {
    let render = format!("render(footprint = 0.01, {choices})\n");
    let text = format!("{text}\n{}{render}", eye.line());
    loaded(&text, eye.size, None)
}

/// A scene from the whole text of its file.
pub fn loaded(text: &str, size: [u32; 2], folder: Option<&std::path::Path>) -> Scene {
    let options = Options {
        size: Some(size),
        ..Options::default()
    };
    load_text("known.star", text, Language::Starlark, folder, &options)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
        .scene
}

/// Linear light of an sRGB channel, 0 to 1 (IEC 61966-2-1).
pub fn linear(x: f64) -> f64 {
    if x <= 0.04045 {
        x / 12.92
    } else {
        ((x + 0.055) / 1.055).powf(2.4)
    }
}

/// Linear light of a colour as it is written.
pub fn light(srgb: [f64; 3]) -> DVec3 {
    DVec3::from(srgb.map(linear))
}

/// How a colour is written.
pub fn rgb([r, g, b]: [f64; 3]) -> String {
    format!("rgb({r}, {g}, {b})")
}

/// Numbers of a pixel in a plane; a single one three times.
pub fn value(film: &Film, plane: Plane, x: usize, y: usize) -> DVec3 {
    let at = y * film.width() as usize + x;
    let numbers = film.plane(plane);
    match plane.channels() {
        3 => DVec3::from_slice(&[0, 1, 2].map(|k| f64::from(numbers[3 * at + k]))),
        _ => DVec3::splat(f64::from(numbers[at])),
    }
}

/// Compares a plane with what is right, where that is known.
///
/// # Errors
/// How many pixels differ by more than the tolerance, and the first of them; or that hardly any pixel is compared.
pub fn compare(
    film: &Film,
    eye: &Eye,
    plane: Plane,
    tolerance: f64,
    right: impl Fn(f64, f64) -> Option<DVec3>,
) -> Found {
    let (mut compared, mut wrong, mut first) = (0, 0, None);
    for (x, y, u, v) in eye.pixels() {
        let Some(right) = right(u, v) else {
            continue;
        };
        compared += 1;
        let found = value(film, plane, x, y);
        // what is no number is wrong
        let off = (found - right).abs().max_element();
        if !(found.is_finite() && off <= tolerance) {
            wrong += 1;
            first.get_or_insert_with(|| {
                format!("at ({x}, {y}) {plane:?} is {found} instead of {right}")
            });
        }
    }
    let all = (eye.size[0] * eye.size[1]) as usize;
    match first {
        Some(first) => Err(format!("{wrong} of {compared} pixels differ: {first}")),
        None if compared * 20 < all => Err(format!("only {compared} of {all} pixels are compared")),
        None => Ok(()),
    }
}

/// Where a ray meets a ball first.
pub fn ball((o, d): (DVec3, DVec3), centre: DVec3, radius: f64) -> Option<f64> {
    let to = centre - o;
    let along = to.dot(d);
    let under = radius * radius - (to.length_squared() - along * along);
    let t = along - under.max(0.0).sqrt();
    (under > 0.0 && t > 0.0).then_some(t)
}

/// Where a ray meets the floor.
pub fn floor((o, d): (DVec3, DVec3)) -> Option<DVec3> {
    let t = -o.y / d.y;
    (d.y != 0.0 && t > 0.0).then(|| o + d * t)
}
