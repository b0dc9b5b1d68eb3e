// Materials with textures. The twin of `shade/coat.rs` and of `Texture` in `shade/pattern.rs`.

const KIND_TRIPLANAR: u32 = 5u;
const KIND_FORMULA: u32 = 8u;

/// Shares of two inks, from that of the second.
fn two_inks(second: f32) -> vec4f {
    return vec4f(1.0 - second, second, 0.0, 0.0);
}

/// What the texture that begins at a row shows: a linear colour, or a height, which formulas may give any value.
fn texture_colour(first: u32, at: Place, heights: bool) -> vec3f {
    var shares: array<f32, TEXTURE_PARTS>;
    shares[0] = 1.0;
    var sum = vec3f(0.0);
    let count = min(u32(load_texturepart(first).count), TEXTURE_PARTS);
    for (var k = 0u; k < count; k++) {
        let part = load_texturepart(first + k * TEXTUREPART_ROWS);
        var here = at;
        if (part.still < 0.5) {
            let offset = vec3f(part.offset_x, part.offset_y, part.offset_z);
            let point = vec3f(dot(part.x, at.point), dot(part.y, at.point), dot(part.z, at.point)) + offset;
            here = mapped(at, point, part.x, part.y, part.z).place;
        }
        if (u32(part.kind) == KIND_TRIPLANAR) {
            sum += pattern_triplanar(part, here) * shares[k];
            continue;
        }
        if (u32(part.kind) == KIND_FORMULA) {
            sum += pattern_formula(part, here, heights) * shares[k];
            continue;
        }
        let inks = pattern_shares(part, here) * shares[k];
        if (part.instead_a > 0.0) {
            shares[u32(part.instead_a)] = inks.x;
        } else {
            sum += part.a * inks.x;
        }
        if (part.instead_b > 0.0) {
            shares[u32(part.instead_b)] = inks.y;
        } else {
            sum += part.b * inks.y;
        }
        if (part.instead_c > 0.0) {
            shares[u32(part.instead_c)] = inks.z;
        } else {
            sum += part.c * inks.z;
        }
        if (part.instead_d > 0.0) {
            shares[u32(part.instead_d)] = inks.w;
        } else {
            sum += part.d * inks.w;
        }
    }
    return sum;
}

/// What the surface is made of, of the material of this number, seen from direction `d`.
fn local_material(number: f32, at: Place, d: vec3f) -> LocalMaterial {
    let m = material_numbered(number);
    let space = in_space_of(m, at);
    let scale = max(mapped_scale(space.x, space.y, space.z), LEAST_NORMAL);
    let step = max(space.place.width, m.finest * BUMP_STEP) / scale;
    let across = basis_across(at.normal);
    let along = basis_along(at.normal);
    // its textures one after the other, so that patterns are in one place only; heights at three places
    var seen: array<vec3f, LOOKS>;
    for (var k = 0u; k < LOOKS; k++) {
        let row = select(select(select(m.bump_texture, m.metallic_texture, k == 2u), m.roughness_texture, k == 1u), m.albedo_texture, k == 0u);
        if (row <= 0.0) {
            continue;
        }
        var place = space.place;
        if (k > 3u) {
            let beside = select(along, across, k == 4u) * step;
            place.point += vec3f(dot(space.x, beside), dot(space.y, beside), dot(space.z, beside));
        }
        seen[k] = texture_colour(u32(row), place, k >= 3u);
    }
    let albedo = select(m.albedo, seen[0], m.albedo_texture > 0.0);
    var finish = vec4f(m.specular, m.metallic, m.roughness, m.transmission);
    var normal = at.normal;
    if (LOOKS > 1u) {
        if (m.roughness_texture > 0.0) {
            finish.z = saturate(texture_number(seen[min(1u, LOOKS - 1u)]));
        }
        if (m.metallic_texture > 0.0) {
            finish.y = saturate(texture_number(seen[min(2u, LOOKS - 1u)]));
        }
    }
    if (LOOKS > 3u && m.bump_texture > 0.0) {
        let height = texture_number(seen[min(3u, LOOKS - 1u)]);
        let heights = vec2f(texture_number(seen[min(4u, LOOKS - 1u)]), texture_number(seen[min(5u, LOOKS - 1u)]));
        let rise = (heights - height) * (m.depth / (step * scale));
        normal = bumped_normal(at.normal, across, along, rise, d);
    }
    return LocalMaterial(albedo, m.emission, finish, m.shininess, normal);
}
