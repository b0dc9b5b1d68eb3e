// The normal of a hit from samples around it. The sum of the samples' directions, each times the value found there, points
// along the gradient (Zucker and Hummel 1981 weight the neighbours on a grid so).

/// Least distance between samples as a share of the largest coordinate: with less, rounding would show as noise.
const LEAST_STEP: f32 = 1.0 / 16384.0;

/// Distance between the samples at `p`: half a pixel, but not less than single precision can tell.
fn sample_step(p: vec3f, pixel: f32) -> f32 {
    let q = abs(p);
    return max(max(0.5 * pixel, max(max(q.x, q.y), q.z) * LEAST_STEP), 1e-18);
}
