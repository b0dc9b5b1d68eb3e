// Steps from the planar guess (Balint and Valasek 2018). Progress: the last step, 0 before the first, and the radius that it
// began with.

fn begin_steps(slope: f32) -> vec2f {
    return vec2f(0.0);
}

fn failed(progress: vec2f) -> vec2f {
    return progress;
}

fn passed(progress: vec2f, z: f32, r: f32, next: f32) -> vec2f {
    return vec2f(z, r);
}

fn next_step(progress: vec2f, r: f32) -> f32 {
    if (progress.x <= 0.0) {
        return r;
    }
    return planar_step(r, progress.y, progress.x, frame.march);
}
