// An image projected along the three axes, blended by the normal.

fn texel(m: TexturePart, x: f32, y: f32) -> vec3f {
    let column = x - m.width * floor(x / m.width);
    let row = y - m.height * floor(y / m.height);
    let pixel = u32(min(row, m.height - 1.0)) * u32(m.width) + u32(min(column, m.width - 1.0));
    return image_texel(u32(m.image_row) * TEXTURE_SIDE + u32(m.image_column) + pixel);
}

/// The colour of an endlessly repeated image, between its four nearest pixels.
fn image_colour(m: TexturePart, at: vec2f) -> vec3f {
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

fn pattern_triplanar(m: TexturePart, at: Place) -> vec3f {
    let weights = projection_weights(at.normal, m.detail);
    var sum = vec3f(0.0);
    var total = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let weight = weights[k];
        if (weight < LEAST_WEIGHT) {
            continue;
        }
        sum += image_colour(m, projection(at.point, at.normal, f32(k), m.size)) * weight;
        total += weight;
    }
    return sum / max(total, LEAST_NORMAL);
}
