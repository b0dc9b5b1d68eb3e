// Where samples go, the same in every run: low-discrepancy sequences scrambled by pixel, and the pixel's filter.

/// The bits in reverse order. (WebGL 2 has no function for it.)
fn mirror_bits(x: u32) -> u32 {
    var v = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
    v = ((v >> 2u) & 0x33333333u) | ((v & 0x33333333u) << 2u);
    v = ((v >> 4u) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4u);
    v = ((v >> 8u) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8u);
    return (v >> 16u) | (v << 16u);
}

/// The first two dimensions of Sobol's sequence (1967), as fractions of 2^32.
fn sobol(index: u32) -> vec2u {
    var i = index;
    var direction = 0x80000000u;
    var second = 0u;
    while (i != 0u) {
        if ((i & 1u) == 1u) {
            second ^= direction;
        }
        i >>= 1u;
        direction ^= direction >> 1u;
    }
    return vec2u(mirror_bits(index), second);
}

/// Two random numbers of a pixel: the generator pcg3d (Jarzynski and Olano 2020).
fn scramble(pixel: vec2u, seed: u32) -> vec2u {
    var v = vec3u(pixel, seed) * 1664525u + 1013904223u;
    for (var k = 0; k < 2; k++) {
        v.x += v.y * v.z;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v ^= v >> vec3u(16u);
    }
    return v.xy;
}

/// Sample number `index` of a sequence, in the unit square.
fn unit_point(index: u32, key: vec2u) -> vec2f {
    return vec2f((sobol(index) ^ key) >> vec2u(8u)) * (1.0 / 16777216.0);
}

/// Where in its pixel ray number `index` goes through.
fn jitter(pixel: vec2u, index: u32) -> vec2f {
    if (frame.samples == 0u) {
        return vec2f(0.5);
    }
    return unit_point(index, scramble(pixel, frame.seed));
}

/// Two directions that make an orthonormal basis with a third (Duff et al. 2017): columns.
fn basis(n: vec3f) -> mat2x3f {
    let sign = select(1.0, -1.0, n.z < 0.0);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    return mat2x3f(
        vec3f(n.x * n.x * a * sign + 1.0, sign * b, -sign * n.x),
        vec3f(b, sign + n.y * n.y * a, -n.y),
    );
}

/// A direction around `normal`, spread by the cosine law, from a point of the unit square.
fn cosine_direction(normal: vec3f, u: vec2f) -> vec3f {
    let angle = u.y * 6.2831855;
    let around = basis(normal) * (sqrt(u.x) * vec2f(cos(angle), sin(angle)));
    return around + normal * sqrt(max(1.0 - u.x, 0.0));
}

/// Weight of a sample along one axis, at `x` pixels from a pixel's middle.
fn filter_weight(x: f32) -> f32 {
    return filter_at(abs(x));
}

/// One pixel wide, constant.
fn filter_box(d: f32) -> f32 {
    return select(1.0, 0.0, d > 0.5);
}

/// Two pixels wide, linear.
fn filter_tent(d: f32) -> f32 {
    return max(1.0 - d, 0.0);
}

/// Four pixels wide (Mitchell and Netravali 1988, equation 8, with B = C = 1/3).
fn filter_mitchell(d: f32) -> f32 {
    let near = ((d * 7.0 - 12.0) * d * d + 16.0 / 3.0) * (1.0 / 6.0);
    let far = (((d * (-7.0 / 3.0) + 12.0) * d - 20.0) * d + 32.0 / 3.0) * (1.0 / 6.0);
    return select(select(0.0, far, d < 2.0), near, d < 1.0);
}
