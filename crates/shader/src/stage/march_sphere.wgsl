// Steps of the field's value (Hart 1996; Tomczak 2012, 2.2).

fn begin_steps(slope: f32) -> vec2f {
    return vec2f(0.0);
}

fn failed(progress: vec2f) -> vec2f {
    return progress;
}

fn passed(progress: vec2f, z: f32, r: f32, next: f32) -> vec2f {
    return progress;
}

fn next_step(progress: vec2f, r: f32) -> f32 {
    return r;
}
