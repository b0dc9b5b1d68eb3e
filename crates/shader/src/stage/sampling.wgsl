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
    var v = vec3u(pixel, seed) * PCG_FACTOR + PCG_SUMMAND;
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
    return vec2f((sobol(index) ^ key) >> vec2u(8u)) * UNIT;
}

/// A hash of a number whose bit k depends on lower bits alone (Laine and Karras 2011, with the constants of Burley 2020).
fn laine_karras(number: u32, seed: u32) -> u32 {
    var x = number + seed;
    x ^= x * LAINE_KARRAS_A;
    x ^= x * LAINE_KARRAS_B;
    x ^= x * LAINE_KARRAS_C;
    return x ^ (x * LAINE_KARRAS_D);
}

fn owen(x: u32, seed: u32) -> u32 {
    return mirror_bits(laine_karras(mirror_bits(x), seed));
}

/// Two random numbers of ray number `index` of a pixel for a decision of its own.
fn decided_point(pixel: vec2u, index: u32, decision: u32) -> vec2f {
    let key = scramble(pixel, frame.seed ^ HIT_SEEDS);
    let a = scramble(key, decision);
    let c = scramble(key.yx, ~decision);
    let at = sobol(owen(index, c.x));
    return vec2f(vec2u(owen(at.x, a.x), owen(at.y, a.y)) >> vec2u(8u)) * UNIT;
}

/// Where in its pixel ray number `index` goes through.
fn jitter(pixel: vec2u, index: u32) -> vec2f {
    if (frame.samples == 0u) {
        return vec2f(0.5);
    }
    return unit_point(index, scramble(pixel, frame.seed));
}

/// Whether rays begin all over a lens: one ray a pixel goes through its middle.
fn has_lens() -> bool {
    return frame.aperture > 0.0 && frame.samples != 0u;
}

/// Ray number `index` of a pixel, through the place `at` of the picture.
fn pixel_ray(at: vec2f, pixel: vec2u, index: u32) -> Ray {
    if (!has_lens()) {
        return camera_ray(at);
    }
    return lens_ray(at, on_disc(decided_point(pixel, index, LENS_DECISION)) * frame.aperture);
}
