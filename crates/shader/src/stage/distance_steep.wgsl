// How far a ray may go from a place: the value of the field; and what is shown as the distance to the surface there: that value
// where it is close to the distance, else the value over the length of the gradient (Taubin 1994), which no constant that the
// value was divided by changes.

fn sensed(p: vec3f) -> vec2f {
    let there = field_gradient(p);
    return vec2f(there.x, select(there.x / max(length(there.yzw), FLAT_SLOPE), there.x, is_close()));
}
