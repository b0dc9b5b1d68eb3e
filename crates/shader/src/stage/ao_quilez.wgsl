// Samples along the normal with halving weights (Tomczak 2012, algorithm 3.4 with the sum of equation 3.31).

fn ao_quilez(at: Surface, how: Occluder) -> f32 {
    var sum = 0.0;
    var weight = 1.0;
    for (var k = 1u; k <= u32(how.count); k++) {
        let far = f32(k) * how.reach;
        weight *= QUILEZ_FALL;
        sum += weight * (far - around(at, at.point + at.normal * far));
    }
    return visibility(sum, how.scale);
}
