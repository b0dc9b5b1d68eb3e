// Primary rays. Every marcher evaluates the field in one place only: a driver copies the whole field there.

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

/// Marches a ray from `start` to `end`. `slope` is the field's slope along it, as far as it is known.
fn march(ray: Ray, start: f32, end: f32, slope: f32) -> Found {
    var t = start;
    var z = 0.0;
    var r = 0.0;
    var side = 1.0;
    var progress = begin_steps(slope);
    // the candidate whose unbounding sphere is the smallest on the picture (Keinert 2014, 3.2): size, place, value
    var best = vec3f(FAR, start, 0.0);
    for (var steps = 1u; steps <= frame.max_steps; steps++) {
        var next = side * field(ray.origin + ray.direction * (t + z));
        if (steps == 1u) {
            side = select(1.0, -1.0, next < 0.0);
            next *= side;
        } else if (z > r && z > r + next) {
            // a gap between the spheres: back to the sphere itself
            progress = failed(progress);
            z = min(r, end - t);
            continue;
        } else {
            progress = passed(progress, z, r, next);
        }
        t += z;
        r = next;
        let limit = threshold(t);
        let size = abs(r) / limit;
        if (size < best.x) {
            best = vec3f(size, t, r);
        }
        if (r < limit) {
            return Found(true, t, r, side, steps);
        }
        if (t + r >= end) {
            return Found(false, t, r, side, steps);
        }
        z = min(next_step(progress, r), end - t);
    }
    if (frame.hit_selection != 0u) {
        return Found(true, best.y, best.z, side, frame.max_steps);
    }
    return Found(true, t, r, side, frame.max_steps);
}
