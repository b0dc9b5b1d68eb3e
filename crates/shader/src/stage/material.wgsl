// What colour a surface has where.

/// A place on a surface, as far as its colour depends on it.
struct Place {
    point: vec3f,
    normal: vec3f,
    /// How far the point moves from one ray to the next, at most, along each axis.
    footprint: vec3f,
    /// How near the orbit of a fractal came to its traps.
    orbit: vec4f,
}

/// Share of a feature's size that a point is moved into the surface: faces like to lie on the borders of cubes and bands.
const INWARDS: f32 = 1e-3;

/// The place where a ray of direction `d` and width `pixel` meets a surface. There the pixel is an ellipse: as wide as the
/// ray across, and longer by the cosine along the view.
fn place_on(point: vec3f, normal: vec3f, d: vec3f, pixel: f32, orbit: vec4f) -> Place {
    let facing = dot(normal, d);
    let cosine = max(abs(facing), 0.05);
    let slide = d - normal * facing;
    let along = slide / max(length(slide), 1e-6);
    let footprint = pixel * (sqrt(max(1.0 - normal * normal, vec3f(0.0))) + abs(along) * (1.0 / cosine - 1.0));
    return Place(point, normal, footprint, orbit);
}

fn triangle_wave(x: f32) -> f32 {
    return abs(fract(0.5 * x) - 0.5);
}

/// 1 in even cells of size 1 and -1 in odd ones, averaged over `width` around `x`.
fn square_wave(x: f32, width: f32) -> f32 {
    let w = max(width, 1e-4);
    return clamp((triangle_wave(x - 0.5 * w) - triangle_wave(x + 0.5 * w)) * 2.0 / w, -1.0, 1.0);
}
