//! Parts of a field that a ray meets where a formula says: half spaces and balls beside whatever else there is (Keinert et al. 2014,
//! section 4).

use crate::field::{Field, FieldError, Node};
use crate::placement::Placement;
use zeroset_catalogue::entries::Catalogue;

/// A solid that a ray meets in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosedForm {
    /// All points p with `normal . p <= offset`.
    HalfSpace {
        /// Where it is empty, of length 1.
        normal: [f64; 3],
        /// Distance of the plane from the origin, along the normal.
        offset: f64,
    },
    /// A ball.
    Ball {
        /// Its middle.
        centre: [f64; 3],
        /// Its radius, at least 0.
        radius: f64,
    },
}

impl ClosedForm {
    fn placed(&self, placement: &Placement) -> ClosedForm {
        match *self {
            ClosedForm::HalfSpace { normal, offset } => {
                let origin = placement.apply([0.0; 3]);
                let rotation = &placement.rotation;
                let turned: [f64; 3] =
                    std::array::from_fn(|i| (0..3).map(|k| rotation[i][k] * normal[k]).sum());
                let moved: f64 = (0..3).map(|k| turned[k] * origin[k]).sum();
                ClosedForm::HalfSpace {
                    normal: turned,
                    offset: placement.scale * offset + moved,
                }
            }
            ClosedForm::Ball { centre, radius } => ClosedForm::Ball {
                centre: placement.apply(centre),
                radius: placement.scale * radius,
            },
        }
    }
}

/// A field as the sharp union of solids in closed form and of what is left.
#[derive(Clone, Debug)]
pub struct Split {
    /// Solids in closed form.
    pub closed: Vec<ClosedForm>,
    /// All else, unpainted; none where there is nothing else.
    pub rest: Option<Field>,
}

impl Split {
    /// Splits a field. None where it has no part in closed form. Balls stay where there are more than `balls` of them: each is asked of every
    /// ray, and many are found faster by marching.
    ///
    /// # Errors
    /// A tree too deep.
    pub fn of(field: &Field, balls: usize) -> Result<Option<Split>, FieldError> {
        let split = split(field, true)?;
        let is_ball = |form: &&ClosedForm| matches!(form, ClosedForm::Ball { .. });
        match split {
            Some(all) if all.closed.iter().filter(is_ball).count() > balls => {
                self::split(field, false)
            }
            split => Ok(split),
        }
    }
}

/// Which nodes split follows from their kinds alone, so that numbers never change the structure of what is left.
fn split(field: &Field, balls: bool) -> Result<Option<Split>, FieldError> {
    let whole = |form| {
        Ok(Some(Split {
            closed: vec![form],
            rest: None,
        }))
    };
    match field.node() {
        Node::Primitive { entry, .. } if entry.info.name == "plane" => {
            whole(ClosedForm::HalfSpace {
                normal: [0.0, 1.0, 0.0],
                offset: 0.0,
            })
        }
        Node::Primitive { entry, params } if balls && entry.info.name == "sphere" => {
            whole(ClosedForm::Ball {
                centre: [0.0; 3],
                radius: params[0],
            })
        }
        Node::Join { entry, shapes, .. } if entry.code == Catalogue::union().code => {
            union(shapes, balls)
        }
        Node::Place { placement, shape } => {
            let Some(Split { closed, rest }) = split(shape, balls)? else {
                return Ok(None);
            };
            Ok(Some(Split {
                closed: closed.iter().map(|form| form.placed(placement)).collect(),
                rest: rest.map(|rest| rest.place(*placement)).transpose()?,
            }))
        }
        Node::Paint { shape, .. } | Node::Sided(shape) => split(shape, balls),
        _ => Ok(None),
    }
}

fn union(shapes: &[Field], balls: bool) -> Result<Option<Split>, FieldError> {
    let (mut closed, mut rest) = (Vec::new(), Vec::new());
    for shape in shapes {
        match split(shape, balls)? {
            Some(part) => {
                closed.extend(part.closed);
                rest.extend(part.rest);
            }
            None => rest.push(shape.clone()),
        }
    }
    if closed.is_empty() {
        return Ok(None);
    }
    let rest = match rest.is_empty() {
        true => None,
        false => Some(Field::join(Catalogue::union(), Vec::new(), rest)?),
    };
    Ok(Some(Split { closed, rest }))
}

#[cfg(test)]
mod tests {
    use super::{ClosedForm, Split};
    use crate::program::{Limits, Program};
    use crate::shape::{Shape, box3, plane, smooth_union, sphere, torus};
    use zeroset_eval::Point;
    use zeroset_number::{F64, v3};

    fn split(shape: &Shape, balls: usize) -> Option<Split> {
        Split::of(&shape.field().expect("a field"), balls).expect("a split")
    }

    fn distance(form: &ClosedForm, p: [f64; 3]) -> f64 {
        let dot = |a: [f64; 3]| (0..3).map(|k| a[k] * p[k]).sum::<f64>();
        match *form {
            ClosedForm::HalfSpace { normal, offset } => dot(normal) - offset,
            ClosedForm::Ball { centre, radius } => {
                (0..3)
                    .map(|k| (p[k] - centre[k]).powi(2))
                    .sum::<f64>()
                    .sqrt()
                    - radius
            }
        }
    }

    /// The least of the parts and the rest is the field, wherever floors and balls were moved, turned and scaled to.
    #[test]
    fn a_union_is_its_parts() {
        let inner = plane().rotate([0.8, 0.0, 0.6], 0.3)
            | sphere(0.5).translate([0.2, 1.0, 0.0])
            | torus(1.0, 0.2);
        let shape = inner.scale(1.7).translate([0.1, -0.4, 0.6]).rotate_y(1.1)
            | plane().translate([0.0, -2.0, 0.0])
            | box3([1.0, 2.0, 3.0]);
        let whole = shape.field().expect("a field");
        let parts = split(&shape, 4).expect("floors and a ball");
        assert_eq!(parts.closed.len(), 3);
        let compile = |field| Program::compile(field, &Limits::default()).expect("a program");
        let (whole, rest) = (
            compile(&whole),
            compile(&parts.rest.expect("a box and a ring")),
        );
        for k in 0..500 {
            let p = [0.731, 0.447, 0.911].map(|x: f64| (x * f64::from(k)).fract() * 8.0 - 4.0);
            let at = v3(F64(p[0]), F64(p[1]), F64(p[2]));
            let value = |program: &Program| Point::new(program.values()).value(at).0;
            let least =
                (parts.closed.iter()).fold(value(&rest), |a, form| a.min(distance(form, p)));
            assert!(
                (least - value(&whole)).abs() < 1e-5,
                "at {p:?}: {least}, {}",
                value(&whole)
            );
        }
    }

    /// What is joined smoothly, cut or made thicker is no part, and many balls are none either.
    #[test]
    fn only_sharp_unions_split() {
        let floor = plane();
        assert!(split(&smooth_union([floor.clone(), sphere(1.0)], 0.2), 4).is_none());
        assert!(split(&(floor.clone() - sphere(1.0)), 4).is_none());
        let many = (0..5).fold(floor, |all, k| {
            all | sphere(0.1).translate([f64::from(k), 1.0, 0.0])
        });
        assert_eq!(split(&many, 4).expect("a floor").closed.len(), 1);
        assert_eq!(split(&many, 5).expect("a floor and balls").closed.len(), 6);
        assert!(split(&many, 5).expect("a floor and balls").rest.is_none());
    }
}
