// Ambient, diffuse and Blinn's specular term with `facing` (Tomczak 2012, equations 3.1 to 3.5).

const DIFFUSE_SCALE: f32 = 1.0;

fn falloff(light: Light, distance: f32) -> f32 {
    return select(1.0 / max(distance * distance, 1e-12), 1.0, light.kind == 0.0);
}

/// Blinn's half vector; zero where the light is behind the surface (equation 3.5).
fn highlight(at: Surface, to: vec3f, cosine: f32, shininess: f32) -> f32 {
    if (!(cosine > 0.0)) {
        return 0.0;
    }
    let half = to - at.direction;
    let aligned = clamp(dot(at.normal, half) / max(length(half), 1e-12), 1e-8, 1.0);
    return exp(log(aligned) * shininess);
}

/// The reflection is the sky's colour along the mirror direction, dimmed to its ambient colour by roughness and weighted by
/// Schlick's (1994) approximation of Fresnel's law.
fn surface_colour(what: Substance, light: Arrival, at: Surface, seen: Openness) -> vec3f {
    let dull = 1.0 - what.metallic;
    let incoming = what.albedo * (light.diffuse + ambient_light(seen.bent.y) * seen.open);
    // highlights and reflections of metals take their colour
    let tinted = what.albedo * what.metallic + dull;
    let cosine = -dot(at.normal, at.direction);
    let mirror = at.direction + at.normal * (cosine * 2.0);
    let wide = ambient_light(at.normal.y) / max(frame.ambient, 1e-3);
    let heaven = mix(sky_colour(mirror.y), wide, what.roughness);
    let grazing = pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0);
    let smooth_share = 1.0 - what.roughness;
    let straight = what.albedo * what.metallic + dull * DIELECTRIC;
    let mirrored = mix(straight, vec3f(1.0), grazing * smooth_share) * (smooth_share * seen.open);
    // what a rough metal does not mirror it scatters: the ambient light in its own colour
    let scattered = incoming * (what.metallic * what.roughness);
    return incoming * dull + scattered + tinted * light.gloss * what.specular + mirrored * heaven + what.emission;
}
