// Constant steps, then false position where the sign changes (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).

/// Guesses of where the sign changes, between places where it has.
const REFINEMENTS: u32 = 10u;

fn march(ray: Ray, start: f32, end: f32, slope: f32) -> Found {
    var t = start;
    var z = 0.0;
    var r = 0.0;
    var side = 1.0;
    // how often the place of the change of sign is still guessed, and where it is
    var left = 0u;
    var part = Bracket();
    for (var steps = 1u; steps <= frame.max_steps; steps++) {
        let to = t + z;
        let p = ray.origin + ray.direction * to;
        var next = side * field(p);
        if (left > 0u) {
            part = bracket_narrowed(part, to, next);
            t = bracket_root(part);
            z = 0.0;
            left -= 1u;
            if (left == 0u) {
                return Found(true, t, 0.0, side, steps - REFINEMENTS);
            }
            continue;
        }
        if (steps == 1u) {
            side = select(1.0, -1.0, next < 0.0);
            next *= side;
        } else if (next < behind_surface(p) || (next < 0.0 && r < 0.0)) {
            part = Bracket(t, max(r, 0.0), to, next, 0.0);
            t = bracket_root(part);
            z = 0.0;
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
    return Found(left > 0u, t, select(r, 0.0, left > 0u), side, frame.max_steps);
}
