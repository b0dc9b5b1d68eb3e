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
    if (tile.index > 0u) {
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
            let to = unpack2x16unorm(samples[place].jitter) - 0.5 + vec2f(f32(dx), f32(dy));
            let w = filter_weight(to.x) * filter_weight(to.y);
            light.colour += samples[place].colour * w;
            light.cover += select(0.0, w, samples[place].depth >= 0.0);
            light.weight += w;
        }
    }
    if (wants_detail()) {
        let own = samples[(pixel.y - frame.band.x) * frame.size.x + pixel.x];
        light.steps += own.steps;
        light.rays += 1.0;
        light.hits += select(0.0, 1.0, own.depth >= 0.0);
        gather_surface(at, own);
    }
    light_sums[at] = light;
}

/// Adds a pixel's own ray to the sums of what it hit.
fn gather_surface(at: u32, own: Sample) {
    var surface = SurfaceSum(vec3f(0.0), -1.0, vec3f(0.0), 0.0, 0.0, 0.0, 0.0, 0.0);
    if (tile.index > 0u) {
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

/// Turns sums into the planes that are asked for, in the order of the film's planes.
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
    let weight = max(light.weight, 1e-6);
    // the filter's negative lobes can make a dark pixel beside a bright one less than black
    put3(frame.planes_a.x, at, max(light.colour / weight, vec3f(0.0)));
    put(frame.planes_a.y, at, clamp(light.cover / weight, 0.0, 1.0));
    if (!wants_detail()) {
        return;
    }
    let surface = surface_sums[at];
    let hits = max(light.hits, 1.0);
    let nothing = light.hits == 0.0;
    put(frame.planes_a.z, at, select(surface.depth, frame.miss, nothing));
    let length_of = length(surface.normal);
    put3(frame.planes_a.w, at, select(vec3f(0.0), surface.normal / max(length_of, 1e-20), length_of > 0.0));
    put3(frame.planes_b.x, at, surface.albedo / hits);
    put(frame.planes_b.y, at, select(surface.open / hits, 1.0, nothing));
    put(frame.planes_b.z, at, select(surface.shadow / hits, 1.0, nothing));
    put(frame.planes_b.w, at, light.steps / light.rays);
    put(frame.planes_c.x, at, surface.residual);
    put(frame.planes_c.y, at, surface.object);
}
