// No light of the scene casts shadows.

fn shadow(at: Surface, light: Light, to: vec3f, distance: f32) -> f32 {
    return select(0.0, 1.0, dot(at.normal, to) > 0.0);
}
