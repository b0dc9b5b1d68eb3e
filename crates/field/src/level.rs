//! Boxes of level sets: where a field is at most some value.
//!
//! What grows a shape (rounding, shells, smooth joins, displacement) shows a level set of the field below it. An exact
//! distance grows by as much as its value says; a field that is only a bound may grow by more, so its level sets are found
//! node by node.

use crate::field::{Field, Node};
use std::cell::RefCell;
use std::collections::HashMap;
use zeroset_catalogue::Stretch;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::JoinEntry;

/// Boxes that were found already, by node and level, so that shared nodes are visited once.
type Known = RefCell<HashMap<(usize, u64), Aabb>>;

impl Field {
    /// A box that holds all places where the field, before any division by its slope, is at most `level`.
    pub(crate) fn level_bounds(&self, level: f64) -> Aabb {
        level_bounds(self, level, &Known::default())
    }
}

fn level_bounds(field: &Field, level: f64, known: &Known) -> Aabb {
    let facts = field.facts();
    if level <= 0.0 || facts.bounds == Aabb::WHOLE {
        return facts.bounds;
    }
    if facts.exactness <= Exactness::Outside {
        return facts.bounds.grow(level);
    }
    let key = (field.key(), level.to_bits());
    if let Some(found) = known.borrow().get(&key) {
        return *found;
    }
    let below = |shape: &Field, level: f64| level_bounds(shape, level, known);
    let found = match field.node() {
        Node::Primitive { entry, params } => (entry.level_bounds)(params, level),
        Node::Map {
            entry,
            params,
            shape,
        } => match (entry.stretch)(params, &facts.bounds) {
            Ok(Stretch::Everywhere(_)) => (entry.bounds)(params, &below(shape, level)),
            // continued beyond the box with this slope
            _ => facts.bounds.grow(level / facts.slope),
        },
        Node::Modify {
            entry,
            params,
            shape,
        } => (entry.level_bounds)(params, level, &|level| below(shape, level)),
        Node::Join {
            entry,
            params,
            shapes,
        } => join_bounds(entry, params, shapes, level, &below),
        Node::Place { placement, shape } => {
            placement.bounds(&below(shape, level / placement.scale))
        }
        // copies are at least as far as their boxes
        Node::Repeat { .. } | Node::Polar { .. } => facts.bounds.grow(level),
        Node::Formula(formula) if formula.is_unbounded() => formula
            .bounds()
            .hull(&facts.bounds)
            .grow(level / facts.slope),
        Node::Formula(_) | Node::Sampled(_) => facts.bounds.grow(level / facts.slope),
        Node::Sided(shape) | Node::Paint { shape, .. } => below(shape, level),
    };
    known.borrow_mut().insert(key, found);
    found
}

/// A box of a level set of a join. `below` gives those of the joined fields.
pub(crate) fn join_bounds(
    entry: &JoinEntry,
    params: &[f64],
    shapes: &[Field],
    level: f64,
    below: &dyn Fn(&Field, f64) -> Aabb,
) -> Aabb {
    // sharp joins take the values divided by their slopes
    let at = |shape: &Field, level: f64| {
        let facts = shape.facts();
        let scale = if entry.sharp && facts.steep {
            facts.slope
        } else {
            1.0
        };
        below(shape, level * scale)
    };
    if let [x, y] = shapes {
        return (entry.level_bounds)(params, level, &|l| at(x, l), &|l| at(y, l));
    }
    // Joins move along with their operands, so a level set of the join is the join of level sets; the join of many grows
    // boxes itself, by at most its reach, which is only enough where a box grows as its field does.
    let reach = (entry.reach)(params) * (shapes.len() - 1) as f64;
    let boxes: Vec<Aabb> = shapes
        .iter()
        .map(|shape| {
            let true_to_box = shape.facts().exactness <= Exactness::Outside;
            at(
                shape,
                if entry.sharp || true_to_box {
                    level
                } else {
                    level + reach
                },
            )
        })
        .collect();
    if boxes.contains(&Aabb::WHOLE) || !reach.is_finite() && !entry.sharp {
        return boxes.iter().fold(Aabb::EMPTY, |a, b| a.hull(b));
    }
    (entry.bounds)(params, &boxes)
}
