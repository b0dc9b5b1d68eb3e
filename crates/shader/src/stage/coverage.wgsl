// Antialiasing by coverage: pixels that an edge goes through are parted. The twin of `trace/coverage.rs` and `shade/coverage.rs`.

/// A convex part of a pixel: its corners in order, in pixels from the pixel's middle.
struct Part {
    corners: array<vec2f, COVERAGE_CORNERS>,
    count: u32,
}

/// Its area, and its middle.
fn part_measure(part: ptr<function, Part>) -> vec3f {
    if ((*part).count == 0u) {
        return vec3f(0.0);
    }
    let first = (*part).corners[0];
    var twice = 0.0;
    var sum = vec2f(0.0);
    for (var k = 2u; k < (*part).count; k++) {
        let a = (*part).corners[k - 1u] - first;
        let b = (*part).corners[k] - first;
        let area = a.x * b.y - a.y * b.x;
        twice += area;
        sum += (a + b) * area;
    }
    if (twice <= 0.0) {
        return vec3f(0.0, first);
    }
    return vec3f(0.5 * twice, first + sum / (3.0 * twice));
}

/// How far its corners are from a place at most.
fn part_reach(part: ptr<function, Part>, place: vec2f) -> f32 {
    var reach = 0.0;
    for (var k = 0u; k < (*part).count; k++) {
        reach = max(reach, length((*part).corners[k] - place));
    }
    return reach;
}

/// What of it is on the side of a line where `value + slope . (p - place)` is not negative.
fn part_side(part: ptr<function, Part>, value: f32, slope: vec2f, place: vec2f) -> Part {
    var side = Part();
    for (var k = 0u; k < (*part).count; k++) {
        let a = (*part).corners[k];
        let b = (*part).corners[select(k + 1u, 0u, k + 1u == (*part).count)];
        let at_a = value + dot(slope, a - place);
        let at_b = value + dot(slope, b - place);
        if (at_a >= 0.0 && side.count < COVERAGE_CORNERS) {
            side.corners[side.count] = a;
            side.count += 1u;
        }
        if ((at_a >= 0.0) != (at_b >= 0.0) && side.count < COVERAGE_CORNERS) {
            side.corners[side.count] = a + (b - a) * (at_a / (at_a - at_b));
            side.count += 1u;
        }
    }
    return side;
}

/// A cone on its way: see `zeroset_shade::coverage::Cone`.
struct Cone {
    t: f32,
    z: f32,
    f: f32,
    slope: f32,
    low: f32,
    at: f32,
    high: f32,
    free: f32,
}

const CONE_ON: u32 = 0u;
const CONE_COVERED: u32 = 1u;
const CONE_EDGE: u32 = 2u;
const CONE_CLEAR: u32 = 3u;

/// Looks at the sample `f` of a cone. The twin of `zeroset_shade::coverage::watch`.
fn watch(cone: ptr<function, Cone>, f: f32, radius: f32, end: f32, first: bool) -> u32 {
    let old = *cone;
    let z = abs(old.z);
    let fine = radius * COVERAGE_FINE;
    let to = old.t + z;
    let before = max(old.f - radius, 0.0);
    let here = f - radius;
    let gap = z > before + here;
    let guessed = old.z < 0.0;
    let surprised = f - old.f - old.slope * z > radius * COVERAGE_SURPRISE;
    let least = max(before, fine);
    if (!first && z > least * 1.001 && ((guessed && surprised) || (!guessed && before > 0.0 && gap))) {
        let rest = max(end - old.t, fine * 0.01);
        (*cone).z = clamp(select(least, -0.25 * z, guessed && 0.25 * z > least), -rest, rest);
        return CONE_ON;
    }
    let slope = select(clamp((f - old.f) / max(z, 1e-20), -1.0, 1.0), old.slope, first);
    let share = f / max(radius, LEAST_NORMAL);
    let near = share < 1.0;
    let falling = old.high < COVERAGE_FALLING || share < old.high - COVERAGE_FALL;
    if (share < old.low || !falling) {
        (*cone).low = share;
        (*cone).at = to;
    }
    let met = falling && (*cone).low < 1.0;
    (*cone).t = to;
    (*cone).f = f;
    (*cone).slope = slope;
    (*cone).high = select(max(old.high, share), 2.0 * COVERAGE_FALLING, falling);
    let chained = first || (!gap && old.free >= old.t);
    if (!near && chained) {
        (*cone).free = to;
    }
    if (!first && share < select(COVERAGE_SOLID, COVERAGE_FRACTAL, is_fractal())) {
        return CONE_COVERED;
    }
    let ended = !(to < end);
    if (met && (ended || share > (*cone).low + COVERAGE_RISE)) {
        return CONE_EDGE;
    }
    if (ended) {
        return select(CONE_COVERED, CONE_CLEAR, chained);
    }
    let bend = abs(slope - old.slope) / max(z, fine);
    let straight = sqrt(radius * COVERAGE_BENT / max(bend, 1e-12));
    let covers = (f + radius * COVERAGE_BEYOND) / max(-slope, 1e-6);
    var ahead = min(straight, 2.0 * max(z, radius * COVERAGE_NEAR));
    if (slope < 0.0) {
        ahead = min(ahead, covers);
    }
    let sure = max(slope_step(max(here, 0.0), min(slope, STEEPEST)) * COVERAGE_SURE, fine);
    let rest = max(end - to, fine * 0.01);
    (*cone).z = clamp(select(sure, -ahead, share < COVERAGE_NEAR && ahead > sure), -rest, rest);
    return CONE_ON;
}

