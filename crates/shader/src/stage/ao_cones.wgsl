// Eleven cones: how far each is clear of everything, and what its neighbours say of those that are blocked. The twin of
// `ao/cones.rs` of the CPU renderer, which tells how it works.

/// The number of cone `k` out of those of the rings.
fn of_ring(k: u32, numbers: vec2f) -> f32 {
    return select(numbers.y, numbers.x, k < CONES_HIGH);
}

/// More balls than any scene needs.
const BALLS: u32 = 64u;

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

/// Sine of the largest clear angle around a ray from `start` to `end`, at most `CONE_FULL`; 0 if something is hit.
fn cone_clearance(at: Surface, ray: Ray, start: f32, end: f32, cosine: f32, steps: u32) -> f32 {
    var t = start;
    var stride = 0.0;
    var before = 0.0;
    var slope = cosine;
    var least = CONE_FULL;
    var rise = 1.0;
    let skins = has_skins();
    let touch = skin_touch(at.point, at.offset);
    // whether something is in the way, and whether the cone has touched it: from there on only what it hits blocks it
    var black = false;
    var touched = false;
    for (var k = 0u; k < steps + select(0u, CONE_MORE, black); k++) {
        let f = around(at, ray.origin + ray.direction * t);
        if (stride > 0.0) {
            rise = slope_between(before, f, stride);
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
            slope = mix(slope, rise, SECONDARY_SMOOTHING);
        }
        slope = min(slope, SECONDARY_STEEPEST);
        let edge = select(CONE_CARE * max(least, 0.0), 0.0, touched);
        // where a skin may be touched, no step leads past it
        let reach = secondary_step(f, t, slope, edge);
        stride = min(max(max(f, select(0.0, touch, black)), select(reach, 0.0, black && !touched)), end - t);
        before = f;
        t += stride;
    }
    // as it went last: then f / t tends to the slope
    // one that was out of steps while it touched something did not get through
    return select(select(min(least, max(rise, 0.0)), 0.0, touched), CONE_FULL, touched && before > touch);
}

fn ao_cones(at: Surface, how: Occluder) -> AmbientVisibility {
    let origin = at.point + at.normal * at.offset;
    let far = min(how.reach, frame.far);
    let ball = touching_ball(at, origin, far);
    if (ball >= far) {
        return AmbientVisibility(1.0, at.normal, vec3f(1.0));
    }
    var to: array<vec3f, CONES>;
    var clear: array<f32, CONES>;
    for (var k = 0u; k < CONES; k++) {
        let ray = ray_from(origin, turn_cone(at.normal, cone_direction(f32(k))));
        let cosine = of_ring(k, CONE_COSINES);
        let start = max(at.offset * CONE_START, ball * (CONE_FREE * cosine));
        let end = max(min(leave(ray, CONE_SURE * CONE_FULL, at.offset), far), start);
        let sine = cone_clearance(at, ray, start, end, cosine, u32(how.count));
        to[k] = ray.direction;
        clear[k] = cone_clear(sine);
    }
    var open = 0.0;
    var bent = at.normal * CONE_NORMAL_SHARE;
    for (var k = 0u; k < CONES; k++) {
        var behind = -CONE_WIDTH.x;
        for (var j = 0u; j < CONES; j++) {
            if (j != k) {
                behind = max(behind, cone_left(clear[j], distance(to[j], to[k])));
            }
        }
        let weight = of_ring(k, vec2f(CONE_WEIGHT_HIGH, CONE_WEIGHT_LOW));
        let share = cone_share(clear[k], behind, of_ring(k, 1.0 / CONE_WIDTH), weight);
        open += share;
        bent += to[k] * share;
    }
    return AmbientVisibility(cone_open(open), normalize(bent), vec3f(1.0));
}
