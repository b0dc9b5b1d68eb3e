// Eleven cones: how far each is clear of everything, and what its neighbours say of those that are blocked. The twin of
// `ao/cones.rs` of the CPU renderer, which tells how it works.

const CONES: u32 = 11u;
/// The first of them are the ring around the normal, the others that along the horizon.
const CONES_HIGH: u32 = 4u;
// The numbers of the two rings: cosines to the normal, shares of the sky, widths of an edge.
const CONE_COSINES: vec2f = vec2f(0.88, 0.49);
const CONE_SHARES: vec2f = vec2f(0.13565, 0.06534286);
const CONE_WIDTH: vec2f = vec2f(1.075, 0.9);
/// Sine of the clearance that is wholly open.
const CONE_FULL: f32 = 0.465;
/// How far, measured as the distances between directions are, wholly open is.
const CONE_EXTENT: f32 = 0.43;
/// Near an edge, up to this share of its width, an open cone counts on its neighbours as a blocked one does.
const CONE_CLOSENESS: f32 = 0.2;
/// From this share of wholly open on a clearance says all it can of the directions beside it.
const CONE_TELLING: f32 = 0.2;
/// Sine of the clearance that is none.
const CONE_BLOCKED: f32 = 0.05;
/// Steps are as short as an edge at this share of the clearance found so far asks for.
const CONE_CARE: f32 = 0.45;
/// A cone ends where the scene leaves it this share of what is wholly open.
const CONE_SURE: f32 = 0.75;
/// The first sample is this many offsets from the origin.
const CONE_START: f32 = 4.0;
/// Cones begin this share of the touching ball's radius times their cosine from the origin.
const CONE_FREE: f32 = 1.2;
/// From one touching ball to the next, and how well its radius is known.
const BALL_GROWTH: f32 = 8.0;
const BALL_NARROW: f32 = 2.0;
/// A ball that has all but this share of its radius is empty.
const BALL_EMPTY: f32 = 0.999998;
/// More balls than any scene needs.
const BALLS: u32 = 64u;
/// Smoothing of the slope along a cone, share of the step that would just do, steepest slope.
const OPEN_SMOOTHING: f32 = 0.3;
const CONE_SHARE: f32 = 0.95;
const CONE_STEEPEST: f32 = 0.98;
/// The cones are made around this direction and turned from it to the normal the shortest way. It is the opposite of no face
/// that anybody builds, and only there the shortest way is not known.
const CONE_AXIS: vec3f = vec3f(0.2696803, 0.8989344, 0.3451908);

/// The number of cone `k` out of those of the rings.
fn of_ring(k: u32, numbers: vec2f) -> f32 {
    return select(numbers.y, numbers.x, k < CONES_HIGH);
}

/// Cone number `k`, around the axis.
fn cone_direction(k: u32) -> vec3f {
    let low = (f32(k) - f32(CONES_HIGH) + 0.25) / f32(CONES - CONES_HIGH);
    let angle = select(low, f32(k) / f32(CONES_HIGH), k < CONES_HIGH) * 6.2831855;
    let c = of_ring(k, CONE_COSINES);
    return basis(CONE_AXIS) * (sqrt(1.0 - c * c) * vec2f(cos(angle), sin(angle))) + CONE_AXIS * c;
}

/// `w`, turned with the rotation that takes the axis to `n` the shortest way.
fn turn_cone(n: vec3f, w: vec3f) -> vec3f {
    let v = cross(CONE_AXIS, n);
    let once = cross(v, w);
    return w + once + cross(v, once) / max(dot(CONE_AXIS, n) + 1.0, 1e-4);
}

