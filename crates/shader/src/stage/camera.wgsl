// Rays through pixels, how wide a pixel is along them, and the part of a ray that can meet the scene.

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

fn camera_ray(at: vec2f) -> Ray {
    let q = on_plane(at, frame.half, frame.scale);
    if (frame.pinhole != 0u) {
        return Ray(frame.eye, pinhole_ray(q, frame.right, frame.up, frame.back));
    }
    return Ray(across_plane(q, frame.right, frame.up, frame.eye), -frame.back);
}

/// A cone around the ray through `at` that holds all rays through the square of `reach` pixels around it: slope and constant
/// of its radius.
fn cone_width(at: vec2f, reach: f32) -> vec2f {
    let e = reach * frame.scale;
    if (frame.pinhole == 0u) {
        return vec2f(0.0, e * 1.4142135);
    }
    return vec2f(cone_slope(on_plane(at, frame.half, frame.scale), e), 0.0);
}

/// Up to this `t` a ray is farther from the scene's box than `slope * t + constant`; 0 where it starts near it.
fn enter(ray: Ray, slope: f32, constant: f32) -> f32 {
    return enter_box(frame.region_min, frame.region_max, ray.origin, ray.direction, slope, constant);
}

/// From this `t` on a ray is farther from the scene's box than `slope * t + constant`, for good.
fn leave(ray: Ray, slope: f32, constant: f32) -> f32 {
    return leave_box(frame.region_min, frame.region_max, ray.origin, ray.direction, slope, constant);
}

/// Whether anything but colour and coverage is asked for.
fn wants_detail() -> bool {
    return frame.detail != 0u;
}

/// How much narrower the footprint of a pixel is along a ray than in the middle of the picture, for the same distance.
fn narrowness(ray: Ray) -> f32 {
    if (frame.pinhole == 0u) {
        return 1.0;
    }
    return view_narrowness(ray.direction, frame.back);
}

/// The width of a pixel at distance `t`: the side of a square of its area.
fn pixel_width(ray: Ray, t: f32) -> f32 {
    return width_of_pixel(t, narrowness(ray), frame.pixel);
}

/// The radius of the footprint at distance `t`.
fn footprint(ray: Ray, t: f32) -> f32 {
    return radius_of_footprint(t, narrowness(ray), frame.footprint * frame.pixel, frame.rounding);
}

/// Whether the field is an estimate of something without an end to its detail.
fn is_fractal() -> bool {
    return (frame.quality & 1u) != 0u;
}

/// Whether the field is zero at places without thickness, which no secondary ray may take for surfaces.
fn has_skins() -> bool {
    return (frame.quality & 4u) != 0u;
}

/// Whether the field's value can be shown as a distance.
fn is_close() -> bool {
    return (frame.quality & 2u) != 0u;
}
