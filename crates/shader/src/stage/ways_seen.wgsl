// What a surface sees of the sky and of lights, where an occlusion method and shadows say it.

/// How much of the sky a surface sees.
fn sky_visibility(at: Surface, how: Occluder, key: vec2u) -> AmbientVisibility {
    return occlusion(at, how, key);
}

/// How much of the sky's light a surface gets that sees all of it.
fn ambient_share() -> f32 {
    return frame.ambient;
}

/// Where a light is looked for: direction and distance.
fn aim(path: Onward, light: Light, number: u32, p: vec3f) -> vec4f {
    return towards(light, p);
}

/// The shadow of a light as it is found.
fn shadow_kind(light: Light) -> u32 {
    return u32(light.shadow);
}

/// How much of the lights shines on a surface.
fn shining(path: Onward) -> f32 {
    return 1.0;
}

/// What a ray that goes on sees where it meets nothing.
fn sky_of(path: Onward) -> vec3f {
    return sky_along(path.ray, path.ray.travelled == 0.0);
}

/// What arrives from all around as it counts where it lights the scene.
fn as_lighting(path: Onward, answer: vec4f) -> vec4f {
    return answer;
}

/// What mirrored rays see is no highlight.
fn counted_light(path: Onward, answer: vec4f, to: vec3f, found: f32, at: Surface, what: LocalMaterial, followed: f32) -> vec4f {
    return vec4f(answer.x, answer.yz * (1.0 - followed), answer.w);
}
