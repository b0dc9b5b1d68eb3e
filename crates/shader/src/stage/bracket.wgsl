// Where a ray ends, and how the place is found at which the field changes its sign.

/// Where a ray ended.
struct Found {
    hit: bool,
    t: f32,
    /// Value of the field where it was found under the footprint, from the side that was marched; 0 where it changed its sign.
    f: f32,
    /// 1, or -1 where the ray began inside the solid.
    side: f32,
    steps: u32,
}

/// The part of a ray in which the field changes its sign.
struct Bracket {
    /// The place before the surface, and the value there.
    before: f32,
    above: f32,
    /// The place behind it, and the value there.
    behind: f32,
    below: f32,
    /// 1 where the last guess was before the surface, -1 where it was behind it, 0 where there was none.
    last: f32,
}

/// Where the line through the values at both ends is zero.
fn bracket_root(part: Bracket) -> f32 {
    let share = clamp(part.above / max(part.above - part.below, 1e-30), 0.0, 1.0);
    return part.before + (part.behind - part.before) * share;
}

/// The part that is left after a sample within it: false position, with the value at the end that stays a second time halved
/// (Illinois; Dowell and Jarratt 1971).
fn bracket_narrowed(part: Bracket, at: f32, value: f32) -> Bracket {
    var rest = part;
    if (value < 0.0) {
        rest.behind = at;
        rest.below = value;
        rest.above *= select(1.0, 0.5, part.last < 0.0);
        rest.last = -1.0;
    } else {
        rest.before = at;
        rest.above = value;
        rest.below *= select(1.0, 0.5, part.last > 0.0);
        rest.last = 1.0;
    }
    return rest;
}
