//! What is made between fields and along curves: transitions, lofts, bends, sweeps, splines, tapered tubes, easing.

use super::formulas::{found, made, told};
use super::machine::Machine;
use super::mistake::{Run, mistake};
use super::native::{Argument, Call, Given, Native, Slot, slot};
use super::value::Value;
use crate::report::{Place, listing};
use glam::{DMat3, DVec3};
use zeroset_catalogue::entries::{Catalogue, catalogue};
use zeroset_catalogue::{Dimension, LARGE, SMALL};
use zeroset_field::field::{Field, FieldError};
use zeroset_field::formula::{Builder, EASE, Ease, Expression, Steps};
use zeroset_field::placement::Placement;

const GROUP: &str = "Between shapes and along curves";

const EASING: Slot = slot(
    "ease",
    "\"linear\"",
    "How it goes from one to the other: an easing function by its name, as of ease().",
);
const OTHER: Slot = slot("other", "", "The other field.");
const SLOPE: Slot = slot(
    "slope",
    "proven",
    "How fast the value changes at most, where that cannot be proven.",
);
const BOUNDS: Slot = slot(
    "bounds",
    "found",
    "Corners ((x, y, z), (x, y, z)) of the box that holds the result, where it is not found.",
);
const POINTS: Slot = slot("points", "", "Two points (x, y, z) or more.");
const CLOSED: Slot = slot(
    "closed",
    "False",
    "Whether the last point leads to the first one again.",
);
const STEPS: Slot = slot(
    "steps",
    "8",
    "Straight pieces from one point to the next, 1 to 64.",
);

/// The functions.
pub(crate) const ALL: &[Native] = &[
    Native {
        name: "spline",
        doc: "Points of a smooth curve through the points given (Catmull and Rom 1974), for tube, sweep and polyline_tube.",
        group: GROUP,
        params: &[POINTS, CLOSED, STEPS],
        rest: false,
        run: spline,
    },
    Native {
        name: "tube",
        doc: "A tube with round ends along a smooth curve through the points, as thick as the radius says at each point.",
        group: GROUP,
        params: &[
            POINTS,
            slot(
                "radius",
                "0.1",
                "Radius of the tube, or a list of one for each point: a tapered tube.",
            ),
            CLOSED,
            slot(
                "steps",
                "8",
                "Straight pieces from one point to the next, 1 to 64; 1 is a polyline.",
            ),
        ],
        rest: false,
        run: tube,
    },
];

