
fn pattern_triplanar(part: TexturePart, at: Place) -> vec3f {
    return vec3f(0.0);
}
