// Stands in for a scene's shader: every pixel's colour is where it is and the mean number of its rays.
@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> tile: Tile;
@group(0) @binding(2) var<storage, read> params: array<f32>;
@group(0) @binding(3) var<storage, read> code: array<u32>;
@group(0) @binding(4) var<storage, read> table: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> cones: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> samples: array<Sample>;
@group(0) @binding(7) var<storage, read_write> light_sums: array<LightSum>;
@group(0) @binding(8) var<storage, read_write> surface_sums: array<SurfaceSum>;
@group(0) @binding(9) var<storage, read_write> planes: array<f32>;
@group(0) @binding(10) var<storage, read_write> counters: array<atomic<u32>, 18>;

fn cells(side: u32) -> vec2u {
    let down = (frame.band.x + frame.band.y + side - 1u) / side - frame.band.x / side;
    return vec2u((frame.size.x + side - 1u) / side, down);
}

fn cone(id: vec2u, side: u32, first: u32) {
    let count = cells(side);
    if id.x >= count.x || id.y >= count.y { return; }
    cones[first + id.y * count.x + id.x] = vec4f(f32(side));
    atomicAdd(&counters[0], 1u);
}

@compute @workgroup_size(8, 8) fn cones_wide(@builtin(global_invocation_id) id: vec3u) {
    cone(id.xy, 32u, 0u);
}

@compute @workgroup_size(8, 8) fn cones_narrow(@builtin(global_invocation_id) id: vec3u) {
    cone(id.xy, 8u, frame.wide_cones);
}

// As in the shaders of scenes.
fn is_cut_short() -> bool {
    let wanted = min(frame.size.x, 1u) + 1u;
    var turns = 0u;
    while turns < wanted { turns += 1u; }
    return turns < wanted;
}

@compute @workgroup_size(8, 8) fn trace(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= tile.size.x || id.y >= tile.size.y { return; }
    let p = tile.corner + id.xy;
    var work = 0.0;
    for (var i = 0u; i < u32(params[0]); i++) { work = fract(work * 1.3 + f32(i) * table[0].x); }
    if is_cut_short() { atomicStore(&counters[16], 1u); }
    let at = (p.y - frame.band.x) * frame.size.x + p.x;
    let cells = cells(8u);
    let cell = cones[frame.wide_cones + (p.y / 8u - frame.band.x / 8u) * cells.x + p.x / 8u].x;
    samples[at].colour = vec3f(f32(p.x), f32(p.y), f32(tile.index) + min(work, 0.0));
    samples[at].depth = select(cell, f32(code[0]), frame.prepass == 0u);
    atomicAdd(&counters[12], 1u);
    if p.x == 0u { atomicAdd(&counters[14], 1u); }
    // 2^32 evaluations: the high half of a counter counts too
    if p.x == 0u && p.y == 0u { atomicAdd(&counters[3], 1u); }
}

@compute @workgroup_size(8, 8) fn gather(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= tile.size.x || id.y >= tile.size.y { return; }
    let p = tile.corner + id.xy;
    let to = (p.y - frame.band.z) * frame.size.x + p.x;
    let source = (p.y - frame.band.x) * frame.size.x + p.x;
    if tile.index == 0u {
        light_sums[to].colour = vec3f(0.0);
        light_sums[to].weight = 0.0;
    }
    // the rows that the band stores beside those that it gives: two where samples are filtered, for the widest filter
    let last = frame.band.x + frame.band.y - 1u;
    let below = samples[(min(p.y + select(0u, 2u, frame.samples != 0u), last) - frame.band.x) * frame.size.x + p.x].colour.y;
    light_sums[to].colour += vec3f(samples[source].colour.x, below, samples[source].colour.z);
    light_sums[to].weight += 1.0;
    surface_sums[to].depth = samples[source].depth;
}

@compute @workgroup_size(8, 8) fn develop(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= tile.size.x || id.y >= tile.size.y { return; }
    let p = tile.corner + id.xy;
    let at = (p.y - frame.band.z) * frame.size.x + p.x;
    if frame.sums_a.x != 0xffffffffu {
        let to = frame.sums_a.x + 3u * at;
        let colour = light_sums[at].colour;
        planes[to] = colour.x;
        planes[to + 1u] = colour.y;
        planes[to + 2u] = colour.z;
        planes[frame.sums_a.z + at] = light_sums[at].weight;
    }
    if frame.sums_b.x != 0xffffffffu { planes[frame.sums_b.x + at] = surface_sums[at].depth; }
}
