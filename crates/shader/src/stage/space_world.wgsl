// Materials that lie in the world.

fn in_space_of(m: Material, at: Place) -> Mapped {
    return Mapped(at, vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0));
}
