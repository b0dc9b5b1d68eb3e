// From one colour to another between two points.

fn pattern_gradient(m: Material, at: Place) -> vec3f {
    let way = m.d - m.c;
    let t = dot(at.point - m.c, way) / max(dot(way, way), 1.2e-38);
    return mix(m.a, m.b, clamp(t, 0.0, 1.0));
}
