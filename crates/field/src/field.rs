//! The field tree: what a scene builds and a [`Program`](crate::program::Program) is compiled from.
//!
//! A [`Field`] is cheap to clone, and a clone is the same node: a shape used in two places of a tree at the same place in
//! space is evaluated once. Every node is checked when it is made, and knows its box, its exactness and its slope.

use crate::formula::{Formula, Inner};
use crate::level::join_bounds;
use crate::placement::Placement;
use crate::repetition::{Polar, Repetition};
use crate::sampled::Sampled;
use std::sync::Arc;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::{JoinEntry, MapEntry, ModifyEntry, PrimitiveEntry};
use zeroset_catalogue::{Dimension, Info, Kind, Stretch};

/// Deepest tree that can be built; deeper ones are refused before a recursion could overflow the stack.
pub const MAX_DEPTH: u32 = 512;

/// A node of a field tree.
#[derive(Clone, Debug)]
pub struct Field(Arc<(Node, Facts)>);

/// What a node is.
#[derive(Clone, Debug)]
pub enum Node {
    /// A shape of the catalogue.
    Primitive {
        /// Which.
        entry: &'static PrimitiveEntry,
        /// Its parameter array.
        params: Vec<f64>,
    },
    /// A map of the catalogue.
    Map {
        /// Which.
        entry: &'static MapEntry,
        /// Its parameter array.
        params: Vec<f64>,
        /// What is mapped.
        shape: Field,
    },
    /// A modifier of the catalogue.
    Modify {
        /// Which.
        entry: &'static ModifyEntry,
        /// Its parameter array.
        params: Vec<f64>,
        /// What is changed.
        shape: Field,
    },
    /// A join of the catalogue, over two or more fields from left to right.
    Join {
        /// Which.
        entry: &'static JoinEntry,
        /// Its parameter array.
        params: Vec<f64>,
        /// What is joined.
        shapes: Vec<Field>,
    },
    /// A rigid motion with a uniform scale.
    Place {
        /// Where.
        placement: Placement,
        /// What.
        shape: Field,
    },
    /// Copies on a grid.
    Repeat {
        /// How.
        repetition: Repetition,
        /// What.
        shape: Field,
    },
    /// Copies around the y axis, or around z if the shape is plane.
    Polar {
        /// How.
        polar: Polar,
        /// What.
        shape: Field,
    },
    /// A free-form formula over x, y and z.
    Formula(Arc<Formula>),
    /// A grid of samples, continued beyond its box.
    Sampled(Arc<Sampled>),
    /// The same field; its value turned around for rays inside it, see [`Program::inside`](crate::program::Program::inside).
    #[doc(hidden)]
    Sided(Field),
    /// A field whose surface has a material, or belongs to an object, of its own.
    Paint {
        /// Which.
        paint: Paint,
        /// What.
        shape: Field,
    },
}

/// What a surface may be marked with; the innermost mark of each kind counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// The scene's number for a material.
    Material(u16),
    /// The scene's number for an object.
    Object(u16),
}

/// What a node knows about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    /// A box that holds the solid.
    pub bounds: Aabb,
    /// How true the distance is, once divided by the slope.
    pub exactness: Exactness,
    /// Lipschitz constant of the value before any division.
    pub slope: f64,
    /// Whether no slope is known to hold: the one here is a usual one near the surface of a formula that has none. Sphere tracing must not rest
    /// on values then; cells and ranges know more.
    pub unbounded: bool,
    /// Whether the value may need a division: decided by the kind of node and not by its numbers alone, so that a slider
    /// does not change a program's structure.
    pub steep: bool,
    /// The plane or space.
    pub dimension: Dimension,
    /// Nodes from here to the farthest leaf.
    pub depth: u32,
    /// Nodes of the tree, with shared ones counted every time.
    pub nodes: u64,
    /// One more than the highest [`Paint::Material`] in the tree; 0 where nothing is painted.
    pub materials: u32,
}

