// Samples along a way that bends upwards (Tomczak 2012, algorithm 3.7).

fn ao_bent(at: Surface, how: Occluder) -> f32 {
    var n = at.normal;
    var sum = 0.0;
    var weight = 1.0;
    for (var k = 1u; k <= u32(how.count); k++) {
        let far = f32(k) * how.reach;
        weight /= BENT_FALL;
        sum += weight * (length(n) * far - around(at, at.point + n * far));
        n += UP * how.bend;
    }
    return visibility(sum, how.scale);
}
