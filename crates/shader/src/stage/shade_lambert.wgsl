// Lambert's cosine law, albedo / pi, with inverse squares for point lights (Munini 2021, 3.3).

const DIFFUSE_SCALE: f32 = 0.31830987;

fn falloff(light: Light, distance: f32) -> f32 {
    return select(1.0 / max(distance * distance, 1e-12), 1.0, light.kind == 0.0);
}

fn highlight(at: Surface, to: vec3f, cosine: f32, shininess: f32) -> f32 {
    return 0.0;
}

fn surface_colour(what: Substance, light: Arrival, at: Surface, seen: Openness) -> vec3f {
    return what.albedo * (light.diffuse + ambient_light(seen.bent.y) * seen.open) + what.emission;
}
