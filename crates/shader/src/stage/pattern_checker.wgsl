// Cubes of two colours.

fn pattern_checker(m: Material, at: Place) -> vec3f {
    let p = (at.point - at.normal * (m.size * INWARDS)) / m.size;
    let w = at.footprint / m.size;
    let even = square_wave(p.x, w.x) * square_wave(p.y, w.y) * square_wave(p.z, w.z);
    return mix(m.a, m.b, 0.5 * even + 0.5);
}
