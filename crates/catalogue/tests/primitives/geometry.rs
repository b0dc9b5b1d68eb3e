//! Proofs of what the value means: its sign, its slope, the empty ball it promises, the distance, the box.

use zeroset_catalogue::bounds::Exactness;

use crate::case::{Case, Failure, along, distance, length};
use crate::entry::Point;

/// The value is at most the membership's: negative inside, positive outside.
pub fn sign(case: &Case<'_>) -> Result<(), Failure> {
    let estimate = case.entry.exactness == Exactness::Estimate;
    let mut silent = 0;
    let places = case.places(3000, 2);
    for &p in &places {
        let (value, inside) = (case.value(p), case.contains(p));
        if !value.is_finite() {
            return Err(case.fail("sign", format!("{value} at {p:?}")));
        }
        if value.abs() <= case.band() {
            silent += 1;
        } else if (value < 0.0) != inside && !(estimate && inside) {
            return Err(case.fail(
                "sign",
                format!(
                    "{value} at {p:?}, which is {}",
                    if inside { "inside" } else { "outside" }
                ),
            ));
        }
    }
    if silent > places.len() / 5 {
        return Err(case.fail(
            "sign",
            format!("zero at {silent} of {} places", places.len()),
        ));
    }
    Ok(())
}

/// Near pairs: `|f(p) - f(q)| <= L |p - q|`. (Far pairs alone would miss errors of a few percent.)
pub fn slope(case: &Case<'_>) -> Result<(), Failure> {
    let mut random = case.random(3);
    for p in case.places(3000, 4) {
        let value = case.value(p);
        for i in 0..3 {
            let way = if i == 0 {
                case.upwards(p)
            } else {
                random.direction()
            };
            let step = random.scale(1e-4, 1e-1) * case.size;
            let other = case.value(along(p, way, step));
            let allowed = case.lipschitz * step * (1.0 + 1e-9) + 1e-11 * (case.size + length(p));
            // Not `>`: a value that is no number must fail.
            if !((value - other).abs() <= allowed) {
                let slope = (value - other).abs() / step;
                return Err(case.fail(
                    "slope",
                    format!(
                        "{slope} over {step:.2e} at {p:?}, stated {}",
                        case.lipschitz
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// No point nearer than `|f(p)| / L` is on the other side.
pub fn empty_ball(case: &Case<'_>) -> Result<(), Failure> {
    let mut random = case.random(5);
    for p in case.places(800, 6) {
        let radius = case.value(p).abs() / case.lipschitz * (1.0 - 1e-6) - case.band();
        if radius <= 0.0 {
            continue;
        }
        if let Some(s) = case.surface.iter().find(|&&s| distance(p, s) < radius) {
            let d = distance(p, *s);
            return Err(case.fail(
                "empty ball",
                format!("radius {radius} at {p:?}, surface at {d}, {s:?}"),
            ));
        }
        let inside = case.contains(p);
        for i in 0..8 {
            let way = match i {
                0 => case.upwards(p),
                1 => case.upwards(p).map(|x| -x),
                _ => random.direction(),
            };
            let q = along(
                p,
                way,
                if i < 6 {
                    radius
                } else {
                    radius * random.unit()
                },
            );
            if case.contains(q) != inside {
                return Err(case.fail(
                    "empty ball",
                    format!("radius {radius} at {p:?}, but {q:?} is on the other side"),
                ));
            }
        }
    }
    Ok(())
}

/// How much longer the true distance may be than the value that claims to be exact, relative to the value and to the size.
/// (How much shorter is [`empty_ball`]'s and [`slope`]'s.)
const SHORT: (f64, f64) = (1e-3, 1e-5);

/// For exact distances: a point of the other side lies at the value's distance. With [`empty_ball`] this pins the value.
pub fn reached(case: &Case<'_>) -> Result<(), Failure> {
    if case.entry.exactness > Exactness::Outside {
        return Ok(());
    }
    let mut random = case.random(7);
    for p in case.places(500, 8) {
        let (value, inside) = (case.value(p), case.contains(p));
        if case.entry.exactness == Exactness::Outside && inside {
            continue;
        }
        let slack = SHORT.0 * value.abs() + SHORT.1 * case.size;
        let witness =
            |q: Point| distance(p, q) <= value.abs() + 1.001 * slack && case.contains(q) != inside;
        let mut found = false;
        // At ridges, of which the special places have many, the way down is only known beside the place.
        for attempt in 0..24 {
            let beside = along(
                p,
                random.direction(),
                if attempt == 0 { 0.0 } else { 0.3 * slack },
            );
            let down = case.upwards(beside).map(|x| -x * value.signum());
            let foot = along(p, down, value.abs());
            // A sharp tip is touched by the ball but not entered by the way down: look towards the other side's points.
            let other = if inside { &case.outside } else { &case.inside };
            found = witness(along(foot, down, slack))
                || {
                    let mut near: Vec<Point> = other.clone();
                    let n = near.len().min(12);
                    if n > 0 {
                        near.select_nth_unstable_by(n - 1, |a, b| {
                            distance(foot, *a).total_cmp(&distance(foot, *b))
                        });
                    }
                    near.truncate(n);
                    near.iter().any(|&q| {
                        let way = std::array::from_fn(|k| q[k] - foot[k]);
                        let r = length(way).max(slack);
                        witness(along(foot, way, slack / r))
                    })
                }
                || (0..40).any(|_| witness(along(foot, random.direction(), slack * random.unit())));
            if found {
                break;
            }
        }
        if !found {
            let nearest = case
                .surface
                .iter()
                .map(|&s| distance(p, s))
                .fold(f64::INFINITY, f64::min);
            return Err(case.fail(
                "distance",
                format!("{value} at {p:?} is too short: nothing of the other side there, nearest sample at {nearest}"),
            ));
        }
    }
    Ok(())
}

/// The boxes of level sets hold them.
pub fn levels(case: &Case<'_>) -> Result<(), Failure> {
    let mut random = case.random(14);
    for part in [0.02, 0.1, 0.4, 1.5] {
        let level = part * case.size;
        let holds = (case.entry.level_bounds)(&case.params, level).grow(1e-9 * case.size);
        let window = case.core.grow(level + case.size);
        for _ in 0..1500 {
            let p = random.point(&window);
            let value = case.value(p);
            if value <= level && !holds.contains(p) {
                return Err(case.fail(
                    "levels",
                    format!("{value} at {p:?} is at most {level}, which is not in {holds:?}"),
                ));
            }
        }
    }
    Ok(())
}

/// The box holds the solid and little more.
pub fn bounds(case: &Case<'_>) -> Result<(), Failure> {
    let mut random = case.random(9);
    let holds = case.bounds.grow(1e-9 * case.size);
    let window = case.core.grow(0.5 * case.size);
    let stray = |p: Point| {
        case.fail(
            "bounds",
            format!("{p:?} is inside but not in {:?}", case.bounds),
        )
    };
    for _ in 0..4000 {
        let p = random.point(&window);
        if !holds.contains(p) && case.contains(p) {
            return Err(stray(p));
        }
    }
    if let Some(&p) = case
        .surface
        .iter()
        .chain(&case.inside)
        .find(|&&p| case.contains(p) && !holds.contains(p))
    {
        return Err(stray(p));
    }
    for axis in 0..3 {
        if !(case.bounds.min[axis].is_finite() && case.bounds.max[axis].is_finite()) {
            continue;
        }
        let reach = [-1.0, 1.0].map(|way| {
            // Climb from the farthest point known.
            let start = case
                .surface
                .iter()
                .chain(&case.inside)
                .copied()
                .filter(|&p| case.contains(p));
            let mut best = start
                .max_by(|a, b| (way * a[axis]).total_cmp(&(way * b[axis])))
                .unwrap_or([0.0; 3]);
            for i in 0..400 {
                let mut q = along(best, random.direction(), case.size * 0.1 * 0.98_f64.powi(i));
                q[axis] = best[axis] + way * (q[axis] - best[axis]).abs();
                if case.contains(q) {
                    best = q;
                }
            }
            best
        });
        if let Some(&p) = reach.iter().find(|&&p| !holds.contains(p)) {
            return Err(stray(p));
        }
        let (side, solid) = (
            case.bounds.max[axis] - case.bounds.min[axis],
            reach[1][axis] - reach[0][axis],
        );
        if side > case.entry.slack * solid + 1e-3 * case.size {
            return Err(case.fail(
                "bounds",
                format!("side {axis} is {side}, the solid reaches over {solid}"),
            ));
        }
    }
    Ok(())
}
