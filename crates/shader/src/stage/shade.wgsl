// How light becomes colour.

/// What a surface is made of, where materials meet a mixture of them.
struct Substance {
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

/// Reflectance of a non-metal looked at along its normal.
const DIELECTRIC: f32 = 0.04;

/// The sky along a direction whose height is `y`: smooth from the bottom over the horizon to the top.
fn sky_colour(y: f32) -> vec3f {
    let far = select(frame.sky_top, frame.sky_bottom, y < 0.0);
    return mix(frame.sky_horizon, far, sqrt(min(abs(y), 1.0)));
}

/// What arrives of the sky at an open surface whose normal (or bent normal) has the height `y`.
fn ambient_light(y: f32) -> vec3f {
    let low = frame.sky_bottom + frame.sky_horizon;
    let rise = frame.sky_top - frame.sky_bottom;
    return (low + rise * (0.5 * y + 0.5)) * (0.5 * frame.ambient);
}

/// Direction to a light, and its distance.
fn towards(light: Light, p: vec3f) -> vec4f {
    if (light.kind == 0.0) {
        return vec4f(light.place, FAR);
    }
    let to = light.place - p;
    let distance = max(length(to), 1e-18);
    return vec4f(to / distance, distance);
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
        let power = falloff(light, to.w);
        let cosine = max(dot(at.normal, to.xyz), 0.0);
        sum.diffuse += light.radiance * (cosine * DIFFUSE_SCALE * power * lit);
        sum.gloss += light.radiance * (highlight(at, to.xyz, cosine, shininess) * power * lit);
        sum.share += power * light.luminance;
        sum.lit += power * light.luminance * lit;
    }
    return sum;
}