/// Why a node cannot be made. Every message says what was given and what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FieldError {
    /// A number outside its range.
    #[error("{entry}: {param} is {value}, allowed is {min} to {max}")]
    Range {
        /// Entry.
        entry: &'static str,
        /// Parameter.
        param: &'static str,
        /// What was given.
        value: f64,
        /// Smallest allowed.
        min: f64,
        /// Largest allowed.
        max: f64,
    },
    /// A parameter array of the wrong length, or a list whose count does not match.
    #[error("{entry}: {given} numbers given, its parameters take {wanted}")]
    Count {
        /// Entry.
        entry: &'static str,
        /// Numbers given.
        given: usize,
        /// Numbers wanted.
        wanted: usize,
    },
    /// Parameters that do not fit each other, or a shape that does not fit the operation.
    #[error("{entry}: {reason}")]
    Unfit {
        /// Entry.
        entry: &'static str,
        /// Why, and what is allowed.
        reason: String,
    },
    /// A 2D field where a solid is needed, or the other way round.
    #[error("{entry} needs a {wanted} shape, this one is {given}: {hint}")]
    Dimension {
        /// Entry.
        entry: &'static str,
        /// What is needed.
        wanted: &'static str,
        /// What was given.
        given: &'static str,
        /// How to mend it.
        hint: &'static str,
    },
    /// A tree deeper than [`MAX_DEPTH`].
    #[error(
        "the field is nested {MAX_DEPTH} operations deep, which is the limit; join many shapes with one union([...])"
    )]
    Deep,
    /// A join of no fields.
    #[error("{entry} needs at least one field")]
    Empty {
        /// Entry.
        entry: &'static str,
    },
}

impl Field {
    /// A shape of the catalogue, from its whole parameter array (lengths in scene units, angles in radians).
    ///
    /// # Errors
    /// Numbers out of range or that do not fit each other.
    pub fn primitive(
        entry: &'static PrimitiveEntry,
        params: Vec<f64>,
    ) -> Result<Field, FieldError> {
        check_params(&entry.info, &params, entry.check)?;
        let slope = (entry.lipschitz)(&params);
        let facts = Facts {
            bounds: (entry.bounds)(&params),
            exactness: entry.exactness,
            slope,
            unbounded: false,
            steep: slope != 1.0 || (entry.lipschitz)(&entry.info.defaults()) != 1.0,
            dimension: entry.info.dimension,
            depth: 1,
            nodes: 1,
            materials: 0,
        };
        Ok(Field::new(Node::Primitive { entry, params }, facts))
    }

    /// This field seen through a map of the catalogue.
    ///
    /// # Errors
    /// Numbers out of range; a 2D shape where a solid is needed; a map that is only bounded over a bounded shape.
    pub fn map(&self, entry: &'static MapEntry, params: Vec<f64>) -> Result<Field, FieldError> {
        check_params(&entry.info, &params, entry.check)?;
        let child = self.facts();
        let through = through(&entry.info, child.dimension)?;
        if through == Dimension::Two {
            (entry.plane)(&params).map_err(|reason| FieldError::Unfit {
                entry: entry.info.name,
                reason,
            })?;
        }
        let dimension = if entry.section {
            Dimension::Two
        } else {
            through
        };
        let bounds = (entry.bounds)(&params, &child.bounds);
        let unfit = |reason| FieldError::Unfit {
            entry: entry.info.name,
            reason,
        };
        let stretch = match (entry.stretch)(&params, &bounds).map_err(unfit)? {
            Stretch::Everywhere(l) | Stretch::Within(_, l) => l,
        };
        let facts = Facts {
            bounds,
            exactness: if entry.rigid {
                child.exactness
            } else {
                child.exactness.max(Exactness::Bound)
            },
            slope: child.slope * stretch,
            steep: child.steep || !entry.rigid,
            dimension,
            ..child.above()?
        };
        Ok(Field::new(
            Node::Map {
                entry,
                params,
                shape: self.clone(),
            },
            facts,
        ))
    }

    /// This field changed by a modifier of the catalogue.
    ///
    /// # Errors
    /// Numbers out of range; a solid where a 2D shape is needed.
    pub fn modify(
        &self,
        entry: &'static ModifyEntry,
        params: Vec<f64>,
    ) -> Result<Field, FieldError> {
        check_params(&entry.info, &params, entry.check)?;
        let child = self.facts();
        let dimension = through(&entry.info, child.dimension)?;
        let slope = (entry.lipschitz)(&params, child.slope);
        let facts = Facts {
            bounds: (entry.level_bounds)(&params, 0.0, &|level| self.level_bounds(level)),
            exactness: (entry.exactness)(child.exactness),
            slope,
            steep: child.steep
                || slope != 1.0
                || (entry.lipschitz)(&entry.info.defaults(), 1.0) != 1.0,
            dimension,
            ..child.above()?
        };
        Ok(Field::new(
            Node::Modify {
                entry,
                params,
                shape: self.clone(),
            },
            facts,
        ))
    }

