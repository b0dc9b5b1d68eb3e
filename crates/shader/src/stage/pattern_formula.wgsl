// The twin of `formula_shown` in `shade/pattern.rs`.

/// What is shown of a formula, as a colour or as a height.
fn pattern_formula(part: TexturePart, at: Place, heights: bool) -> vec3f {
    let seen = field_colour(u32(part.size), at.point);
    let known = all(abs(seen) < vec3f(FORMULA_LARGEST));
    let colour = select(FORMULA_UNKNOWN, seen, known);
    let low = select(0.0, -FORMULA_HIGHEST, heights);
    let high = select(1.0, FORMULA_HIGHEST, heights);
    return clamp(colour, vec3f(low), vec3f(high));
}
