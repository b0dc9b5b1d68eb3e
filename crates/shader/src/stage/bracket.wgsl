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
    /// Samples beyond those that found where the sign changes.
    refined: u32,
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
    return part.before + (part.behind - part.before) * false_position(part.above, part.below);
}

/// Where the next sample is, after `refined` of them.
fn bracket_guess(part: Bracket, refined: u32) -> f32 {
    return select(bracket_root(part), 0.5 * (part.before + part.behind), (refined + 1u) % MIDDLE == 0u);
}

/// Whether a line from the end that a sample `value` at `at` moves to it leads to the surface within `wanted`.
fn bracket_settled(part: Bracket, at: f32, value: f32, wanted: f32) -> bool {
    if (value < 0.0) {
        return -value * (part.behind - at) < (value - part.below) * wanted || at - part.before < wanted;
    }
    return value * (at - part.before) < (part.above - value) * wanted || part.behind - at < wanted;
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
