// Primary rays. Every marcher evaluates the field in one place only: a driver copies the whole field there.
//
// A ray ends where the field changes its sign. Near the surface it guesses where that is, from the slope between its last
// two samples. Least steps along a surface are not proven any more, nor are tiny ones towards it: a body that is not longer
// than that along the ray may be passed.

/// Marches a ray from `start` to `end`. `slope` is the field's slope along it, as far as it is known.
fn march(ray: Ray, start: f32, end: f32, slope: f32) -> Found {
    let fractal = is_fractal();
    let finer = min(f32(frame.size.y) / FINE_ROWS, 1.0);
    let foot = frame.footprint * select(finer, 1.0 / sqrt(f32(max(frame.samples, 1u))), fractal);
    let share = select(LEAST_SHARE, LEAST_SHARE_OF_FRACTALS, fractal);
    // a ray that nearly ran out of steps looks for the surface however far it is: a guess that finds none is taken back
    let late = select(frame.max_steps, frame.max_steps - frame.max_steps / 4u, frame.hit_selection != 0u);
    var t = start;
    var z = 0.0;
    var r = 0.0;
    var side = 1.0;
    var guess = false;
    var falling = false;
    // whether the ray goes to where the surface should be before its end
    var coming = false;
    var towards = false;
    var progress = begin_steps(slope);
    // whether the sign has changed, where, and how often that was sampled
    var crossed = false;
    var part = Bracket();
    var refined = 0u;
    for (var steps = 1u; steps <= frame.max_steps; steps++) {
        let to = t + z;
        let p = ray.origin + ray.direction * to;
        var next = side * field(p);
        let way = to + ray.travelled;
        let rounding = frame.rounding.x * way + frame.rounding.y;
        let radius = foot * (frame.pixel.x * way * ray.narrow + frame.pixel.y);
        let limit = radius + rounding;
        if (crossed) {
            let settled = bracket_settled(part, to, next, max(limit * SETTLED, to * EPSILON));
            part = bracket_narrowed(part, to, next);
            refined += 1u;
            if (settled || refined == REFINEMENTS) {
                return Found(true, bracket_root(part), 0.0, side, steps - refined, refined);
            }
            t = bracket_guess(part, refined);
            continue;
        }
        let least = radius * share + LEAST_ROUNDINGS * rounding;
        guess = guess && steps > 1u;
        var root = 0.0;
        if (steps == 1u) {
            side = select(1.0, -1.0, next < 0.0);
            next *= side;
        } else {
            let gap = z > r && z > r + next && (guess || z > least);
            let behind = next < behind_surface(p) || (next < 0.0 && r < 0.0);
            if (behind && (!gap || guess)) {
                if (fractal) {
                    return Found(true, to, next, side, steps, 0u);
                }
                part = Bracket(t, max(r, 0.0), to, next, 0.0);
                t = bracket_root(part);
                z = 0.0;
                crossed = true;
                continue;
            }
            if (gap) {
                // a gap between the spheres: back to the sphere itself
                progress = failed(progress);
                z = min(max(r, select(LEAST_ROUNDINGS * rounding, least, fractal)), end - t);
                guess = false;
                continue;
            }
            progress = passed(progress, z, r, next);
            falling = r > next;
            towards = r - next > TOWARDS * z;
            let ahead = next * z / max(r - next, 1e-30);
            coming = falling && to + ahead <= end;
            root = ahead * GUESS_BEYOND + least;
        }
        t = to;
        r = next;
        if (fractal && r < limit) {
            return Found(true, t, r, side, steps, 0u);
        }
        if (t + max(r, 0.0) >= end) {
            return Found(false, t, r, side, steps, 0u);
        }
        // steps that are longer than the radius are tested, and must be so long that they are
        let step = next_step(progress, r);
        z = max(select(step, r, !fractal && step < least), select(least, min(select(LEAST_ROUNDINGS, LEAST_ROUNDINGS_BEHIND, r < 0.0) * rounding, least), towards && !fractal));
        let sure = (r < limit && root < GUESS_LONGEST * limit) || steps > late;
        guess = !fractal && steps > 1u && falling && r >= 0.0 && sure && root > z;
        z = min(select(z, root, guess), end - t);
    }
    if (crossed) {
        return Found(true, bracket_root(part), 0.0, side, frame.max_steps - refined, refined);
    }
    // out of steps: a surface only where the ray is within a pixel of it, and gets there or nobody asked whether it does
    let near = fractal || (is_close() && (coming || frame.hit_selection == 0u));
    return Found(near && r < 2.0 * footprint(ray, t), t, r, side, frame.max_steps, 0u);
}
