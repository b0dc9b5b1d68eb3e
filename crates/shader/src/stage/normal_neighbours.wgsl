// Samples at the neighbours in a cube of 27: those that differ in at most NEIGHBOUR_AXES coordinates are 6 (central
// differences), 18 or 26 (Tomczak 2012, 3.1).

fn gradient(p: vec3f, pixel: f32) -> vec3f {
    let h = sample_step(p, pixel);
    var sum = vec3f(0.0);
    for (var k = 0u; k < 27u; k++) {
        let to = vec3f(vec3u(k % 3u, k / 3u % 3u, k / 9u)) - 1.0;
        let axes = dot(to, to);
        if (axes > 0.0 && axes <= NEIGHBOUR_AXES) {
            sum += normalize(to) * field(p + to * h);
            counted[COUNT_NORMAL] += 1u;
        }
    }
    return sum;
}
