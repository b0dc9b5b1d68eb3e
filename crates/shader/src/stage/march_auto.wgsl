// Over-relaxation from the smoothed slope of the field along the ray (Ban and Valasek 2023).

fn begin_steps(slope: f32) -> vec2f {
    return vec2f(slope, 0.0);
}

fn failed(progress: vec2f) -> vec2f {
    return vec2f(-1.0, 0.0);
}

fn passed(progress: vec2f, z: f32, r: f32, next: f32) -> vec2f {
    return vec2f(smoothed_slope(progress.x, r, next, z, frame.march), 0.0);
}

fn next_step(progress: vec2f, r: f32) -> f32 {
    return slope_step(r, progress.x);
}
