// From the slope of the surface alone (Tomczak 2012, 4.3).

fn ao_upward(at: Surface, how: Occluder) -> f32 {
    return 1.0 - clamp(how.scale * (1.0 - dot(at.normal, UP)), 0.0, 1.0);
}
