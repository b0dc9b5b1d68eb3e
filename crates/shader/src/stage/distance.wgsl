// How far a ray may go from a place, and what is shown as the distance to the surface there: both are the value of the field.

fn sensed(p: vec3f) -> vec2f {
    return vec2f(field(p));
}
