// Constant steps, then bisection of the sign change (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).

/// Where a ray ended.
struct Found {
    hit: bool,
    t: f32,
    /// Value of the field, from the side that was marched.
    f: f32,
    /// 1, or -1 where the ray began inside the solid.
    side: f32,
    steps: u32,
}

fn march(ray: Ray, start: f32, end: f32, slope: f32) -> Found {
    var t = start;
    var z = 0.0;
    var r = 0.0;
    var side = 1.0;
    var halving = false;
    // the other end of the step in which the sign changes
    var inside = 0.0;
    var best = vec3f(FAR, start, 0.0);
    for (var steps = 1u; steps <= frame.max_steps; steps++) {
        let at = select(t + z, 0.5 * (t + inside), halving);
        var next = side * field(ray.origin + ray.direction * at);
        if (steps == 1u) {
            side = select(1.0, -1.0, next < 0.0);
            next *= side;
        }
        if (halving) {
            if (next < 0.0) {
                inside = at;
            } else {
                t = at;
            }
            if (!(inside - t >= threshold(inside))) {
                return Found(true, at, next, side, steps);
            }
            continue;
        }
        if (next < 0.0) {
            halving = true;
            inside = at;
            if (!(inside - t >= threshold(inside))) {
                return Found(true, t, r, side, steps);
            }
            continue;
        }
        t = at;
        r = next;
        let size = abs(r) / threshold(t);
        if (size < best.x) {
            best = vec3f(size, t, r);
        }
        if (t >= end) {
            return Found(false, t, r, side, steps);
        }
        z = min(frame.march, end - t);
    }
    if (frame.hit_selection != 0u) {
        return Found(true, best.y, best.z, side, frame.max_steps);
    }
    return Found(true, select(t, 0.5 * (t + inside), halving), r, side, frame.max_steps);
}
