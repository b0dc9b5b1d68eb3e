// Reflections and clear bodies (Whitted 1980). The twin of `Whitted` of the CPU renderer.

/// Sends rays on from a surface that a ray met at the distance `t`, into `next`. Gives the share of its reflection that they follow. The
/// twin of `Whitted::go_on` of the CPU renderer.
fn go_on(path: Onward, at: Surface, t: f32, what: LocalMaterial, material: f32, next: ptr<function, array<Onward, 2>>) -> f32 {
    let inside = at.side < 0.0;
    let clear = what.finish.w * (1.0 - what.finish.y);
    let smooth_share = followed_share(what.finish.z);
    if (clear <= 0.0 && (inside || smooth_share <= 0.0)) {
        return 0.0;
    }
    let d = at.direction;
    let n = what.normal;
    let cosine = clamp(-dot(n, d), 0.0, 1.0);
    let travelled = t + path.ray.travelled;
    let body = body_of(path, material);
    var medium = -1.0;
    var weight = path.weight * (1.0 - select(haze(path.ray, t), 0.0, inside));
    if (inside) {
        weight *= transmittance(body.attenuation, t);
        medium = select(material, path.medium, path.medium >= 0.0);
    }
    var reflected = vec3f(0.0);
    if (!inside) {
        reflected = mirror_reflectance(what.albedo, what.finish, cosine) * (smooth_share * (1.0 - clear));
    }
    let bounces = path.bounces + select(vec2u(1u, 0u), vec2u(0u, 1u), inside);
    if (clear > 0.0) {
        let met = border(d, n, select(body.ior, 1.0 / body.ior, inside));
        reflected += vec3f(clear * met.w);
        let through = clear * (1.0 - met.w);
        let colour = select(what.albedo, vec3f(1.0), inside);
        let passed = weight * colour * through;
        if (path.bounces.y < frame.refractions && is_bright(passed)) {
            let ray = Ray(at.point - at.normal * at.offset, kept_on(met.xyz, -at.normal), path.ray.narrow, travelled);
            (*next)[0] = Onward(ray, passed, path.bounces + vec2u(0u, 1u), select(material, -1.0, inside), 0u, path.pixel, path.index, 0.0, -1.0, FAR, -1.0);
        }
    }
    let mirrored = weight * reflected;
    if (bounces.x <= frame.reflections && bounces.y <= frame.refractions && is_bright(mirrored)) {
        let ray = Ray(at.point + at.normal * at.offset, kept_on(d + n * (2.0 * cosine), at.normal), path.ray.narrow, travelled);
        (*next)[1] = Onward(ray, mirrored, bounces, medium, 0u, path.pixel, path.index, 0.0, -1.0, FAR, -1.0);
        return smooth_share + (1.0 - smooth_share) * clear;
    }
    return clear;
}

/// Whether light of this weight is worth a ray.
fn is_bright(weight: vec3f) -> bool {
    return max(max(weight.x, weight.y), weight.z) >= FAINTEST;
}
