// Ambient occlusion: how much of the sky reaches a hit. Every method of the papers, and cones as the default.

/// Ambient visibility and the direction that most of the sky is seen in.
struct AmbientVisibility {
    open: f32,
    bent: vec3f,
    /// What the sky's light is multiplied by that comes to the body: the colours of things near by.
    tint: vec3f,
}

/// What is shown as the distance to the surface at a place.
fn around(at: Surface, p: vec3f) -> f32 {
    counted[COUNT_OCCLUSION] += 1u;
    return sensed(p).y;
}
