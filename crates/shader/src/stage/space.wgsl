// Materials that lie in the spaces of what they were painted on.

fn in_space_of(m: Material, at: Place) -> Mapped {
    let p = field_place(u32(m.place), at.point);
    let point = vec3f(p[0].x, p[1].x, p[2].x);
    return mapped(at, point, p[0].yzw, p[1].yzw, p[2].yzw);
}
