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

/// The place where a ray of direction `d` and width `pixel` meets a surface.
fn place_on(point: vec3f, normal: vec3f, d: vec3f, pixel: f32, orbit: vec4f) -> Place {
    return Place(point, normal, footprint_on(normal, d, pixel), orbit);
}