    /// Two or more fields joined from left to right. One field alone is given back as it is.
    ///
    /// # Errors
    /// Numbers out of range, no fields, or fields of the plane mixed with solids.
    pub fn join(
        entry: &'static JoinEntry,
        params: Vec<f64>,
        shapes: Vec<Field>,
    ) -> Result<Field, FieldError> {
        check_params(&entry.info, &params, entry.check)?;
        let mut rest = shapes.iter();
        let Some(first) = rest.next() else {
            return Err(FieldError::Empty {
                entry: entry.info.name,
            });
        };
        if shapes.len() == 1 {
            return Ok(first.clone());
        }
        let mut facts = first.facts().above()?;
        let bounds = join_bounds(entry, &params, &shapes, 0.0, &Field::level_bounds);
        for shape in rest {
            let f = shape.facts();
            if facts.dimension != f.dimension
                && facts.dimension != Dimension::Any
                && f.dimension != Dimension::Any
            {
                return Err(FieldError::Dimension {
                    entry: entry.info.name,
                    wanted: spoken(facts.dimension),
                    given: spoken(f.dimension),
                    hint: "make solids of plane shapes with extrude(...) or revolve(...) first",
                });
            }
            let (x, y) = if entry.sharp {
                (1.0, 1.0)
            } else {
                (facts.slope, f.slope)
            };
            let slope = (entry.lipschitz)(&params, x, y);
            facts = Facts {
                bounds,
                exactness: (entry.exactness)(facts.exactness, f.exactness),
                slope,
                unbounded: facts.unbounded || f.unbounded,
                steep: !entry.sharp
                    && (facts.steep
                        || f.steep
                        || (entry.lipschitz)(&entry.info.defaults(), 1.0, 1.0) != 1.0),
                dimension: if facts.dimension == Dimension::Any {
                    f.dimension
                } else {
                    facts.dimension
                },
                depth: facts.depth.max(f.above()?.depth),
                nodes: facts.nodes.saturating_add(f.nodes),
                materials: facts.materials.max(f.materials),
            };
        }
        Ok(Field::new(
            Node::Join {
                entry,
                params,
                shapes,
            },
            facts,
        ))
    }

    /// This field moved, turned or scaled. Placements that follow each other become one.
    ///
    /// # Errors
    /// A tree too deep, a placement that is not finite, a scale that is not positive, a plane shape that would leave its
    /// plane.
    pub fn place(&self, placement: Placement) -> Result<Field, FieldError> {
        let (placement, shape) = match self.node() {
            Node::Place {
                placement: inner,
                shape,
            } => (placement.after(inner), shape),
            _ => (placement, self),
        };
        if !placement.is_held() {
            return Err(FieldError::Unfit {
                entry: "place",
                reason: "the motion must be finite in single precision and its scale above 0"
                    .into(),
            });
        }
        let child = shape.facts();
        let placement = match child.dimension {
            Dimension::Two => placement.in_plane().ok_or_else(|| FieldError::Unfit {
                entry: "place",
                reason: "a plane shape lies in the plane z = 0 and cannot leave it: move it along x and y and turn it about z, \
                         or make a solid of it with extrude(...) or revolve(...) first"
                    .into(),
            })?,
            _ => placement,
        };
        let facts = Facts {
            bounds: placement.bounds(&child.bounds),
            ..child.above()?
        };
        Ok(Field::new(
            Node::Place {
                placement,
                shape: shape.clone(),
            },
            facts,
        ))
    }

    /// Copies of this field on a grid.
    ///
    /// # Errors
    /// A spacing that is too small for the shape, or a shape without bounds along a repeated axis.
    pub fn repeat(&self, repetition: Repetition) -> Result<Field, FieldError> {
        let child = self.facts();
        let in_plane = match child.dimension {
            Dimension::Two => repetition.check_plane(),
            _ => Ok(()),
        };
        in_plane
            .and_then(|()| repetition.check(&child.bounds))
            .map_err(|reason| FieldError::Unfit {
                entry: "repeat",
                reason,
            })?;
        let facts = Facts {
            bounds: repetition.bounds(&child.bounds),
            exactness: child.exactness.max(Exactness::Bound),
            slope: 1.0,
            steep: false,
            ..child.above()?
        };
        Ok(Field::new(
            Node::Repeat {
                repetition,
                shape: self.clone(),
            },
            facts,
        ))
    }