/// The methods.
pub(crate) const METHODS: &[Native] = &[
    Native {
        name: "morph",
        doc: "What lies between two fields: their values mixed, the same everywhere.",
        group: GROUP,
        params: &[
            OTHER,
            slot("t", "0.5", "Where between the two, 0 to 1."),
            BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: morph,
    },
    Native {
        name: "transition",
        doc: "From this field at one point to another field at another point, mixed in between.",
        group: GROUP,
        params: &[
            OTHER,
            slot("start", "(0, -0.5, 0)", "Up to here it is this field."),
            slot("end", "(0, 0.5, 0)", "From here on it is the other one."),
            EASING,
            BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: transition,
    },
    Native {
        name: "loft",
        doc: "A solid from two plane shapes: this one at its lower end along z, the other at its upper end.",
        group: GROUP,
        params: &[
            OTHER,
            slot("height", "1", "Full length along z."),
            EASING,
            BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: loft,
    },
    Native {
        name: "bend_linear",
        doc: "Moves the shape the more, the farther a place lies on the way from one point to another.",
        group: "Deformations",
        params: &[
            slot("start", "", "Up to here nothing moves, (x, y, z)."),
            slot(
                "end",
                "",
                "From here on all moves by the whole offset, (x, y, z).",
            ),
            slot("offset", "", "How far it moves, (x, y, z)."),
            EASING,
            BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: bend_linear,
    },
    Native {
        name: "bend_radial",
        doc: "Moves the shape up the more, the farther a place is from the y axis: plates become bowls.",
        group: "Deformations",
        params: &[
            slot(
                "inner",
                "",
                "Up to this distance from the y axis nothing moves.",
            ),
            slot(
                "outer",
                "",
                "From this distance on all moves by the whole height.",
            ),
            slot("height", "", "How far it moves along y."),
            EASING,
            BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: bend_radial,
    },
    Native {
        name: "sweep",
        doc: "A solid from a plane shape that is led along a path: straight pieces, cut where they meet.",
        group: GROUP,
        params: &[
            slot(
                "path",
                "",
                "Two points (x, y, z) or more, as of spline(); the shape's origin goes along them.",
            ),
            slot(
                "up",
                "\"y\"",
                "Where the shape's y axis points at the start, as far as it can.",
            ),
        ],
        rest: false,
        run: sweep,
    },
];

impl Call<'_, '_> {
    fn ease_or_linear(&self) -> Run<Ease> {
        let linear = Ease::named("linear");
        match (self.get("ease"), linear) {
            (None, Some(linear)) => Ok(linear),
            (Some(given), _) => {
                let name = self.text("ease", given)?;
                named(&name).map_err(|m| m.at(given.place))
            }
            (None, None) => Err(mistake("there is no easing function `linear`")),
        }
    }

    fn point_or(&self, param: &str, default: [f64; 3]) -> Run<[f64; 3]> {
        self.get(param)
            .map_or(Ok(default), |g| self.numbers(param, g))
    }

    fn both(&self) -> Run<(Field, Field)> {
        let other = self.need("other")?;
        Ok((self.shape()?, self.field("other", other)?))
    }
}

/// An easing function by its name.
fn named(name: &str) -> Run<Ease> {
    Ease::named(name).ok_or_else(|| {
        let names = Ease::names();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let help = match crate::report::nearest(name, names.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("there are {}", listing(&names)),
        };
        mistake(format!("there is no easing function \"{name}\"")).help(help)
    })
}

/// How far `p` is on the way from `start` to `end`: 0 to 1 between them.
fn along(p: &Expression, start: [f64; 3], end: [f64; 3]) -> Expression {
    let way: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
    let square: f64 = way.iter().map(|x| x * x).sum();
    let builder = p.builder();
    let vector = |v: [f64; 3]| builder.vector(&v.map(|x| builder.constant(x)));
    (p - vector(start)).dot(vector(way.map(|x| x / square)))
}

fn apart(c: &Call<'_, '_>, start: [f64; 3], end: [f64; 3]) -> Run<()> {
    if (0..3).any(|k| (start[k] - end[k]).abs() > SMALL) {
        return Ok(());
    }
    Err(mistake(format!(
        "`start` and `end` of {}() are the same point",
        c.name
    ))
    .at(c.place))
}

fn steps(c: &Call<'_, '_>, write: impl FnOnce(&Builder) -> Expression) -> Run<Steps> {
    let builder = Builder::new();
    let value = write(&builder);
    builder.finish(&value).map_err(|e| told(&e).at(c.place))
}

fn given(c: &Call<'_, '_>) -> Given {
    Given {
        value: c.receiver,
        place: c.place,
    }
}

/// Two fields mixed, over a box that holds both.
fn mixed(
    c: &mut Call<'_, '_>,
    (a, b): (Field, Field),
    t: impl Fn(&Expression) -> Expression,
) -> Run<Value> {
    let (one, two) = (a.facts().dimension, b.facts().dimension);
    let flat = one == Dimension::Two;
    if flat != (two == Dimension::Two) {
        return Err(
            mistake(format!("{}() needs two solids or two plane shapes", c.name))
                .help("extrude(...) or revolve(...) makes a solid of a plane shape")
                .at(c.place),
        );
    }
    let steps = steps(c, |builder| {
        let p = builder.point();
        let q = if flat {
            p.swizzle("xy").unwrap_or_else(|| p.clone())
        } else {
            p.clone()
        };
        builder.field(&a, &q).mix(builder.field(&b, &q), t(&p))
    })?;
    let both = a.facts().bounds.hull(&b.facts().bounds);
    let bounds = found(c, &both, flat, &steps)?;
    let at = given(c);
    made(c, at, steps, bounds, flat)
}

fn morph(c: &mut Call<'_, '_>) -> Run<Value> {
    let both = c.both()?;
    let t = c.number_or("t", 0.5, 0.0, 1.0)?;
    mixed(c, both, |p| p.builder().constant(t))
}

fn transition(c: &mut Call<'_, '_>) -> Run<Value> {
    let (both, ease) = (c.both()?, c.ease_or_linear()?);
    let start = c.point_or("start", [0.0, -0.5, 0.0])?;
    let end = c.point_or("end", [0.0, 0.5, 0.0])?;
    apart(c, start, end)?;
    mixed(c, both, |p| ease.at(&along(p, start, end)))
}

fn loft(c: &mut Call<'_, '_>) -> Run<Value> {
    let ((a, b), ease) = (c.both()?, c.ease_or_linear()?);
    let height = c.number_or("height", 1.0, SMALL, LARGE)?;
    if a.facts().dimension != Dimension::Two || b.facts().dimension != Dimension::Two {
        return Err(mistake("loft() needs two plane shapes")
            .help("such as rectangle(1).loft(circle(0.4), height = 2)")
            .at(c.place));
    }
    let steps = steps(c, |builder| {
        let p = builder.point();
        let q = builder.vector(&[p.x(), p.y()]);
        let t = ease.at(&(p.z() / height + 0.5));
        let section = builder.field(&a, &q).mix(builder.field(&b, &q), t);
        let ends = p.z().abs() - 0.5 * height;
        section.max(0.0).hypot(ends.max(0.0)) + section.max(ends).min(0.0)
    })?;
    let mut both = a.facts().bounds.hull(&b.facts().bounds);
    (both.min[2], both.max[2]) = (-0.5 * height, 0.5 * height);
    let bounds = found(c, &both, false, &steps)?;
    let at = given(c);
    made(c, at, steps, bounds, false)
}

/// A solid whose places are moved by a formula.
fn moved(c: &mut Call<'_, '_>, q: impl FnOnce(&Expression) -> Expression) -> Run<Value> {
    let shape = c.shape()?;
    if shape.facts().dimension == Dimension::Two {
        return Err(mistake(format!("{}() needs a solid", c.name))
            .help("extrude(...) or revolve(...) makes a solid of a plane shape")
            .at(c.place));
    }
    let steps = steps(c, |builder| builder.field(&shape, &q(&builder.point())))?;
    let bounds = found(c, &shape.facts().bounds, false, &steps)?;
    let at = given(c);
    made(c, at, steps, bounds, false)
}

fn bend_linear(c: &mut Call<'_, '_>) -> Run<Value> {
    let needed = |c: &Call<'_, '_>, name: &str| c.need(name).and_then(|g| c.numbers::<3>(name, g));
    let (start, end) = (needed(c, "start")?, needed(c, "end")?);
    let (offset, ease) = (needed(c, "offset")?, c.ease_or_linear()?);
    apart(c, start, end)?;
    moved(c, |p| {
        let builder = p.builder();
        let offset = builder.vector(&offset.map(|x| builder.constant(x)));
        p - offset * ease.at(&along(p, start, end))
    })
}

fn bend_radial(c: &mut Call<'_, '_>) -> Run<Value> {
    let needed = |c: &Call<'_, '_>, name: &str, least: f64| {
        c.need(name).and_then(|g| c.ranged(name, g, least, LARGE))
    };
    let (inner, outer) = (needed(c, "inner", 0.0)?, needed(c, "outer", SMALL)?);
    let (height, ease) = (needed(c, "height", -LARGE)?, c.ease_or_linear()?);
    if outer <= inner {
        return Err(mistake("`outer` of bend_radial() must be above `inner`").at(c.place));
    }
    moved(c, |p| {
        let away = p.x().hypot(p.z());
        let lift = ease.at(&((away - inner) / (outer - inner))) * height;
        p.builder().vector(&[p.x(), p.y() - lift, p.z()])
    })
}

/// Points (x, y, z).
fn points(c: &mut Call<'_, '_>, param: &str) -> Run<Vec<DVec3>> {
    let given = c.need(param)?;
    let items = c
        .machine
        .collect(given.value)
        .map_err(|m| m.at(given.place))?;
    let points = items.into_iter().map(|value| {
        let p: [f64; 3] = c.numbers(param, Given { value, ..given })?;
        for x in p {
            c.ranged(
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
    });
    let points = points.collect::<Run<Vec<DVec3>>>()?;
    if points.len() < 2 {
        let message = format!(
            "{} must be two points or more, not {}",
            c.called(param),
            points.len()
        );
        return Err(mistake(message).at(given.place));
    }
    if points.windows(2).any(|w| w[0].distance(w[1]) <= SMALL) {
        let message = format!("{} has the same point twice in a row", c.called(param));
        return Err(mistake(message).at(given.place));
    }
    Ok(points)
}

/// Points of the curve through `points` with their place on it: 1.5 is in the middle from the second to the third.
fn curve(points: &[DVec3], closed: bool, steps: u32) -> Vec<(f64, DVec3)> {
    let n = points.len();
    let at = |i: isize| match closed {
        true => points[i.rem_euclid(n as isize) as usize],
        // an end goes on as straight as it came
        false if i < 0 => 2.0 * points[0] - points[1],
        false if i >= n as isize => 2.0 * points[n - 1] - points[n - 2],
        false => points[i as usize],
    };
    let spans = if closed { n } else { n - 1 };
    let mut out = Vec::with_capacity(spans * steps as usize + 1);
    for span in 0..spans {
        let [a, b, c, d] = [-1, 0, 1, 2].map(|k| at(span as isize + k));
        for step in 0..steps {
            let t = f64::from(step) / f64::from(steps);
            let p = 0.5
                * (2.0 * b
                    + (c - a) * t
                    + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t
                    + (3.0 * b - a - 3.0 * c + d) * t * t * t);
            out.push((span as f64 + t, p));
        }
    }
    let end = at(spans as isize);
    out.push((spans as f64, end));
    out
}

fn spline(c: &mut Call<'_, '_>) -> Run<Value> {
    let points = points(c, "points")?;
    let (closed, steps) = (c.flag_or("closed", false)?, c.count_or("steps", 8, 1, 64)?);
    c.machine.grow_items(4 * points.len() * steps as usize)?;
    let points = curve(&points, closed, steps).into_iter().map(|(_, p)| {
        let numbers = p.to_array().map(Value::Float).to_vec();
        c.machine.tuple(numbers)
    });
    let points = points.collect::<Run<Vec<Value>>>()?;
    c.machine.list(points)
}

fn tube(c: &mut Call<'_, '_>) -> Run<Value> {
    let points = points(c, "points")?;
    let (closed, steps) = (c.flag_or("closed", false)?, c.count_or("steps", 8, 1, 64)?);
    let radii = radii(c, points.len())?;
    let n = radii.len();
    let radius = |t: f64| {
        let k = t.floor();
        let (a, b) = (
            radii[k as usize % n],
            radii[(k as usize + 1).min(if closed { n } else { n - 1 }) % n],
        );
        a + (b - a) * (t - k)
    };
    let all = curve(&points, closed, steps);
    let same = radii.iter().all(|r| *r == radii[0]);
    c.machine.grow(64 * all.len())?;
    if same {
        let numbers = all.iter().flat_map(|(_, p)| p.to_array());
        let params: Vec<f64> = [radii[0], all.len() as f64]
            .into_iter()
            .chain(numbers)
            .collect();
        return super::fields::value(c.machine, shape("polyline_tube", params));
    }
    let mut pieces = Vec::with_capacity(all.len());
    for pair in all.windows(2) {
        let ((s, a), (t, b)) = (pair[0], pair[1]);
        c.machine.grow_field(16)?;
        pieces.push(cone(a, b, radius(s), radius(t)).map_err(|e| super::fields::unfit(&e))?);
    }
    super::fields::value(
        c.machine,
        Field::join(Catalogue::union(), Vec::new(), pieces),
    )
}

/// The radius at each point.
fn radii(c: &mut Call<'_, '_>, points: usize) -> Run<Vec<f64>> {
    let Some(given) = c.get("radius") else {
        return Ok(vec![0.1; points]);
    };
    if matches!(given.value, Value::Int(_) | Value::Float(_)) {
        return Ok(vec![c.ranged("radius", given, SMALL, LARGE)?; points]);
    }
    let items = c
        .machine
        .collect(given.value)
        .map_err(|_| c.unfit("radius", "a number, or a list of one for each point", given))?;
    if items.len() != points {
        let message = format!(
            "{} must be a number, or a list of one for each of the {points} points, not {}",
            c.called("radius"),
            items.len()
        );
        return Err(mistake(message).at(given.place));
    }
    let radius = |value| c.ranged("radius", Given { value, ..given }, SMALL, LARGE);
    items.into_iter().map(radius).collect()
}

fn shape(name: &'static str, params: Vec<f64>) -> Result<Field, FieldError> {
    match catalogue().primitive(name) {
        Some(entry) => Field::primitive(entry, params),
        None => Err(FieldError::Unfit {
            entry: name,
            reason: "it is not in the catalogue".into(),
        }),
    }
}

/// A cone with round ends of different radii from `a` to `b`.
fn cone(a: DVec3, b: DVec3, r: f64, s: f64) -> Result<Field, FieldError> {
    let way = b - a;
    let length = way.length();
    // the larger ball holds the smaller one
    if length <= (r - s).abs() * 1.000001 {
        let (p, r) = if r >= s { (a, r) } else { (b, s) };
        return shape("sphere", vec![r])?.place(Placement::moved(p.to_array()));
    }
    let upright = shape("round_cone", vec![r, s, length])?;
    let y = way / length;
    let x = y.any_orthonormal_vector();
    upright.place(placed(DMat3::from_cols(x, y, x.cross(y)), 0.5 * (a + b)))
}

/// A turn, then a move.
fn placed(axes: DMat3, origin: DVec3) -> Placement {
    let columns = axes.to_cols_array_2d();
    Placement {
        rotation: std::array::from_fn(|i| std::array::from_fn(|k| columns[k][i])),
        scale: 1.0,
        offset: origin.to_array(),
        turns: true,
        scales: false,
    }
}

/// Cuts away what lies beyond the plane through `p` with the normal `n`.
fn cut(field: Field, p: DVec3, n: DVec3) -> Result<Field, FieldError> {
    // everything below y = 0
    let x = n.any_orthonormal_vector();
    let half = shape("plane", Vec::new())?.place(placed(DMat3::from_cols(x, n, x.cross(n)), p))?;
    match catalogue().join("intersection") {
        Some(entry) => Field::join(entry, Vec::new(), vec![field, half]),
        None => Ok(field),
    }
}

fn sweep(c: &mut Call<'_, '_>) -> Run<Value> {
    let section = c.shape()?;
    if section.facts().dimension != Dimension::Two {
        return Err(
            mistake("sweep() leads a plane shape along a path, this is a solid")
                .help("such as circle(0.2).sweep([(0, 0, 0), (0, 1, 0), (1, 1, 0)])")
                .at(c.place),
        );
    }
    let path = points(c, "path")?;
    let up = match c.get("up") {
        None => [0.0, 1.0, 0.0],
        Some(given) => c.direction("up", given)?,
    };
    let of = section.facts().bounds;
    let reach = (0..2)
        .map(|k| of.min[k].abs().max(of.max[k].abs()))
        .fold(0.0, f64::hypot);
    if !reach.is_finite() {
        return Err(mistake("sweep() needs a plane shape with ends").at(c.place));
    }
    let closed = path[0].distance(path[path.len() - 1]) <= 1e-9;
    let ways: Vec<DVec3> = path.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
    let lengths: Vec<f64> = path.windows(2).map(|w| w[0].distance(w[1])).collect();
    check_joints(c, &path, &ways, &lengths, reach, closed)?;
    // the shape's axes, led along the path without turning about it
    let first = ways[0];
    let up = DVec3::from(up);
    let y = (up - first * up.dot(first))
        .try_normalize()
        .unwrap_or_else(|| first.any_orthonormal_vector());
    let mut axes = DMat3::from_cols(y.cross(first), y, first);
    let start = axes;
    let extrude = catalogue().modifier("extrude");
    let mut pieces = Vec::with_capacity(ways.len());
    for (i, way) in ways.iter().enumerate() {
        if i > 0 {
            axes = led(ways[i - 1], *way) * axes;
        }
        c.machine.grow_field(64)?;
        let before = if i > 0 {
            Some(ways[i - 1])
        } else {
            closed.then(|| ways[ways.len() - 1])
        };
        let after = ways.get(i + 1).copied().or(closed.then_some(ways[0]));
        // longer than the piece by as much as the cuts take away
        let more = |other: Option<DVec3>| other.map_or(0.0, |o| reach * slant(*way, o));
        let (back, forth) = (more(before), more(after));
        let middle = path[i] + *way * (0.5 * (lengths[i] + forth - back));
        let piece = || -> Result<Field, FieldError> {
            let Some(extrude) = extrude else {
                return Ok(section.clone());
            };
            let height = lengths[i] + back + forth;
            let mut piece = section
                .modify(extrude, vec![height])?
                .place(placed(axes, middle))?;
            if let Some(before) = before {
                piece = cut(piece, path[i], -(before + *way).normalize())?;
            }
            if let Some(after) = after {
                piece = cut(piece, path[i + 1], (*way + after).normalize())?;
            }
            Ok(piece)
        };
        pieces.push(piece().map_err(|e| super::fields::unfit(&e))?);
    }
    let end = led(ways[ways.len() - 1], first) * axes;
    let twist = end
        .x_axis
        .dot(start.x_axis)
        .clamp(-1.0, 1.0)
        .acos()
        .to_degrees();
    if closed && twist > 0.1 {
        return Err(mistake(format!(
            "on its way around this closed path the shape turns by {twist:.1} degrees: its ends do not meet"
        ))
        .help("close paths that lie in a plane, or use tube(points, closed = True) for a round shape")
        .at(c.place));
    }
    super::fields::value(
        c.machine,
        Field::join(Catalogue::union(), Vec::new(), pieces),
    )
}

/// The smallest turn that leads one way to the other.
fn led(from: DVec3, to: DVec3) -> DMat3 {
    DMat3::from_quat(glam::DQuat::from_rotation_arc(from, to).normalize())
}

/// How much farther a piece reaches on the outside of a joint, for each unit from its middle: the tangent of half the angle.
fn slant(a: DVec3, b: DVec3) -> f64 {
    let cosine = a.dot(b).clamp(-1.0, 1.0);
    ((1.0 - cosine) / (1.0 + cosine).max(1e-12)).sqrt()
}

/// Whether every joint leaves something of the pieces beside it.
fn check_joints(
    c: &Call<'_, '_>,
    path: &[DVec3],
    ways: &[DVec3],
    lengths: &[f64],
    reach: f64,
    closed: bool,
) -> Run<()> {
    let n = ways.len();
    let joints = if closed { 0..n } else { 0..n - 1 };
    for i in joints {
        let j = (i + 1) % n;
        if slant(ways[i], ways[j]) * reach > lengths[i].min(lengths[j]) {
            let p = path[i + 1].to_array().map(super::native::spoken);
            return Err(mistake(format!(
                "the path turns too sharply for this shape at ({}, {}, {}): the shape reaches {} from its origin",
                p[0], p[1], p[2], super::native::spoken(reach)
            ))
            .help("use longer pieces, a wider bend (spline() makes one) or a smaller shape")
            .at(c.place));
        }
    }
    Ok(())
}

impl<'a> Machine<'a> {
    /// `ease(t, name)`, of a number or a value of a formula.
    pub(crate) fn call_ease(&mut self, arguments: &[Argument<'a>], place: Place) -> Run<Value> {
        let wrong = || {
            mistake("ease() takes a number and the name of an easing function")
                .help("ease(t, \"in_out_cubic\")")
        };
        let (mut t, mut name) = (None, None);
        for (i, argument) in arguments.iter().enumerate() {
            let at = match argument.name.as_deref() {
                None => i,
                Some(written) => (EASE.params.iter().chain(EASE.optional))
                    .position(|p| *p == written)
                    .ok_or_else(|| wrong().at(argument.place))?,
            };
            match at {
                0 => t = Some(argument.value),
                1 => name = Some((argument.value, argument.place)),
                _ => return Err(wrong().at(argument.place)),
            }
        }
        let t = t.ok_or_else(|| wrong().at(place))?;
        let ease = match name {
            None => named("in_out_cubic")?,
            Some((Value::Text(i), at)) => {
                let word = self.store.text(i).clone();
                named(&word).map_err(|m| m.at(at))?
            }
            Some((_, at)) => return Err(wrong().at(at)),
        };
        let builder = self.formula_of([t]);
        let plain = builder.is_none();
        let builder = builder.unwrap_or_default();
        let value = self.operand(&builder, t)?.filter(|t| t.parts() == 1);
        let value = ease.at(&value.ok_or_else(|| wrong().at(place))?);
        builder.check().map_err(|e| told(&e).at(place))?;
        if plain {
            return self.plain_value(&value, "ease");
        }
        self.formula_value(value)
    }
}