/// The ray through a place of a pixel, from its middle, that shows so much of it from `start` on.
fn part_ray(own: Onward, place: vec2f, share: f32, start: f32) -> Onward {
    var part = own;
    part.ray = camera_ray(vec2f(own.pixel) + 0.5 + place);
    part.weight = vec3f(share);
    part.start = start;
    part.slope = select(-1.0, own.slope, start == own.start);
    return part;
}

/// Leaves the rays from the eye of a pixel in `waiting`, and gives how many there are. `own` is the ray through its middle.
fn parts_of_pixel(own: Onward, waiting: ptr<function, array<Onward, WAITING>>) -> u32 {
    (*waiting)[0] = own;
    if (frame.layers == 0u) {
        return 1u;
    }
    var rest = Part();
    rest.count = 4u;
    rest.corners[0] = vec2f(-0.5, -0.5);
    rest.corners[1] = vec2f(0.5, -0.5);
    rest.corners[2] = vec2f(0.5, 0.5);
    rest.corners[3] = vec2f(-0.5, 0.5);
    var share = 1.0;
    var middle = vec2f(0.0);
    var start = own.start;
    var side = 0.0;
    var count = 0u;
    var layers = frame.layers;
    var passes = 0u;
    var slope = own.slope;
    loop {
        let ray = camera_ray(vec2f(own.pixel) + 0.5 + middle);
        let narrow = select(1.0, sqrt(ray.narrow), frame.pinhole != 0u);
        let wide = part_reach(&rest, middle) * narrow * frame.pixel;
        let end = min(min(leave(ray, wide.x + frame.threshold.x, wide.y + frame.threshold.y), frame.far), own.end);
        let from_here = max(max(enter(ray, wide.x + frame.threshold.x, wide.y + frame.threshold.y), frame.near), start);
        var cone = Cone(from_here, 0.0, 0.0, slope, 0.0, 0.0, COVERAGE_UNSEEN, from_here);
        var is_horizon = false;
        var outcome = select(CONE_CLEAR, CONE_ON, cone.t < end);
        for (var steps = 1u; outcome == CONE_ON; steps++) {
            let to = cone.t + abs(cone.z);
            let value = field(ray.origin + ray.direction * to);
            counted[COUNT_MARCH] += 1u;
            if (side == 0.0) {
                side = select(1.0, -1.0, value < 0.0);
            }
            let radius = wide.x * to + wide.y + frame.rounding.x * to + frame.rounding.y;
            outcome = watch(&cone, side * value, radius, end, steps == 1u);
            if (outcome == CONE_ON && steps >= COVERAGE_STEPS) {
                // a plane comes ever nearer until the horizon
                is_horizon = cone.f > 0.0 && wide.x > 0.0 && abs(cone.slope) < wide.x;
                outcome = select(CONE_COVERED, CONE_EDGE, is_horizon);
            }
        }
        if (outcome == CONE_CLEAR) {
            start = FAR;
        }
        if (outcome == CONE_COVERED) {
            start = cone.free;
        }
        if (outcome != CONE_EDGE || gives_up()) {
            break;
        }
        let there = field_gradient(ray.origin + ray.direction * cone.at) * side;
        counted[COUNT_MARCH] += 1u;
        // the side of a pixel on the plane through the place
        let pixel = frame.scale * select(1.0, -cone.at * dot(ray.direction, frame.back), frame.pinhole != 0u);
        let rise = pixel * vec2f(dot(there.yzw, frame.right), -dot(there.yzw, frame.up));
        let value = select(there.x, cone.at * dot(there.yzw, ray.direction), is_horizon);
        let behind = select(cone.t, FAR, is_horizon);
        var covered = part_side(&rest, -value, -rise, middle);
        var elsewhere = part_side(&rest, value, rise, middle);
        let shown = part_measure(&covered);
        let left = part_measure(&elsewhere);
        // numbers that are none are no edge
        if (!(left.x >= COVERAGE_SMALLEST && shown.x + left.x > 0.0)) {
            break;
        }
        slope = -1.0;
        if (shown.x < COVERAGE_SMALLEST) {
            start = behind;
            passes += 1u;
            if (passes > COVERAGE_PASSES) {
                break;
            }
            continue;
        }
        (*waiting)[count] = part_ray(own, shown.yz, shown.x, start);
        count += 1u;
        rest = elsewhere;
        share = left.x;
        middle = left.yz;
        start = behind;
        layers -= 1u;
        if (layers == 0u) {
            break;
        }
    }
    if (count == 0u && start == own.start) {
        return 1u;
    }
    (*waiting)[count] = part_ray(own, middle, share, start);
    return count + 1u;
}
