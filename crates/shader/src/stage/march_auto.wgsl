// Over-relaxation from the smoothed slope of the field along the ray (Ban and Valasek 2023).

fn begin_steps(slope: f32) -> vec2f {
    return vec2f(slope, 0.0);
}

fn failed(progress: vec2f) -> vec2f {
    return vec2f(-1.0, 0.0);
}

fn passed(progress: vec2f, z: f32, r: f32, next: f32) -> vec2f {
    let slope = clamp((next - r) / max(z, 1e-20), -1.0, 1.0);
    return vec2f(min(mix(progress.x, slope, frame.march), 0.98), 0.0);
}

fn next_step(progress: vec2f, r: f32) -> f32 {
    return r * max(2.0 / (1.0 - progress.x), 1.0);
}
