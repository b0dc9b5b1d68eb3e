// (n . l) colour / (4 pi) without falloff, as printed in Munini 2021, 3.3.

const DIFFUSE_SCALE: f32 = 0.079577472;

fn falloff(light: Light, distance: f32) -> f32 {
    return 1.0;
}

fn highlight(at: Surface, to: vec3f, cosine: f32, shininess: f32) -> f32 {
    return 0.0;
}

fn surface_colour(what: Substance, light: Arrival, at: Surface, seen: Openness) -> vec3f {
    return what.albedo * (light.diffuse + ambient_light(seen.bent.y) * seen.open) + what.emission;
}
