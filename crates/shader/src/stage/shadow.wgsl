// Shadows: how much of a light reaches a hit.

/// How much of a light reaches a surface that it is in the direction `to` of: 0 where the surface faces away.
fn shadow(at: Surface, light: Light, to: vec3f, distance: f32) -> f32 {
    if (!(dot(at.normal, to) > 0.0)) {
        return 0.0;
    }
    // what is seen from inside the solid is lit as if there were no solid: else it would be dark
    if (shadow_kind(light) == SHADOW_NONE || at.side < 0.0) {
        return 1.0;
    }
    if (shadow_kind(light) == SHADOW_ADVECTED) {
        return advected(at, light, to, distance);
    }
    let traced = secondary_ray(at, to, distance, shadow_kind(light), light.sharpness);
    counted[COUNT_SHADOW] += traced.samples;
    return traced.light;
}
