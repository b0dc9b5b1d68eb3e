// The cone prepass: squares of pixels are marched as one cone each, so that their rays start near the surface.
//
// A cone of slope k is free up to t where the field is larger than its radius w = k t + c. Its clearance (f - w) / (1 + k) is
// a distance along the axis: it changes by at most 1 per unit, as the field does along a ray. So cones are marched like rays.

/// Where the rays of a cell start, the slope of the field along them, and where they end. They start at infinity where there
/// is nothing to hit.
struct Span {
    start: f32,
    slope: f32,
    end: f32,
}

/// Marches the cone of the cell of `side` pixels whose corner is `corner`.
fn march_cone(corner: vec2u, side: f32, above: Span) -> Span {
    let middle = vec2f(corner) + 0.5 * side;
    let width = cone_width(middle, 0.5 * (side - 1.0) + select(0.5, 0.0, frame.samples == 0u));
    let ray = camera_ray(middle);
    let wide = width + frame.threshold;
    var t = max(max(enter(ray, wide.x, wide.y), frame.near), above.start);
    let end = min(min(leave(ray, wide.x, wide.y), frame.far), above.end);
    if (!(t < end)) {
        return Span(FAR, -1.0, end);
    }
    let share = 1.0 / (1.0 + width.x);
    let near_slope = width.x * share * CONE_NEAR;
    let near_constant = max(width.y * share * CONE_NEAR, frame.threshold.y);
    var m = above.slope;
    var z = 0.0;
    var r = 0.0;
    var flip = 1.0;
    for (var steps = 1u; steps <= CONE_STEPS; steps++) {
        let at = t + z;
        var f = flip * field(ray.origin + ray.direction * at);
        counted[COUNT_PREPASS] += 1u;
        if (steps == 1u && f < 0.0) {
            flip = -1.0;
            f = -f;
        }
        let next = (f - (width.x * at + width.y)) * share;
        if (steps > 1u) {
            if (z > r && z > r + next) {
                m = -1.0;
                z = min(r, end - t);
                continue;
            }
            m = smoothed_slope(m, r, next, z, CONE_SMOOTHING);
        }
        t = at;
        r = next;
        if (r < near_slope * t + near_constant) {
            return Span(t, m, end);
        }
        if (t + r >= end) {
            return Span(FAR, -1.0, end);
        }
        z = min(slope_step(r, m), end - t);
    }
    return Span(t, -1.0, end);
}

/// Cells of `side` pixels across the picture.
fn cells_across(side: u32) -> u32 {
    return (frame.size.x + side - 1u) / side;
}

/// Where in `cones` the cell of 8x8 pixels is that holds a pixel.
fn cone_of(pixel: vec2u) -> u32 {
    return frame.wide_cones + (pixel.y / 8u - frame.band.x / 8u) * cells_across(8u) + pixel.x / 8u;
}
