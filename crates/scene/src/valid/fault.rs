//! What is wrong with a scene, and where.

use super::{OBJECTS, PIXELS};
use crate::methods::Refused;
use glam::Vec3;
use std::fmt;

/// A step from a scene to a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathStep {
    /// To a member, by its name in scene files.
    Key(&'static str),
    /// To an item of a list, from 0.
    Index(usize),
}

/// What is wrong with a scene: where, what was given, what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{fault}", place(.path))]
pub struct SceneError {
    path: Vec<PathStep>,
    fault: Fault,
}

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A number of a method or of the settings that their registry refuses.
    #[error("this {0}")]
    Method(Refused),
    /// A number out of its range, or none at all.
    #[error("this is {}, allowed is {} to {}", Said(*.value), Said(*.min), Said(*.max))]
    Number {
        /// What was given.
        value: f32,
        /// Smallest allowed.
        min: f32,
        /// Largest allowed.
        max: f32,
    },
    /// A whole number out of its range.
    #[error("this is {value}, allowed is {min} to {max}")]
    Count {
        /// What was given.
        value: u32,
        /// Smallest allowed.
        min: u32,
        /// Largest allowed.
        max: u32,
    },
    /// A field of view that no picture shows.
    #[error("this is {degrees} degrees, allowed is 1 to 170")]
    FieldOfView {
        /// What was given.
        degrees: f64,
    },
    /// A direction that is not normalised.
    #[error("this must be a direction of length 1")]
    Direction {
        /// What was given.
        value: Vec3,
    },
    /// Sides of a rectangle that are not at right angles.
    #[error("`right` and `up` must be at right angles to each other")]
    RightAngles,
    /// Axes of a camera that are not orthonormal.
    #[error("the axes must have length 1 and be at right angles to each other")]
    Axes,
    /// A camera that sees no distance.
    #[error("`near` must be below `far`")]
    Range,
    /// A gradient without a way.
    #[error("`from` and `to` must differ")]
    Points,
    /// A number of a material that is not in the scene's list.
    #[error("there is no material {number}")]
    Material {
        /// What was given, from 0.
        number: u16,
        /// How many there are.
        count: usize,
    },
    /// A plane shape among solids.
    #[error("a plane shape has no surface to show")]
    Plane,
    /// Too many objects.
    #[error("more than {OBJECTS} objects")]
    Objects {
        /// How many.
        given: usize,
    },
    /// Too many of something.
    #[error("{given} {what}, at most {most} are allowed")]
    Many {
        /// Of what.
        what: &'static str,
        /// How many.
        given: usize,
        /// How many are allowed.
        most: usize,
    },
    /// A picture without pixels, or with more than can be counted.
    #[error(
        "a picture of {width}x{height} pixels: width and height must be at least 1, and at most {PIXELS} pixels are allowed"
    )]
    Size {
        /// Pixels from left to right.
        width: u32,
        /// Pixels from top to bottom.
        height: u32,
    },
    /// An image without pixels, or with others than its size says.
    #[error("an image of {width}x{height} pixels with {pixels} of them")]
    Image {
        /// Pixels from left to right.
        width: u32,
        /// Pixels from top to bottom.
        height: u32,
        /// How many it has.
        pixels: usize,
    },
}

impl SceneError {
    pub(super) fn new(fault: Fault) -> SceneError {
        let path = Vec::new();
        SceneError { path, fault }
    }

    /// Inside of a member.
    pub(crate) fn at(mut self, key: &'static str) -> SceneError {
        self.path.insert(0, PathStep::Key(key));
        self
    }

    /// Inside of an item of a list.
    pub(super) fn index(mut self, index: usize) -> SceneError {
        self.path.insert(0, PathStep::Index(index));
        self
    }

    /// The way from what was checked to what is wrong, with the names of scene files: `objects[2].material`. A fault of
    /// several members together, such as `near` and `far`, has the way to what holds them.
    pub fn path(&self) -> &[PathStep] {
        &self.path
    }

    /// What is wrong there.
    pub fn fault(&self) -> &Fault {
        &self.fault
    }
}

/// A path for people, with what comes between it and the message.
fn place(path: &[PathStep]) -> String {
    let mut text = String::new();
    for step in path {
        match step {
            PathStep::Key(key) if text.is_empty() => text += key,
            PathStep::Key(key) => text += &format!(".{key}"),
            PathStep::Index(i) => text += &format!("[{i}]"),
        }
    }
    if !text.is_empty() {
        text += ": ";
    }
    text
}

/// A number for people.
struct Said(f32);

impl fmt::Display for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x = self.0;
        if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
            write!(f, "{x}")
        } else {
            write!(f, "{x:e}")
        }
    }
}
