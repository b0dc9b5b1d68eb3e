// As the hemisphere, with near occluders counting more: 1 - exp(-tau d) (Tomczak 2012, equations 3.19 to 3.24).

fn ao_obscurance(at: Surface, how: Occluder, key: vec2u) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < u32(how.count); k++) {
        let to = cosine_direction(at.normal, unit_point(k, key));
        if (dot(at.normal, to) > 0.0) {
            let traced = secondary_ray(at, to, how.reach, SHADOW_HARD, 0.0);
            counted[COUNT_OCCLUSION] += traced.samples;
            sum += select(obscurance(traced.t, how.scale), 1.0, traced.light > 0.0);
        }
    }
    return sum / max(how.count, 1.0);
}
