//! Shapes as they are written in Rust: functions make them, methods change them, operators join them.
//!
//! ```
//! use glam::vec3;
//! use zeroset_field::shape::{box3, cylinder, sphere};
//!
//! let ball = sphere(1.0).translate(vec3(0.0, 1.0, 0.0));
//! let hole = cylinder(0.3, 4.0).rotate_x(90f64.to_radians());
//! let shape = (ball | box3([2.0, 0.2, 2.0])).round(0.05) - hole;
//!
//! let field = shape.field()?;
//! assert!(field.facts().bounds.max[1] >= 2.0);
//! # Ok::<(), zeroset_field::field::FieldError>(())
//! ```
//!
//! | | |
//! | --- | --- |
//! | `a \| b` | union |
//! | `a & b` | intersection |
//! | `a - b` | what of a is not in b |
//! | `a ^ b` | what is in one of both |
//! | `!a` | everything but a |
//!
//! Every entry of the catalogue is here under its name in the scene language (`box` is a word of Rust, so it is [`box3`]): shapes are
//! functions, maps and modifiers are methods, joins are both: `a.smooth_union(b, 0.2)` joins two,
//! [`smooth_union`]`([a, b, c], 0.2)` any number. Lengths are scene units, angles radians, shapes centred on the origin with y up, as
//! in scene files. Vectors may be arrays, tuples, or vectors of glam of either precision.
//!
//! **Errors.** Nothing here fails or panics on the way: a number out of its range, a plane shape where a solid is needed, and
//! whatever else cannot be is kept, through all that is made of it, and [`Shape::field`] gives the first of it.
//!
//! ```
//! use zeroset_field::field::FieldError;
//! use zeroset_field::shape::{circle, sphere};
//!
//! let error = (sphere(-1.0).onion(0.1) | sphere(2.0)).field().unwrap_err();
//! assert!(matches!(error, FieldError::Range { entry: "sphere", param: "radius", .. }));
//!
//! let error = (sphere(1.0) | circle(1.0)).field().unwrap_err();
//! assert!(matches!(error, FieldError::Dimension { .. }));
//! ```

#[rustfmt::skip]
mod entries;

pub use entries::*;

use crate::field::{Field, FieldError, Node, Paint};
use crate::placement::Placement;
use crate::repetition::{Polar, Repetition};
use glam::{DQuat, DVec2, DVec3};
use std::ops::{BitAnd, BitOr, BitXor, Not, Sub};
use zeroset_catalogue::entries::catalogue;

/// A field, or the first thing that was wrong when it was made. Cheap to clone, and a clone is the same shape: it is evaluated once
/// where it stands twice at the same place.
#[derive(Clone, Debug)]
#[must_use = "a shape does nothing until its field is used"]
pub struct Shape(Result<Field, FieldError>);

impl Shape {
    /// The field that was made.
    ///
    /// # Errors
    /// The first thing that was wrong: a number out of its range, numbers or shapes that do not fit each other, a plane shape where a
    /// solid is needed, a tree too deep.
    pub fn field(&self) -> Result<Field, FieldError> {
        self.0.clone()
    }

    /// Changes the field, if there is one.
    fn then(&self, change: impl FnOnce(&Field) -> Result<Field, FieldError>) -> Shape {
        Shape(self.0.as_ref().map_err(Clone::clone).and_then(change))
    }

    /// Moved, scene units.
    pub fn translate(&self, offset: impl Into<DVec3>) -> Shape {
        self.place(Placement::moved(offset.into().to_array()))
    }

    /// Turned about an axis through the origin, by radians, counter-clockwise where the axis points at you. An axis of length 0 turns
    /// nothing.
    pub fn rotate(&self, axis: impl Into<DVec3>, angle: impl Into<f64>) -> Shape {
        self.place(Placement::turned(axis.into().to_array(), angle.into()))
    }

    /// Turned about the x axis, radians.
    pub fn rotate_x(&self, angle: impl Into<f64>) -> Shape {
        self.rotate(DVec3::X, angle)
    }

    /// Turned about the y axis, radians.
    pub fn rotate_y(&self, angle: impl Into<f64>) -> Shape {
        self.rotate(DVec3::Y, angle)
    }

    /// Turned about the z axis, radians.
    pub fn rotate_z(&self, angle: impl Into<f64>) -> Shape {
        self.rotate(DVec3::Z, angle)
    }

    /// Turned by a rotation, which is normalised first.
    pub fn rotate_by(&self, rotation: DQuat) -> Shape {
        self.place(Placement::quaternion(rotation.to_array()))
    }

    /// Scaled about the origin, the same in all directions, by a factor above 0. ([`Shape::stretch`] takes one for each axis, and gives
    /// a bound on the distance.)
    pub fn scale(&self, factor: impl Into<f64>) -> Shape {
        self.place(Placement::scaled(factor.into()))
    }

    /// Moved, turned and scaled at once.
    pub fn place(&self, placement: Placement) -> Shape {
        self.then(|field| field.place(placement))
    }

    /// Copies on a grid that is centred on the origin: the distance between them along each axis, 0 to 1e6 (0 where it is not
    /// repeated), and how many there are along each, up to 100,000 (0 for without end).
    pub fn repeat(&self, spacing: impl Into<DVec3>, count: [u32; 3]) -> Shape {
        self.repeat_with(Repetition {
            spacing: spacing.into().to_array(),
            count,
            vary: [0.0; 3],
            seed: 0,
        })
    }

