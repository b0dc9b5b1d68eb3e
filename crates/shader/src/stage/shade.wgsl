// How light becomes colour.

/// What a surface is made of at one place: where materials meet, a mixture of them.
struct LocalMaterial {
    albedo: vec3f,
    emission: vec3f,
    /// Specular, metallic, roughness, transmission.
    finish: vec4f,
    shininess: f32,
    /// The normal that light meets: with the heights of bumps.
    normal: vec3f,
}

/// Light that a hit gets.
struct Arrival {
    /// By the cosine law.
    diffuse: vec3f,
    /// In the highlight, before the material's strength.
    gloss: vec3f,
    /// The part of it that the rise of Fresnel's law weighs.
    grazing: vec3f,
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
fn arriving(path: Onward, at: Surface, what: LocalMaterial, followed: f32) -> Arrival {
    var sum = Arrival(vec3f(0.0), vec3f(0.0), vec3f(0.0), 0.0, 0.0);
    // lights do not shine on the inner side of a clear body
    let shone = select(1.0, 1.0 - what.finish.w, at.side < 0.0);
    let origin = at.point + at.normal * at.offset;
    let all = frame.lights + lights_around();
    for (var k = 0u; k < all; k++) {
        var light = Light();
        if (k < frame.lights) {
            light = load_light(frame.light_rows + k * LIGHT_ROWS);
        } else {
            light = light_around(path);
        }
        let is_lamp = light.kind >= LAMP_RECTANGLE;
        var ray = vec4f(0.0);
        if (is_lamp) {
            ray = aim_lamp(path, light, k, origin);
        } else {
            ray = aim(path, light, k, origin);
        }
        var lit = shadow(at, light, ray.xyz, ray.w);
        if (at.side < 0.0) {
            lit *= shining(path);
        }
        // by the cosine law, in the highlight, the part of that at grazing angles, and what distance leaves
        var answer = vec4f(0.0);
        if (is_lamp) {
            answer = lamp_response(path, light, ray, at, what, followed, origin);
        } else {
            let to = aim(path, light, k, at.point);
            answer = light_response(to.xyz, to.w, light.kind, what.normal, at.direction, light_finish(what));
        }
        let power = answer.w * lit;
        sum.diffuse += light.radiance * (answer.x * power);
        sum.gloss += light.radiance * (answer.y * power * shone);
        sum.grazing += light.radiance * (answer.z * power * shone);
        sum.share += answer.w * light.luminance;
        sum.lit += power * light.luminance;
    }
    return sum;
}

/// The colour of a surface in the light that it gets, but for the share of its reflection that rays follow.
fn colour_of(what: LocalMaterial, light: Arrival, at: Surface, seen: AmbientVisibility, followed: f32) -> vec3f {
    return surface_colour(
        what.albedo, what.emission, what.finish,
        light.diffuse, light.gloss, light.grazing, seen.open, seen.tint, seen.bent, what.normal, at.direction,
        frame.sky_horizon, frame.sky_top, frame.sky_bottom, ambient_share(), followed,
    );
}
