// Over-relaxation until the first gap (Keinert 2014, listing 2 corrected).

fn begin_steps(slope: f32) -> vec2f {
    return vec2f(frame.march, 0.0);
}

fn failed(progress: vec2f) -> vec2f {
    return vec2f(1.0, 0.0);
}

fn passed(progress: vec2f, z: f32, r: f32, next: f32) -> vec2f {
    return progress;
}

fn next_step(progress: vec2f, r: f32) -> f32 {
    return r * progress.x;
}