    /// Copies of this field around the y axis; those of a plane shape stay in its plane, around the z axis.
    ///
    /// # Errors
    /// Too many copies for a shape that is wider than its sector.
    pub fn polar(&self, polar: Polar) -> Result<Field, FieldError> {
        let child = self.facts();
        let plane = child.dimension == Dimension::Two;
        let upright = if plane {
            Polar::upright(&child.bounds)
        } else {
            child.bounds
        };
        polar.check(&upright).map_err(|reason| FieldError::Unfit {
            entry: "polar",
            reason,
        })?;
        let facts = Facts {
            bounds: if plane {
                Polar::upright(&polar.bounds(&upright))
            } else {
                polar.bounds(&upright)
            },
            exactness: child.exactness.max(Exactness::Bound),
            slope: 1.0,
            steep: false,
            ..child.above()?
        };
        Ok(Field::new(
            Node::Polar {
                polar,
                shape: self.clone(),
            },
            facts,
        ))
    }

    /// A free-form formula, which brings its own proof of its slope.
    ///
    /// # Errors
    /// A tree too deep, through the fields that the formula takes the values of.
    pub fn formula(formula: Arc<Formula>) -> Result<Field, FieldError> {
        let dimension = formula.dimension();
        let mut bounds = formula.bounds();
        if dimension == Dimension::Two {
            // a plane shape has no ends along z
            (bounds.min[2], bounds.max[2]) = (f64::NEG_INFINITY, f64::INFINITY);
        } else if formula.is_unbounded() {
            // cells are made around it: the tighter the better
            let reach = formula.reach();
            if !reach.is_empty() {
                bounds = reach;
            }
        }
        let exactness = if formula.is_proven() {
            Exactness::Bound
        } else {
            Exactness::Estimate
        };
        let mut facts = Facts {
            bounds,
            exactness,
            slope: formula.slope(),
            unbounded: formula.is_unbounded(),
            steep: true,
            dimension,
            depth: 1,
            nodes: 1,
            materials: 0,
        };
        for inner in formula.fields() {
            let child = inner.field().facts();
            facts.exactness = facts.exactness.max(child.exactness);
            facts.unbounded |= child.unbounded;
            facts.depth = facts.depth.max(child.depth.saturating_add(1));
            facts.nodes = facts.nodes.saturating_add(child.nodes);
            facts.materials = facts.materials.max(child.materials);
        }
        if facts.depth > MAX_DEPTH {
            return Err(FieldError::Deep);
        }
        Ok(Field::new(Node::Formula(formula), facts))
    }

