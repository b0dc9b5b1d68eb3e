// A scene without lamps.

/// The light of all lamps that a ray meets before it ends at `t`.
fn glow(path: Onward, t: f32) -> vec3f {
    return vec3f(0.0);
}

/// Where a lamp is looked for: direction and distance.
fn aim_lamp(path: Onward, lamp: Light, number: u32, p: vec3f) -> vec4f {
    return vec4f(0.0);
}

/// What arrives of a lamp: by the cosine law, in the highlight, the part of that at grazing angles, and what distance leaves.
fn lamp_response(path: Onward, lamp: Light, ray: vec4f, at: Surface, what: LocalMaterial, followed: f32, origin: vec3f) -> vec4f {
    return vec4f(0.0);
}

/// Whether rays may meet lights that are looked for too.
fn meets_lights() -> bool {
    return false;
}
