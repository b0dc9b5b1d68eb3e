// Colours by the orbit of a fractal: the nearer a trap, the more its colour counts.

/// Distance to a trap within which nearer makes little difference.
const TRAP: f32 = 0.08;

fn pattern_orbit(m: Material, at: Place) -> vec3f {
    let w = 1.0 / (at.orbit * at.orbit + TRAP * TRAP);
    return (m.a * w.x + m.b * w.y + m.c * w.z + m.d * w.w) / (w.x + w.y + w.z + w.w);
}
