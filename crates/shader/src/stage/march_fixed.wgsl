// Constant steps, then false position where the sign changes (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).

/// Where a ray ended.
struct Found {
    hit: bool,
    t: f32,
    /// Value of the field where it was found under the footprint, from the side that was marched; 0 where it changed its sign.
    f: f32,
    /// 1, or -1 where the ray began inside the solid.
    side: f32,
    steps: u32,
}

/// Guesses of where the sign changes, between places where it has.
const REFINEMENTS: u32 = 10u;

fn march(ray: Ray, start: f32, end: f32, slope: f32) -> Found {
    var t = start;
    var z = 0.0;
    var r = 0.0;
    var side = 1.0;
    var left = 0u;
    var inside = vec2f(0.0);
    for (var steps = 1u; steps <= frame.max_steps; steps++) {
        let to = t + z;
        let p = ray.origin + ray.direction * to;
        var next = side * field(p);
        if (left > 0u) {
            if (next < 0.0) {
                inside = vec2f(to, next);
                r *= 0.5;
            } else {
                t = to;
                r = next;
                inside.y *= 0.5;
            }
            z = sign_change(t, r, inside) - t;
            left -= 1u;
            if (left == 0u) {
                return Found(true, t + z, 0.0, side, steps - REFINEMENTS);
            }
            continue;
        }
        if (steps == 1u) {
            side = select(1.0, -1.0, next < 0.0);
            next *= side;
        } else if (next < behind_surface(p) || (next < 0.0 && r < 0.0)) {
            r = max(r, 0.0);
            inside = vec2f(to, next);
            z = sign_change(t, r, inside) - t;
            left = REFINEMENTS;
            continue;
        }
        t = to;
        r = next;
        if (t >= end) {
            return Found(false, t, r, side, steps);
        }
        z = min(frame.march, end - t);
    }
    return Found(false, t, r, side, frame.max_steps);
}
