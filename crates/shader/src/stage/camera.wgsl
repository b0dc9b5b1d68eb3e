// Rays through pixels, how wide a pixel is along them, and the part of a ray that can meet the scene.

struct Ray {
    origin: vec3f,
    direction: vec3f,
    /// How much narrower the footprint of its pixel is than in the middle of the picture, for the same distance.
    narrow: f32,
    /// The way from the eye to the origin: the footprint grows along all of it.
    travelled: f32,
}

/// A ray of which the width does not matter.
fn ray_from(origin: vec3f, direction: vec3f) -> Ray {
    return Ray(origin, direction, 1.0, 0.0);
}

fn camera_ray(at: vec2f) -> Ray {
    let q = on_plane(at, frame.half, frame.scale);
    if (frame.pinhole != 0u) {
        let direction = pinhole_ray(q, frame.right, frame.up, frame.back);
        return Ray(frame.eye, direction, view_narrowness(direction, frame.back), 0.0);
    }
    return Ray(across_plane(q, frame.right, frame.up, frame.eye), -frame.back, 1.0, 0.0);
}

/// The ray from a place on the lens that meets the one through its middle in the plane that is in focus.
fn lens_ray(at: vec2f, lens: vec2f) -> Ray {
    let q = on_plane(at, frame.half, frame.scale);
    let nearer = 1.0 / frame.focus;
    if (frame.pinhole != 0u) {
        let direction = pinhole_ray(q - lens * nearer, frame.right, frame.up, frame.back);
        return Ray(across_plane(lens, frame.right, frame.up, frame.eye), direction, view_narrowness(direction, frame.back), 0.0);
    }
    let direction = pinhole_ray(-lens * nearer, frame.right, frame.up, frame.back);
    return Ray(across_plane(q + lens, frame.right, frame.up, frame.eye), direction, 1.0, 0.0);
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

/// The width of a pixel at distance `t`: the side of a square of its area.
fn pixel_width(ray: Ray, t: f32) -> f32 {
    return width_of_pixel(t + ray.travelled, ray.narrow, frame.pixel);
}

/// The radius of the footprint at distance `t`.
fn footprint(ray: Ray, t: f32) -> f32 {
    return radius_of_footprint(t + ray.travelled, ray.narrow, frame.footprint * frame.pixel, frame.rounding);
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
