
fn pattern_formula(part: TexturePart, at: Place, heights: bool) -> vec3f {
    return vec3f(0.0);
}
