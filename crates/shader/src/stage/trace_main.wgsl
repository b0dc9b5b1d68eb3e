// The entry point that sends one ray through every pixel of a tile.

@compute @workgroup_size(8, 8, 1)
fn trace(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    frame = given_frame;
    tile = given_tile;
    if (id.x < tile.size.x && id.y < tile.size.y) {
        let pixel = tile.corner + id.xy;
        var span = vec3f(0.0, -1.0, FAR);
        if (frame.prepass != 0u && !has_lens()) {
            span = cones[cone_of(pixel)].xyz;
        }
        let within = jitter(pixel, tile.index);
        var found = trace_ray(pixel, tile.index, pixel_ray(vec2f(pixel) + within, pixel, tile.index), span);
        if (frame.samples != 0u) {
            found.place = pack2x16unorm(within);
        }
        let at = (pixel.y - frame.band.x) * frame.size.x + pixel.x;
        if (wants_detail()) {
            samples[at] = found;
        } else {
            samples[at].colour = found.colour;
            samples[at].depth = found.depth;
            samples[at].place = found.place;
        }
        counted[COUNT_RAYS] += 1u;
    }
    count_up(local);
}
