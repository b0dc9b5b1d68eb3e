// Where secondary rays start.

/// A place on a surface that light falls on.
struct Surface {
    point: vec3f,
    normal: vec3f,
    /// 1, or -1 where it is seen from inside the solid.
    side: f32,
    /// How far secondary rays start from it.
    offset: f32,
    /// The ray that sees it.
    direction: vec3f,
}
