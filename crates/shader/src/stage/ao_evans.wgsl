// Exponential of weighted samples at doubling distances (Evans 2006, 9.6; Tomczak 2012, equation 3.26 with its sign mended).

fn ao_evans(at: Surface, how: Occluder) -> f32 {
    let weights = EVANS;
    let n = at.normal + UP * how.bend;
    var sum = 0.0;
    var far = how.reach;
    for (var k = 0u; k < 4u; k++) {
        sum += weights[k] * (around(at, at.point + n * far) - far);
        far *= 2.0;
    }
    return exponential_visibility(sum, how.scale);
}
