// Rays through pixels, how wide a pixel is along them, and the part of a ray that can meet the scene.

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

/// Evaluations in single precision are off by about this share of the largest coordinate.
const ROUNDING: f32 = 4.7683716e-7;
/// Between 1 and the next number.
const EPSILON: f32 = 1.1920929e-7;
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
    return frame.detail != 0u;
}

/// How much narrower the footprint of a pixel is along a ray than in the middle of the picture, for the same distance.
fn narrowness(ray: Ray) -> f32 {
    if (frame.pinhole == 0u) {
        return 1.0;
    }
    let cosine = dot(ray.direction, frame.back);
    return cosine * cosine;
}

/// The width of a pixel at distance `t`: the side of a square of its area.
fn pixel_width(ray: Ray, t: f32) -> f32 {
    let narrow = narrowness(ray);
    return frame.pixel.x * t * sqrt(narrow * sqrt(narrow)) + frame.pixel.y;
}

/// The radius of the footprint at distance `t`.
fn footprint(ray: Ray, t: f32) -> f32 {
    return frame.footprint * (frame.pixel.x * t * narrowness(ray) + frame.pixel.y) + frame.rounding.x * t + frame.rounding.y;
}

/// Share of the footprint that a step is at least long.
const LEAST_SHARE: f32 = 0.0625;

/// A value at `p` that is below this is behind the surface. One closer to zero may have its sign from rounding: it is, where the
/// value at the last place was negative too, for what rounding does is over within the step from there.
fn behind_surface(p: vec3f) -> f32 {
    return -0.5 * ROUNDING * (abs(p.x) + abs(p.y) + abs(p.z));
}

/// Whether the field is an estimate of something without an end to its detail.
fn is_fractal() -> bool {
    return (frame.quality & 1u) != 0u;
}

/// Whether the field is zero at places without thickness, which no secondary ray may take for surfaces.
fn has_skins() -> bool {
    return (frame.quality & 4u) != 0u;
}

/// A value below this touches something.
fn skin_touch(at: Surface) -> f32 {
    return max(at.offset / 1024.0, (abs(at.point.x) + abs(at.point.y) + abs(at.point.z)) * 4.0 * ROUNDING);
}

/// Below this share of that it is behind the surface of a solid.
const SKIN_BEHIND: f32 = -0.25;

/// Whether the field's value can be shown as a distance.
fn is_close() -> bool {
    return (frame.quality & 2u) != 0u;
}
