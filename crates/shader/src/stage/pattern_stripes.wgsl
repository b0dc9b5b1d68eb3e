// Bands of two colours across a direction.

fn pattern_stripes(m: Material, at: Place) -> vec3f {
    let p = dot(at.point - at.normal * (m.size * INWARDS), m.c) / m.size;
    let w = dot(at.footprint, abs(m.c)) / m.size;
    return mix(m.a, m.b, 0.5 * square_wave(p, w) + 0.5);
}
