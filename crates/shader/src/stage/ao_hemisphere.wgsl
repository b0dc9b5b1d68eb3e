// Cosine-weighted sampled visibility: the reference (Tomczak 2012, equation 3.18).

fn ao_hemisphere(at: Surface, how: Occluder, key: vec2u) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < u32(how.count); k++) {
        let to = cosine_direction(at.normal, unit_point(k, key));
        if (dot(at.normal, to) > 0.0) {
            let traced = secondary_ray(at, to, how.reach, SHADOW_HARD, 0.0);
            counted[COUNT_OCCLUSION] += traced.samples;
            sum += traced.light;
        }
    }
    return sum / max(how.count, 1.0);
}
