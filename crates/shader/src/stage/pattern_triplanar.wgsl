// An image projected along the three axes, blended by the normal.

fn texel(m: Material, x: f32, y: f32) -> vec3f {
    let column = x - m.width * floor(x / m.width);
    let row = y - m.height * floor(y / m.height);
    let at = min(row, m.height - 1.0) * m.width + min(column, m.width - 1.0);
    return table[u32(m.image) + u32(at)].xyz;
}

/// The colour of an endlessly repeated image, between its four nearest pixels.
fn image_colour(m: Material, at: vec2f) -> vec3f {
    if (m.width < 1.0 || m.height < 1.0) {
        return vec3f(0.0);
    }
    let q = fract(at) * vec2f(m.width, m.height) - 0.5;
    let i = floor(q);
    let s = q - i;
    let upper = mix(texel(m, i.x, i.y), texel(m, i.x + 1.0, i.y), s.x);
    let lower = mix(texel(m, i.x, i.y + 1.0), texel(m, i.x + 1.0, i.y + 1.0), s.x);
    return mix(upper, lower, s.y);
}

fn pattern_triplanar(m: Material, at: Place) -> vec3f {
    let p = at.point / m.size;
    let n = at.normal;
    let outwards = select(vec3f(1.0), vec3f(-1.0), n < vec3f(0.0));
    var sum = vec3f(0.0);
    var weights = 0.0;
    // relative to the largest part: high powers of all three may be too small for a number
    let steepness = abs(n) / max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1.2e-38));
    for (var k = 0u; k < 3u; k++) {
        let weight = pow(steepness[k], m.detail);
        if (weight < 1e-4) {
            continue;
        }
        // across and down as they are seen from outside
        var uv = vec2f(-p.z * outwards.x, -p.y);
        if (k == 1u) {
            uv = vec2f(p.x, p.z * outwards.y);
        } else if (k == 2u) {
            uv = vec2f(p.x * outwards.z, -p.y);
        }
        sum += image_colour(m, uv) * weight;
        weights += weight;
    }
    return sum / max(weights, 1.2e-38);
}
