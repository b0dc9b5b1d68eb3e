// How light becomes colour.

/// What a surface is made of at one place: where materials meet, a mixture of them.
struct LocalMaterial {
    albedo: vec3f,
    emission: vec3f,
    specular: f32,
    metallic: f32,
    roughness: f32,
    shininess: f32,
}

/// Light that a hit gets.
struct Arrival {
    /// By the cosine law.
    diffuse: vec3f,
    /// In the highlight, before the material's strength.
    gloss: vec3f,
    /// How much there would be without shadows, and how much there is.
    share: f32,
    lit: f32,
}

/// Direction to a light, and its distance.
fn towards(light: Light, p: vec3f) -> vec4f {
    if (light.kind == 0.0) {
        return vec4f(light.place, FAR);
    }
    return towards_point(light.place, p);
}

/// What arrives from all lights.
fn arriving(at: Surface, shininess: f32) -> Arrival {
    var sum = Arrival(vec3f(0.0), vec3f(0.0), 0.0, 0.0);
    let origin = at.point + at.normal * at.offset;
    for (var k = 0u; k < frame.lights; k++) {
        let light = load_light(frame.light_rows + k * LIGHT_ROWS);
        let ray = towards(light, origin);
        let lit = shadow(at, light, ray.xyz, ray.w);
        let to = towards(light, at.point);
        // by the cosine law, in the highlight, and what distance leaves
        let answer = light_response(to.xyz, to.w, light.kind, at.normal, at.direction, shininess);
        let power = answer.z * lit;
        sum.diffuse += light.radiance * (answer.x * power);
        sum.gloss += light.radiance * (answer.y * power);
        sum.share += answer.z * light.luminance;
        sum.lit += power * light.luminance;
    }
    return sum;
}

/// The colour of a surface in the light that it gets.
fn colour_of(what: LocalMaterial, light: Arrival, at: Surface, seen: AmbientVisibility) -> vec3f {
    return surface_colour(
        what.albedo, what.emission, what.specular, what.metallic, what.roughness,
        light.diffuse, light.gloss, seen.open, seen.bent, at.normal, at.direction,
        frame.sky_horizon, frame.sky_top, frame.sky_bottom, frame.ambient,
    );
}
