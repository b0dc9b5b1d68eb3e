// Light that is reflected once: no ray goes on.

fn go_on(path: Onward, at: Surface, t: f32, what: LocalMaterial, material: f32, next: ptr<function, array<Onward, 2>>) -> f32 {
    return 0.0;
}
