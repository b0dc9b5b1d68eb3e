//! What lies all around a scene: an image of all directions, or the sky of a clear day.

use crate::camera::degrees_of;
use crate::material::Image;
use glam::Vec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

/// Light from everywhere, in place of the colours of [`Sky`](crate::light::Sky).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Where it comes from.
    pub source: Surroundings,
    /// What its light is multiplied by.
    pub strength: f32,
    /// How far it is turned about the vertical, from z to x, radians. In files it is in degrees.
    #[serde(
        default,
        serialize_with = "write_degrees",
        deserialize_with = "read_degrees"
    )]
    pub turn: f32,
}

fn write_degrees<S: Serializer>(radians: &f32, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_f64(degrees_of(*radians))
}

fn read_degrees<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    f64::deserialize(from).map(|degrees| degrees.to_radians() as f32)
}

/// Where the light of an environment comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Surroundings {
    /// An equirectangular image: the middle is what a camera sees that is not turned, along -z, the upper edge what is straight up.
    Image {
        /// The image.
        image: Arc<Image>,
    },
    /// The clear sky of a day whose sun is the first directional light (Preetham, Shirley and Smits 1999).
    Clear {
        /// How hazy the air is: 2 a clear day, 10 a hazy one.
        turbidity: f32,
        /// The linear colour of the ground: what of the sky's light it sends back.
        ground: Vec3,
    },
}

/// Least and largest turbidity.
pub const TURBIDITY: (f32, f32) = (1.7, 10.0);
/// Most that an environment's light is multiplied by.
pub const STRENGTH: f32 = 1e6;
