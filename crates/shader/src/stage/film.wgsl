// From samples to pixels: every sample counts for the pixels around it as much as the filter says.

/// Adds one sample of every pixel to the sums of the pixels of the tile.
@compute @workgroup_size(8, 8, 1)
fn gather(@builtin(global_invocation_id) id: vec3u) {
    frame = given_frame;
    tile = given_tile;
    if (id.x >= tile.size.x || id.y >= tile.size.y) {
        return;
    }
    let pixel = tile.corner + id.xy;
    let at = (pixel.y - frame.band.z) * frame.size.x + pixel.x;
    var light = LightSum(vec3f(0.0), 0.0, 0.0, 0.0, 0.0, 0.0);
    if (tile.index > frame.first_ray) {
        light = light_sums[at];
    }
    var reach = 0;
    if (frame.samples != 0u) {
        reach = filter_reach();
    }
    let last = vec2i(frame.size) - 1;
    for (var dy = -reach; dy <= reach; dy++) {
        for (var dx = -reach; dx <= reach; dx++) {
            let source = vec2i(pixel) + vec2i(dx, dy);
            if (any(source < vec2i(0)) || any(source > last)) {
                continue;
            }
            let place = (u32(source.y) - frame.band.x) * frame.size.x + u32(source.x);
            var w = 1.0;
            if (frame.samples != 0u) {
                let to = unpack2x16unorm(samples[place].place) - 0.5 + vec2f(f32(dx), f32(dy));
                w = filter_weight(to.x) * filter_weight(to.y);
            }
            light.colour += samples[place].colour * w;
            light.cover += cover_of(place) * w;
            light.weight += w;
        }
    }
    if (wants_detail()) {
        let own = samples[(pixel.y - frame.band.x) * frame.size.x + pixel.x];
        light.steps += own.steps;
        light.hits += cover_of((pixel.y - frame.band.x) * frame.size.x + pixel.x);
        gather_surface(at, own);
    }
    light_sums[at] = light;
}

/// How much of a ray's part of the picture is covered.
fn cover_of(place: u32) -> f32 {
    if (frame.samples == 0u) {
        return bitcast<f32>(samples[place].place);
    }
    return select(0.0, 1.0, samples[place].depth >= 0.0);
}

/// Adds a pixel's own ray to the sums of what it hit.
fn gather_surface(at: u32, own: Sample) {
    var surface = SurfaceSum(vec3f(0.0), -1.0, vec3f(0.0), 0.0, 0.0, 0.0, 0.0, 0.0);
    if (tile.index > frame.first_ray) {
        surface = surface_sums[at];
    }
    if (own.depth >= 0.0) {
        surface.normal += own.normal;
        surface.albedo += own.albedo;
        surface.open += own.open;
        surface.shadow += own.shadow;
        if (surface.depth < 0.0 || own.depth < surface.depth) {
            surface.depth = own.depth;
            surface.residual = own.residual;
            surface.object = own.object;
        }
    }
    surface_sums[at] = surface;
}

fn put(place: u32, at: u32, value: f32) {
    if (place != 0xffffffffu) {
        planes[place + at] = value;
    }
}

fn put3(place: u32, at: u32, value: vec3f) {
    if (place != 0xffffffffu) {
        planes[place + 3u * at] = value.x;
        planes[place + 3u * at + 1u] = value.y;
        planes[place + 3u * at + 2u] = value.z;
    }
}

/// Writes the sums that are asked for, in the order in which they are kept.
@compute @workgroup_size(8, 8, 1)
fn develop(@builtin(global_invocation_id) id: vec3u) {
    frame = given_frame;
    tile = given_tile;
    if (id.x >= tile.size.x || id.y >= tile.size.y) {
        return;
    }
    let pixel = tile.corner + id.xy;
    let at = (pixel.y - frame.band.z) * frame.size.x + pixel.x;
    let light = light_sums[at];
    put3(frame.sums_a.x, at, light.colour);
    put(frame.sums_a.y, at, light.cover);
    put(frame.sums_a.z, at, light.weight);
    if (!wants_detail()) {
        return;
    }
    let surface = surface_sums[at];
    put(frame.sums_a.w, at, light.hits);
    put(frame.sums_b.x, at, select(surface.depth, frame.miss, light.hits == 0.0));
    put3(frame.sums_b.y, at, surface.normal);
    put3(frame.sums_b.z, at, surface.albedo);
    put(frame.sums_b.w, at, surface.open);
    put(frame.sums_c.x, at, surface.shadow);
    put(frame.sums_c.y, at, light.steps);
    put(frame.sums_c.z, at, surface.residual);
    put(frame.sums_c.w, at, surface.object);
}