    /// Copies on a grid, each moved a little at random.
    pub fn repeat_with(&self, repetition: Repetition) -> Shape {
        self.then(|field| field.repeat(repetition))
    }

    /// Copies around the y axis, up to 100,000, the first one where it is. Those of a plane shape stay in its plane, around z.
    pub fn polar(&self, count: u32) -> Shape {
        self.then(|field| field.polar(Polar { count }))
    }

    /// Painted with the material of this number, wherever it is not painted yet.
    pub fn paint(&self, material: u16) -> Shape {
        self.then(|field| field.paint(Paint::Material(material)))
    }

    fn primitive(name: &'static str, params: Params) -> Shape {
        Shape(match catalogue().primitive(name) {
            Some(entry) => Field::primitive(entry, params.0),
            None => Err(missing(name)),
        })
    }

    fn map(&self, name: &'static str, params: Params) -> Shape {
        self.then(|field| match catalogue().map(name) {
            Some(entry) => field.map(entry, params.0),
            None => Err(missing(name)),
        })
    }

    fn modify(&self, name: &'static str, params: Params) -> Shape {
        self.then(|field| match catalogue().modifier(name) {
            Some(entry) => field.modify(entry, params.0),
            None => Err(missing(name)),
        })
    }

    fn join(
        name: &'static str,
        params: Params,
        shapes: impl IntoIterator<Item = impl Into<Shape>>,
    ) -> Shape {
        let Some(entry) = catalogue().join(name) else {
            return Shape(Err(missing(name)));
        };
        let mut fields = Vec::new();
        for (i, shape) in shapes.into_iter().enumerate() {
            let field = match shape.into().0 {
                Ok(field) => field,
                error => return Shape(error),
            };
            match field.node() {
                // a join is a fold from the left: a chain of equal ones is one, however long, and not a deep tree
                Node::Join {
                    entry: inner,
                    params: same,
                    shapes,
                } if i == 0 && inner.info.name == name && *same == params.0 => {
                    fields.extend_from_slice(shapes);
                }
                _ => fields.push(field),
            }
        }
        Shape(Field::join(entry, params.0, fields))
    }
}

/// The error where an entry is not there, which a test excludes.
fn missing(entry: &'static str) -> FieldError {
    FieldError::Unfit {
        entry,
        reason: "it is not in the catalogue".into(),
    }
}

/// A parameter array in the making.
struct Params(Vec<f64>);

impl Params {
    fn new() -> Params {
        Params(Vec::new())
    }

    fn number(mut self, x: impl Into<f64>) -> Params {
        self.0.push(x.into());
        self
    }

    fn vec2(mut self, v: impl Into<DVec2>) -> Params {
        self.0.extend(v.into().to_array());
        self
    }

    fn vec3(mut self, v: impl Into<DVec3>) -> Params {
        self.0.extend(v.into().to_array());
        self
    }

    /// The number of items, then their numbers.
    fn list<const N: usize>(mut self, items: impl Iterator<Item = [f64; N]>) -> Params {
        let at = self.0.len();
        self.0.push(0.0);
        self.0.extend(items.flatten());
        self.0[at] = ((self.0.len() - at - 1) / N) as f64;
        self
    }

    fn points(self, points: impl IntoIterator<Item = impl Into<DVec3>>) -> Params {
        self.list(points.into_iter().map(|p| p.into().to_array()))
    }

    fn points2(self, points: impl IntoIterator<Item = impl Into<DVec2>>) -> Params {
        self.list(points.into_iter().map(|p| p.into().to_array()))
    }

    fn segments(self, segments: impl IntoIterator<Item = [impl Into<DVec2>; 2]>) -> Params {
        self.list(segments.into_iter().map(|ends| {
            let [a, b] = ends.map(Into::into);
            [a.x, a.y, b.x, b.y]
        }))
    }
}

impl From<&Shape> for Shape {
    fn from(shape: &Shape) -> Shape {
        shape.clone()
    }
}

/// A field that was made elsewhere, such as a formula or a text.
impl From<Field> for Shape {
    fn from(field: Field) -> Shape {
        Shape(Ok(field))
    }
}

impl From<&Field> for Shape {
    fn from(field: &Field) -> Shape {
        Shape(Ok(field.clone()))
    }
}

impl From<Result<Field, FieldError>> for Shape {
    fn from(made: Result<Field, FieldError>) -> Shape {
        Shape(made)
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident, $join:ident) => {
        impl<R: Into<Shape>> $operator<R> for Shape {
            type Output = Shape;
            fn $method(self, other: R) -> Shape {
                self.$join(other)
            }
        }
        impl<R: Into<Shape>> $operator<R> for &Shape {
            type Output = Shape;
            fn $method(self, other: R) -> Shape {
                self.$join(other)
            }
        }
    };
}

operator!(BitOr, bitor, union);
operator!(BitAnd, bitand, intersection);
operator!(Sub, sub, subtraction);
operator!(BitXor, bitxor, xor);

impl Not for Shape {
    type Output = Shape;
    fn not(self) -> Shape {
        self.complement()
    }
}

impl Not for &Shape {
    type Output = Shape;
    fn not(self) -> Shape {
        self.complement()
    }
}
