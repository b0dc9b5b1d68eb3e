// The entry points of the cone prepass.

@compute @workgroup_size(8, 8, 1)
fn cones_wide(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    frame = given_frame;
    let across = cells_across(32u);
    let first = frame.band.x / 32u;
    let down = (frame.band.x + frame.band.y + 31u) / 32u - first;
    if (id.x < across && id.y < down) {
        let corner = vec2u(id.x, id.y + first) * 32u;
        let span = march_cone(corner, 32.0, Span(0.0, -1.0, FAR));
        cones[id.y * across + id.x] = vec4f(span.start, span.slope, span.end, 0.0);
    }
    count_up(local);
}

@compute @workgroup_size(8, 8, 1)
fn cones_narrow(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    frame = given_frame;
    let across = cells_across(8u);
    let first = frame.band.x / 8u;
    let down = (frame.band.x + frame.band.y + 7u) / 8u - first;
    if (id.x < across && id.y < down) {
        let cell = vec2u(id.x, id.y + first);
        let above = cones[(cell.y / 4u - frame.band.x / 32u) * cells_across(32u) + cell.x / 4u];
        let span = march_cone(cell * 8u, 8.0, Span(above.x, above.y, above.z));
        cones[frame.wide_cones + id.y * across + id.x] = vec4f(span.start, span.slope, span.end, 0.0);
    }
    count_up(local);
}
