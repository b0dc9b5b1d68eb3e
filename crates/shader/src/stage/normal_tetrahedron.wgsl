// Four samples at the corners of a tetrahedron.

fn gradient(p: vec3f, pixel: f32) -> vec3f {
    let h = sample_step(p, pixel);
    var sum = vec3f(0.0);
    for (var k = 0u; k < 4u; k++) {
        let corner = vec3f(vec3u(((k + 3u) >> 1u) & 1u, (k >> 1u) & 1u, k & 1u)) * 2.0 - 1.0;
        sum += corner * field(p + corner * h);
    }
    counted[COUNT_NORMAL] += 4u;
    return sum;
}
