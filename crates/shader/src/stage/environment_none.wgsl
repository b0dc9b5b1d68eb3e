// A scene before a sky of three colours.

/// The sky along a direction.
fn sky_seen(d: vec3f) -> vec3f {
    return sky_colour(frame.sky_horizon, frame.sky_top, frame.sky_bottom, d.y);
}

/// What a surface makes of an image of light from all around.
fn surround(at: Surface, what: LocalMaterial, seen: AmbientVisibility, followed: f32) -> vec3f {
    return vec3f(0.0);
}

/// How many lights all around are looked for.
fn lights_around() -> u32 {
    return 0u;
}

/// The light from all around that is looked for from a surface.
fn light_around(path: Onward) -> Light {
    return Light();
}

/// What does not count of the light that a ray finds which is looked for too.
fn found_already(path: Onward) -> vec3f {
    return vec3f(0.0);
}
