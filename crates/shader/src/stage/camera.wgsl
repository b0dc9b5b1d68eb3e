// Rays through pixels, how wide a pixel is along them, and the part of a ray that can meet the scene.

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

/// A number that no distance of a scene reaches.
const FAR: f32 = 3.0e38;

/// A place on the picture, in pixels from the top left corner, on the plane at distance 1 (pinhole) or in the scene
/// (orthographic).
fn on_plane(at: vec2f) -> vec2f {
    return vec2f(at.x - frame.half.x, frame.half.y - at.y) * frame.scale;
}

fn camera_ray(at: vec2f) -> Ray {
    let q = on_plane(at);
    let across = frame.right * q.x + frame.up * q.y;
    if (frame.pinhole != 0u) {
        return Ray(frame.eye, normalize(across - frame.back));
    }
    return Ray(frame.eye + across, -frame.back);
}

/// A cone around the ray through `at` that holds all rays through the square of `reach` pixels around it: slope and constant
/// of its radius. The slope is the tangent of the largest angle to a corner.
fn cone_width(at: vec2f, reach: f32) -> vec2f {
    let e = reach * frame.scale;
    if (frame.pinhole == 0u) {
        return vec2f(0.0, e * 1.4142135);
    }
    let q = on_plane(at);
    let square = dot(q, q) + 1.0;
    var slope = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let corner = vec2f(select(-e, e, (k & 1u) != 0u), select(-e, e, (k & 2u) != 0u));
        let along = dot(q, corner);
        let across = sqrt(max(square * 2.0 * e * e - along * along, 0.0));
        slope = max(slope, across / max(square + along, 1e-6));
    }
    return vec2f(slope, 0.0);
}

/// Up to this `t` a ray is farther from the scene's box than `slope * t + constant`; 0 where it starts near it.
fn enter(ray: Ray, slope: f32, constant: f32) -> f32 {
    let gap = select(frame.region_min - ray.origin, ray.origin - frame.region_max, ray.direction < vec3f(0.0));
    let t = (gap - constant) / max(abs(ray.direction) + slope, vec3f(1e-12));
    return min(max(max(t.x, t.y), max(t.z, 0.0)), FAR);
}

/// From this `t` on a ray is farther from the scene's box than `slope * t + constant`, for good.
fn leave(ray: Ray, slope: f32, constant: f32) -> f32 {
    let depth = select(frame.region_max - ray.origin, ray.origin - frame.region_min, ray.direction < vec3f(0.0));
    let gain = abs(ray.direction) - slope;
    let t = select(vec3f(FAR), (depth + constant) / max(gain, vec3f(1e-12)), gain > vec3f(1e-12));
    return max(min(min(t.x, t.y), min(t.z, FAR)), 0.0);
}

/// Whether anything but colour and coverage is asked for.
fn wants_detail() -> bool {
    return frame.planes_c.z != 0u;
}

/// Full width of a pixel at distance `t`.
fn pixel_width(t: f32) -> f32 {
    return frame.pixel.x * t + frame.pixel.y;
}

/// A value of the field below this is a hit at distance `t`.
fn threshold(t: f32) -> f32 {
    return frame.threshold.x * t + frame.threshold.y;
}
