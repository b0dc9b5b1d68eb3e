// Light from all around, by an image of all directions. The twin of `shade/environment.rs`.

fn surroundings() -> Around {
    return load_around(frame.around_rows);
}

/// A pixel of one of its images.
fn around_texel(start: vec2f, width: f32, x: f32, y: f32) -> vec3f {
    let column = x - width * floor(x / width);
    return image_texel(u32(start.x) * TEXTURE_SIDE + u32(start.y) + u32(y) * u32(width) + u32(min(column, width - 1.0)));
}

/// The colour between the four nearest pixels of `count` rows from `first` on.
fn around_colour(start: vec2f, width: f32, first: f32, count: f32, place: vec2f) -> vec3f {
    let q = place * vec2f(width, count) - 0.5;
    let i = floor(q);
    let s = q - i;
    let top = first + clamp(i.y, 0.0, count - 1.0);
    let bottom = first + clamp(i.y + 1.0, 0.0, count - 1.0);
    let upper = mix(around_texel(start, width, i.x, top), around_texel(start, width, i.x + 1.0, top), s.x);
    let lower = mix(around_texel(start, width, i.x, bottom), around_texel(start, width, i.x + 1.0, bottom), s.x);
    return mix(upper, lower, s.y);
}

/// The sky along a direction.
fn sky_seen(d: vec3f) -> vec3f {
    let a = surroundings();
    let place = place_of_direction(turned_around(d, a.cosine, -a.sine));
    return around_colour(vec2f(a.image_row, a.image_column), a.width, 0.0, a.height, place) * a.strength;
}

/// What a surface makes of it. Paths find it along the rays that meet nothing.
fn surround(at: Surface, what: LocalMaterial, seen: AmbientVisibility, followed: f32) -> vec3f {
    if (frame.depth != 0u) {
        return vec3f(0.0);
    }
    let a = surroundings();
    let bent = turned_around(seen.bent, a.cosine, -a.sine);
    let arriving = max(
        arriving_around(bent, a.h0, a.h1, a.h2, a.h3, a.h4, a.h5, a.h6, a.h7, a.h8),
        vec3f(0.0),
    ) * (a.strength * frame.ambient) * seen.tint;
    let mirror = at.direction - what.normal * (2.0 * dot(what.normal, at.direction));
    let place = place_of_direction(turned_around(mirror, a.cosine, -a.sine));
    let start = vec2f(a.glossy_row, a.glossy_column);
    let level = clamp(what.finish.z * AROUND_LEVELS - 1.0, 0.0, AROUND_LEVELS - 1.0);
    let low = min(floor(level), AROUND_LEVELS - 2.0);
    let near = around_colour(start, AROUND_WIDTH, low * AROUND_HEIGHT, AROUND_HEIGHT, place);
    let next = around_colour(start, AROUND_WIDTH, (low + 1.0) * AROUND_HEIGHT, AROUND_HEIGHT, place);
    let mirrored = mix(near, next, level - low) * a.strength;
    return surface_around(what.albedo, what.finish, what.normal, at.direction, seen.open, arriving, mirrored, followed);
}

/// How many lights all around are looked for.
fn lights_around() -> u32 {
    return select(0u, 1u, frame.depth != 0u);
}

/// A cell: where its part ends, and the density of choosing it.
fn around_cell(a: Around, column: u32, row: u32) -> vec2f {
    let width = u32(a.columns) + 1u;
    return image_texel(u32(a.table_row) * TEXTURE_SIDE + u32(a.table_column) + row * width + column).xy;
}

/// The light from all around that is looked for from a surface: a direction, what a white surface shows that faces it, and the density over
/// directions with which it is chosen.
fn light_around(path: Onward) -> Light {
    let a = surroundings();
    let columns = u32(a.columns);
    let u = decided_point(path.pixel, path.index, AROUND_DECISION + path.bounces.x + path.bounces.y);
    // the row, by bisection, then the place in it
    var low = 0u;
    var high = u32(a.rows) - 1u;
    while (low < high) {
        let middle = (low + high) / 2u;
        if (around_cell(a, columns, middle).x > u.y) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    let row = low;
    var begin = 0.0;
    if (row > 0u) {
        begin = around_cell(a, columns, row - 1u).x;
    }
    let down = clamp((u.y - begin) / max(around_cell(a, columns, row).x - begin, 1e-12), 0.0, 0.999999);
    low = 0u;
    high = columns - 1u;
    while (low < high) {
        let middle = (low + high) / 2u;
        if (around_cell(a, middle, row).x > u.x) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    begin = 0.0;
    if (low > 0u) {
        begin = around_cell(a, low - 1u, row).x;
    }
    let cell = around_cell(a, low, row);
    let across = clamp((u.x - begin) / max(cell.x - begin, 1e-12), 0.0, 0.999999);
    let place = vec2f((f32(low) + across) / a.columns, (f32(row) + down) / a.rows);
    let way = direction_of_place(place);
    let found = density_of_direction(cell.y, way.w);
    var light = Light();
    light.kind = LAMP_AROUND;
    light.place = turned_around(way.xyz, a.cosine, a.sine);
    light.radiance = sky_seen(light.place) / max(found * LAMP_PI, 1e-30);
    light.luminance = dot(light.radiance, vec3f(0.2126, 0.7152, 0.0722));
    light.shadow = f32(SHADOW_HARD);
    light.area = found;
    light.visible = 1.0;
    return light;
}

/// What does not count of the light that a ray finds which is looked for too.
fn found_already(path: Onward) -> vec3f {
    let a = surroundings();
    let d = turned_around(path.ray.direction, a.cosine, -a.sine);
    let place = place_of_direction(d);
    let column = min(u32(max(place.x * a.columns, 0.0)), u32(a.columns) - 1u);
    let row = min(u32(max(place.y * a.rows, 0.0)), u32(a.rows) - 1u);
    let found = density_of_direction(around_cell(a, column, row).y, length(d.xz));
    return sky_seen(path.ray.direction) * ((1.0 - balance(path.density, found)) * (1.0 - haze(path.ray, ENDLESS)));
}
