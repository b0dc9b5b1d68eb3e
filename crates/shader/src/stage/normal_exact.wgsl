// The exact normal, by dual numbers.

fn gradient(p: vec3f, pixel: f32) -> vec3f {
    counted[COUNT_NORMAL] += 1u;
    return field_gradient(p).yzw;
}
