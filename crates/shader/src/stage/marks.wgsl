// Which object and which materials a point belongs to; the twin of `eval/marks.rs` of the field.

// Numbers of objects and materials are whole; -1 where there is none.
struct Marks {
    object: f32,
    // the material that counts most
    first: f32,
    // the material that counts second
    second: f32,
    // share of the second, 0 to 1/2
    share: f32,
    // how near the orbit of a fractal came to the origin and to the planes x = 0, y = 0 and z = 0; zero elsewhere
    orbit: vec4f,
}

// Marks of a joined value from those of its sides, of which it follows the second by `share`.
fn join_marks(a: Marks, b: Marks, share: f32) -> Marks {
    var near = a;
    var far = b;
    var w = share;
    if (!(share <= 0.5)) {
        near = b;
        far = a;
        w = 1.0 - share;
    }
    var first = near.first;
    var weight = (1.0 - w) * (1.0 - near.share);
    // what competes for the second place: the near side's second material and the far side's first
    var second = near.second;
    var rest = (1.0 - w) * near.share;
    let other = w * (1.0 - far.share);
    if (far.first == first) {
        weight += other;
    } else if (far.first == second) {
        rest += other;
    } else if (other > rest) {
        second = far.first;
        rest = other;
    }
    if (rest > weight) {
        return Marks(near.object, second, first, weight / (weight + rest), near.orbit);
    }
    return Marks(near.object, first, second, select(0.0, rest / (weight + rest), rest > 0.0), near.orbit);
}

// What has no material yet has this one.
fn mark_material(marks: Marks, number: f32) -> Marks {
    var out = marks;
    out.first = select(out.first, number, out.first < 0.0);
    return out;
}

// What is of no object yet is of this one.
fn mark_object(marks: Marks, number: f32) -> Marks {
    var out = marks;
    out.object = select(out.object, number, out.object < 0.0);
    return out;
}
