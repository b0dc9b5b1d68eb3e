// What colour a surface has where.

/// A place on a surface, as far as its colour depends on it.
struct Place {
    point: vec3f,
    normal: vec3f,
    /// How wide a pixel is there, across the ray.
    width: f32,
    /// How much longer than wide a pixel is on the surface, along the view.
    stretch: vec3f,
    /// How near the orbit of a fractal came to its traps.
    orbit: vec4f,
}

/// A place in another space, and how it changes there with where it is: of each of its coordinates the derivatives.
struct Mapped {
    place: Place,
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

/// The place where a ray of direction `d` and width `pixel` meets a surface.
fn place_on(point: vec3f, normal: vec3f, d: vec3f, pixel: f32, orbit: vec4f) -> Place {
    return Place(point, normal, pixel, pixel_stretch(normal, d, pixel), orbit);
}

/// A place in another space, where it is at `point`.
fn mapped(at: Place, point: vec3f, along_x: vec3f, along_y: vec3f, along_z: vec3f) -> Mapped {
    let x = tame_row(along_x);
    let y = tame_row(along_y);
    let z = tame_row(along_z);
    let stretch = vec3f(dot(x, at.stretch), dot(y, at.stretch), dot(z, at.stretch));
    let place = Place(point, mapped_normal(at.normal, x, y, z), at.width * mapped_scale(x, y, z), stretch, at.orbit);
    return Mapped(place, x, y, z);
}
