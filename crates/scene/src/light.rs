//! Lights and the sky.

use crate::camera::degrees_of;
use crate::settings::Shadow;
use glam::Vec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Source {
    /// From infinitely far, along `direction` (normalised, the way the light travels).
    Directional {
        /// The way the light travels.
        direction: Vec3,
    },
    /// From a point, with inverse-square falloff relative to a distance of 1.
    Point {
        /// Where.
        position: Vec3,
    },
    /// From a rectangle, to the side of `right x up`, evenly over it. It is no body: rays go on through it.
    Rectangle {
        /// Its middle.
        position: Vec3,
        /// From there to the middle of its right edge.
        right: Vec3,
        /// From there to the middle of its upper edge, at right angles to `right`.
        up: Vec3,
        /// Whether it is seen, in mirrors too.
        #[serde(default = "yes")]
        visible: bool,
    },
    /// From a disc, evenly over it. It is no body: rays go on through it.
    Disc {
        /// Its middle.
        position: Vec3,
        /// The way it faces (normalised).
        direction: Vec3,
        /// Its radius.
        radius: f32,
        /// Whether it is seen, in mirrors too.
        #[serde(default = "yes")]
        visible: bool,
    },
    /// From a sphere, outwards, evenly over it. It is no body: rays go on through it.
    Sphere {
        /// Its middle.
        position: Vec3,
        /// Its radius.
        radius: f32,
        /// Whether it is seen, in mirrors too.
        #[serde(default = "yes")]
        visible: bool,
    },
}

fn yes() -> bool {
    true
}

impl Source {
    /// Whether it is at a place: a strength is then what a white surface shows that faces it at a distance of 1 (where it is small).
    pub fn is_near(&self) -> bool {
        !matches!(self, Source::Directional { .. })
    }

    /// Whether it has an extent.
    pub fn is_lamp(&self) -> bool {
        self.is_near() && !matches!(self, Source::Point { .. })
    }
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Where it comes from.
    pub source: Source,
    /// Linear colour times intensity; of a source with an extent that at a distance of 1, as if it were a point.
    pub radiance: Vec3,
    /// Its shadow. Those of sources with an extent are sampled, or none.
    pub shadow: Shadow,
}

impl Light {
    /// The sun: light from infinitely far that travels along `direction`, which is normalised here, with a hard shadow. `radiance` is
    /// its linear colour times its intensity.
    pub fn sun(direction: Vec3, radiance: Vec3) -> Light {
        Light {
            source: Source::Directional {
                direction: direction.normalize_or_zero(),
            },
            radiance,
            shadow: Shadow::Hard,
        }
    }
}

/// What rays see that hit nothing, and what lights the scene from everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sky {
    /// Linear colour straight up.
    pub top: Vec3,
    /// Linear colour at the horizon.
    pub horizon: Vec3,
    /// Linear colour straight down.
    pub bottom: Vec3,
    /// Share of the sky's light that reaches an unoccluded surface from everywhere.
    pub ambient: f32,
    /// Angle under which the disc of the sun is seen, radians; 0 for none. (The real one: 0.0093.) The sun is the first directional light.
    /// In files it is in degrees.
    #[serde(serialize_with = "write_degrees", deserialize_with = "read_degrees")]
    pub sun: f32,
    /// Fog, where there is any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog: Option<Fog>,
}

fn write_degrees<S: Serializer>(radians: &f32, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_f64(degrees_of(*radians))
}

fn read_degrees<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    f64::deserialize(from).map(|degrees| degrees.to_radians() as f32)
}

/// Fog: it takes light, and sends its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Fog {
    /// Its linear colour; that of the horizon where it is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour: Option<Vec3>,
    /// The share of light that it takes over a small length, by that length, at the height `base`.
    pub density: f32,
    /// How far up there is e times less of it; the same everywhere where it is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f32>,
    /// Where it has its density.
    pub base: f32,
    /// How much it shows of the sun, 0 to 10.
    pub glow: f32,
}

impl Default for Fog {
    fn default() -> Self {
        Fog {
            colour: None,
            density: 0.05,
            height: None,
            base: 0.0,
            glow: 0.0,
        }
    }
}

impl Default for Sky {
    fn default() -> Self {
        Sky {
            top: Vec3::new(0.44, 0.57, 0.77),
            horizon: Vec3::new(0.80, 0.86, 0.92),
            bottom: Vec3::new(0.30, 0.29, 0.28),
            ambient: 0.5,
            sun: 0.0,
            fog: None,
        }
    }
}

/// How wide the haze is in which the colour of the horizon goes over into those above and below: the square of the height of a direction
/// (the sine of its angle) at which about half of it is left.
pub const HAZE: f32 = 0.1225;

impl Sky {
    /// Linear colour seen along a normalised direction: smooth from bottom over horizon to top.
    pub fn colour(&self, direction: Vec3) -> Vec3 {
        let square = (direction.y * direction.y).min(1.0);
        let end = if direction.y < 0.0 {
            self.bottom
        } else {
            self.top
        };
        self.horizon
            .lerp(end, square * (1.0 + HAZE) / (square + HAZE))
    }
}
