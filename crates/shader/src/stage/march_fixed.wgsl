// Constant steps, then false position where the sign changes (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).

fn march(ray: Ray, start: f32, end: f32, slope: f32) -> Found {
    var t = start;
    var z = 0.0;
    var r = 0.0;
    var side = 1.0;
    // whether the sign has changed, where, and how often that was sampled
    var crossed = false;
    var part = Bracket();
    var refined = 0u;
    for (var steps = 1u; steps <= frame.max_steps; steps++) {
        let to = t + z;
        let p = ray.origin + ray.direction * to;
        var next = side * field(p);
        if (crossed) {
            let settled = bracket_settled(part, to, next, max(footprint(ray, to) * SETTLED, to * EPSILON));
            part = bracket_narrowed(part, to, next);
            refined += 1u;
            if (settled || refined == REFINEMENTS) {
                return Found(true, bracket_root(part), 0.0, side, steps - refined, refined);
            }
            t = bracket_guess(part, refined);
            continue;
        }
        if (steps == 1u) {
            side = select(1.0, -1.0, next < 0.0);
            next *= side;
        } else if (next < behind_surface(p) || (next < 0.0 && r < 0.0)) {
            part = Bracket(t, max(r, 0.0), to, next, 0.0);
            t = bracket_root(part);
            z = 0.0;
            crossed = true;
            continue;
        }
        t = to;
        r = next;
        if (t >= end) {
            return Found(false, t, r, side, steps, 0u);
        }
        z = min(frame.march, end - t);
    }
    if (crossed) {
        return Found(true, bracket_root(part), 0.0, side, frame.max_steps - refined, refined);
    }
    return Found(false, t, r, side, frame.max_steps, 0u);
}
