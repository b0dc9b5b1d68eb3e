// Fractal noise between two colours. Features finer than a pixel fade to their mean, which is zero.

fn pattern_noise(m: Material, at: Place) -> vec3f {
    var sum = 0.0;
    var share = 1.0;
    var total = 0.0;
    var p = at.point / m.size;
    var w = length(at.footprint) / m.size;
    let octaves = u32(clamp(m.detail, 1.0, 8.0));
    for (var k = 0u; k < octaves; k++) {
        sum += gradient_noise(p) * clamp(1.0 - 2.0 * w, 0.0, 1.0) * share;
        total += share;
        // turned and moved, so that the lattices of the octaves do not meet
        p = vec3f(0.8 * p.y + 0.6 * p.z, p.x, 0.6 * p.y - 0.8 * p.z) * 2.0 + vec3f(0.37, 0.61, 0.13 + f32(k));
        w *= 2.0;
        share *= 0.5;
    }
    return mix(m.a, m.b, clamp(sum * (0.8 / total) + 0.5, 0.0, 1.0));
}
