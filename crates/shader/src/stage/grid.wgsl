// Samples of fields.

/// The sample of a grid at a node, whose coordinates are whole numbers within the grid.
fn grid_sample(number: f32, node: vec3f) -> f32 {
    let grid = load_grid(frame.grid_rows + u32(number) * GRID_ROWS);
    let at = (u32(node.z) * u32(grid.nodes_y) + u32(node.y)) * u32(grid.nodes_x) + u32(node.x);
    return grid_texel(u32(grid.row) * TEXTURE_SIDE + u32(grid.column) + at);
}

/// A sample of a mip of the volume, whose nodes are so many: `place` is in its voxels, within it.
fn volume_sample(number: f32, nodes: vec3f, place: vec3f) -> f32 {
    let p = clamp(place, vec3f(0.0), nodes - 1.0);
    let first = min(floor(p), nodes - 2.0);
    let t = p - first;
    var rows: array<f32, 4>;
    for (var k = 0u; k < 4u; k++) {
        let node = first + vec3f(0.0, f32(k & 1u), f32(k >> 1u));
        let a = grid_sample(number, node);
        let b = grid_sample(number, node + vec3f(1.0, 0.0, 0.0));
        rows[k] = a + (b - a) * t.x;
    }
    let near = rows[0] + (rows[1] - rows[0]) * t.y;
    let far = rows[2] + (rows[3] - rows[2]) * t.y;
    return near + (far - near) * t.z;
}
