// Samples of fields.

/// The sample of a grid at a node, whose coordinates are whole numbers within the grid.
fn grid_sample(number: f32, node: vec3f) -> f32 {
    let grid = load_grid(frame.grid_rows + u32(number) * GRID_ROWS);
    let at = (u32(node.z) * u32(grid.nodes_y) + u32(node.y)) * u32(grid.nodes_x) + u32(node.x);
    return grid_texel(u32(grid.row) * TEXTURE_SIDE + u32(grid.column) + at);
}