    /// A grid of samples, continued beyond its box: a mesh, a volume of a file, an image as a plane shape.
    pub fn sampled(sampled: Arc<Sampled>) -> Field {
        let mut bounds = sampled.bounds();
        if sampled.dimension() == Dimension::Two {
            // a plane shape has no ends along z
            (bounds.min[2], bounds.max[2]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        let facts = Facts {
            bounds,
            exactness: Exactness::Bound,
            slope: sampled.slope(),
            unbounded: false,
            steep: true,
            dimension: sampled.dimension(),
            depth: 1,
            nodes: 1,
            materials: 0,
        };
        Field::new(Node::Sampled(sampled), facts)
    }

    /// A union of clear and opaque bodies of which each can be told from the other by rays inside: see
    /// [`Program::inside`](crate::program::Program::inside).
    ///
    /// # Errors
    /// A tree too deep.
    pub fn clear_union(clear: Field, opaque: Field) -> Result<Field, FieldError> {
        let union = zeroset_catalogue::entries::Catalogue::union();
        Field::join(union, Vec::new(), vec![clear.sided()?, opaque])?.sided()
    }

    fn sided(&self) -> Result<Field, FieldError> {
        let facts = self.facts().above()?;
        Ok(Field::new(Node::Sided(self.clone()), facts))
    }

    /// This field painted, where no part of it is painted in the same way already.
    ///
    /// # Errors
    /// A tree too deep.
    pub fn paint(&self, paint: Paint) -> Result<Field, FieldError> {
        let mut facts = self.facts().above()?;
        if let Paint::Material(number) = paint {
            facts.materials = facts.materials.max(u32::from(number) + 1);
        }
        Ok(Field::new(
            Node::Paint {
                paint,
                shape: self.clone(),
            },
            facts,
        ))
    }

    /// What the node is.
    pub fn node(&self) -> &Node {
        &self.0.0
    }

    /// What the node knows about itself.
    pub fn facts(&self) -> &Facts {
        &self.0.1
    }

    /// The nodes right below this one.
    pub fn children(&self) -> Vec<&Field> {
        match self.node() {
            Node::Primitive { .. } | Node::Sampled(_) => Vec::new(),
            Node::Formula(formula) => formula.fields().iter().map(Inner::field).collect(),
            Node::Join { shapes, .. } => shapes.iter().collect(),
            Node::Map { shape, .. }
            | Node::Modify { shape, .. }
            | Node::Place { shape, .. }
            | Node::Repeat { shape, .. }
            | Node::Polar { shape, .. }
            | Node::Sided(shape)
            | Node::Paint { shape, .. } => vec![shape],
        }
    }

    /// The node's identity: equal for clones of one node.
    pub fn key(&self) -> usize {
        Arc::as_ptr(&self.0) as *const u8 as usize
    }

    fn new(node: Node, facts: Facts) -> Field {
        Field(Arc::new((node, facts)))
    }
}

impl Facts {
    /// The facts of a node over this one, as far as they are the same.
    fn above(&self) -> Result<Facts, FieldError> {
        if self.depth >= MAX_DEPTH {
            return Err(FieldError::Deep);
        }
        Ok(Facts {
            depth: self.depth + 1,
            nodes: self.nodes.saturating_add(1),
            ..*self
        })
    }
}

fn spoken(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Two => "2D",
        Dimension::Three => "3D",
        Dimension::Any => "2D or 3D",
    }
}

/// The dimension behind an operation: one of [`Dimension::Two`] takes a plane shape and gives a solid.
fn through(info: &Info, shape: Dimension) -> Result<Dimension, FieldError> {
    match (info.dimension, shape) {
        (Dimension::Any, d) => Ok(d),
        (Dimension::Two, Dimension::Three) => Err(FieldError::Dimension {
            entry: info.name,
            wanted: "2D",
            given: "3D",
            hint: "it makes a solid of a plane shape such as circle() or polygon(...)",
        }),
        (Dimension::Three, Dimension::Two) => Err(FieldError::Dimension {
            entry: info.name,
            wanted: "3D",
            given: "2D",
            hint: "make a solid of it with extrude(...) or revolve(...) first",
        }),
        _ => Ok(Dimension::Three),
    }
}

/// Whether a parameter array fits an entry: its length, its ranges, its relations.
fn check_params(
    info: &Info,
    params: &[f64],
    relations: fn(&[f64]) -> Result<(), String>,
) -> Result<(), FieldError> {
    let mut at = 0;
    for p in info.params {
        let values = match p.kind {
            Kind::List(width) => {
                let rest = params.get(at..).unwrap_or_default();
                let (Some(&count), items) = (rest.first(), rest.get(1..).unwrap_or_default())
                else {
                    return Err(FieldError::Count {
                        entry: info.name,
                        given: params.len(),
                        wanted: at + 1,
                    });
                };
                if count < 0.0 || count.fract() != 0.0 || items.len() != count as usize * width {
                    let wanted = at + 1 + count.max(0.0) as usize * width;
                    return Err(FieldError::Count {
                        entry: info.name,
                        given: params.len(),
                        wanted,
                    });
                }
                at += 1;
                at += items.len();
                items
            }
            kind => {
                let Some(values) = params.get(at..at + kind.len()) else {
                    let wanted = info.params.iter().map(|p| p.kind.len()).sum();
                    return Err(FieldError::Count {
                        entry: info.name,
                        given: params.len(),
                        wanted,
                    });
                };
                at += kind.len();
                values
            }
        };
        for &value in values {
            // also refuses NaN
            if !(p.min <= value && value <= p.max) {
                let (entry, param) = (info.name, p.name);
                return Err(FieldError::Range {
                    entry,
                    param,
                    value,
                    min: p.min,
                    max: p.max,
                });
            }
        }
    }
    if at != params.len() {
        return Err(FieldError::Count {
            entry: info.name,
            given: params.len(),
            wanted: at,
        });
    }
    relations(params).map_err(|reason| FieldError::Unfit {
        entry: info.name,
        reason,
    })
}