/// The share that is open of a cone whose axis is `depth` widths before an edge: 0 at -1, 1 at 1.
fn cone_seen(depth: f32) -> f32 {
    let x = clamp(depth * 0.5 + 0.5, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

/// Radius of a ball that touches the origin and is empty, `far` if it may be as large as that.
fn touching_ball(at: Surface, origin: vec3f, far: f32) -> f32 {
    var large = 0.0;
    // the least radius that is known not to be empty; 0 where none is
    var least = 0.0;
    var t = min(at.offset * CONE_START, far);
    for (var k = 0u; k < BALLS; k++) {
        if (around(at, origin + at.normal * t) > t * BALL_EMPTY) {
            large = t;
        } else {
            least = t;
        }
        if (least > 0.0) {
            if (!(large > 0.0 && least > large * BALL_NARROW)) {
                break;
            }
            t = sqrt(large) * sqrt(least);
        } else {
            if (large >= far) {
                break;
            }
            t = min(t * BALL_GROWTH, far);
        }
    }
    return large;
}

/// Steps that a cone may take beyond its own to find out what it touched.
const CONE_MORE: u32 = 64u;

/// Sine of the largest clear angle around a ray from `start` to `end`, at most `CONE_FULL`; 0 if something is hit.
fn cone_clearance(at: Surface, ray: Ray, start: f32, end: f32, cosine: f32, steps: u32) -> f32 {
    var t = start;
    var stride = 0.0;
    var before = 0.0;
    var slope = cosine;
    var least = CONE_FULL;
    var rise = 1.0;
    let skins = has_skins();
    let touch = skin_touch(at);
    // whether something is in the way, and whether the cone has touched it: from there on only what it hits blocks it
    var black = false;
    var touched = false;
    for (var k = 0u; k < steps + select(0u, CONE_MORE, black); k++) {
        let f = around(at, ray.origin + ray.direction * t);
        if (stride > 0.0) {
            rise = clamp((f - before) / max(stride, 1e-20), -1.0, 1.0);
        }
        // where the balls around two samples do not touch there may be something between them: back to where they do
        if (stride > before && before + f < stride && (!skins || stride > touch)) {
            t += before - stride;
            stride = before;
            slope = -1.0;
            continue;
        }
        black = black || !(f > CONE_BLOCKED * t);
        if (black) {
            // it may be a skin: the cone goes on until it touches something or moves away, and where it touched, until it is
            // behind a surface
            let touches = f < touch;
            let leaves = !touched && !touches && stride > 0.0 && f > before;
            if (!skins || f < touch * SKIN_BEHIND || leaves) {
                return 0.0;
            }
            touched = touched || touches;
        }
        least = min(least, f / t);
        if (t >= end) {
            return select(least, CONE_FULL, touched);
        }
        if (stride > 0.0) {
            slope = mix(slope, rise, OPEN_SMOOTHING);
        }
        slope = min(slope, CONE_STEEPEST);
        let edge = select(CONE_CARE * max(least, 0.0), 0.0, touched);
        // where a skin may be touched, no step leads past it
        let reach = 2.0 * CONE_SHARE * (f - edge * t) / (1.0 - slope + 2.0 * edge);
        stride = min(max(max(f, select(0.0, touch, black)), select(reach, 0.0, black && !touched)), end - t);
        before = f;
        t += stride;
    }
    // as it went last: then f / t tends to the slope
    // one that was out of steps while it touched something did not get through
    return select(select(min(least, max(rise, 0.0)), 0.0, touched), CONE_FULL, touched && before > touch);
}

fn ao_cones(at: Surface, how: Occluder) -> Openness {
    let origin = at.point + at.normal * at.offset;
    let far = min(how.reach, frame.far);
    let ball = touching_ball(at, origin, far);
    if (ball >= far) {
        return Openness(1.0, at.normal);
    }
    var to: array<vec3f, CONES>;
    var clear: array<f32, CONES>;
    for (var k = 0u; k < CONES; k++) {
        let ray = Ray(origin, turn_cone(at.normal, cone_direction(k)));
        let cosine = of_ring(k, CONE_COSINES);
        let start = max(at.offset * CONE_START, ball * (CONE_FREE * cosine));
        let end = max(min(leave(ray, CONE_SURE * CONE_FULL, at.offset), far), start);
        let sine = cone_clearance(at, ray, start, end, cosine, u32(how.count));
        to[k] = ray.direction;
        clear[k] = CONE_EXTENT * clamp((sine - CONE_BLOCKED) / (CONE_FULL - CONE_BLOCKED), 0.0, 1.0);
    }
    var open = 0.0;
    var bent = at.normal * 1e-3;
    for (var k = 0u; k < CONES; k++) {
        var behind = -CONE_WIDTH.x;
        for (var j = 0u; j < CONES; j++) {
            if (j != k) {
                let says = clamp(clear[j] / (CONE_TELLING * CONE_EXTENT), 0.0, 1.0);
                behind = max(behind, mix(-CONE_WIDTH.x, clear[j] - distance(to[j], to[k]), says));
            }
        }
        behind = min(behind, 0.0) / CONE_WIDTH.x;
        let width = of_ring(k, CONE_WIDTH);
        let before = clear[k] / width;
        let close = max(1.0 - before / CONE_CLOSENESS, 0.0);
        let share = cone_seen(before + behind * close) * of_ring(k, CONE_SHARES) / cone_seen(CONE_EXTENT / width);
        open += share;
        bent += to[k] * share;
    }
    // with all cones open the sum is 1 up to rounding
    return Openness(min(open * 1.000002, 1.0), normalize(bent));
}
