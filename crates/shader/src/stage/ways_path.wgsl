// Path tracing: one way of many goes on from each surface. The twin of `trace/path.rs`.

/// A matte body scattered the light on its way.
const SCATTERED: u32 = 1u;
/// The last surface was that of a clear body.
const SEES_LIGHTS: u32 = 2u;

/// Two random numbers for a decision at a surface.
fn decided(path: Onward, decision: u32) -> vec2f {
    return decided_point(path.pixel, path.index, path.bounces.x * PATH_DECISIONS + decision);
}

/// What arrives from all around as it counts where it lights the scene, and where it is seen in a mirror.
fn as_lighting(path: Onward, answer: vec4f) -> vec4f {
    let mirrored = select(1.0, frame.ambient, (path.flags & SCATTERED) != 0u);
    return vec4f(answer.x * frame.ambient, answer.yz * mirrored, answer.w);
}

/// How much of what is looked for counts that rays which go on may find too: `found` is the density over directions with which it is
/// looked for.
fn counted_light(path: Onward, answer: vec4f, to: vec3f, found: f32, at: Surface, what: LocalMaterial, followed: f32) -> vec4f {
    var counted = answer;
    if (is_physical()) {
        let shine = lamp_highlight(at.normal, to, at.direction, what.finish.z);
        counted.y = shine.x;
        counted.z = shine.y;
    }
    if (path.bounces.x + 1u >= frame.depth) {
        return counted;
    }
    let scattered = scatter_density(what.albedo, what.finish, what.normal, at.direction, to);
    let clear = what.finish.w * (1.0 - what.finish.y);
    let mirrors = balance(found, scattered.y) * (1.0 - clear);
    return vec4f(counted.x * balance(found, scattered.x), counted.y * mirrors, counted.z * mirrors, counted.w);
}

/// The sky comes along the rays that meet nothing.
fn sky_visibility(at: Surface, how: Occluder, key: vec2u) -> AmbientVisibility {
    return AmbientVisibility(1.0, at.normal, vec3f(1.0));
}

fn ambient_share() -> f32 {
    return 0.0;
}

/// Lights are as wide as the penumbrae of their shadows.
fn aim(path: Onward, light: Light, number: u32, p: vec3f) -> vec4f {
    let to = towards(light, p);
    if (light.sharpness == 0.0) {
        return to;
    }
    let u = decided(path, 2u + number);
    return vec4f(cone_around(to.xyz, light_width(light.sharpness), u), to.w);
}

fn shadow_kind(light: Light) -> u32 {
    return select(SHADOW_HARD, SHADOW_NONE, u32(light.shadow) == SHADOW_NONE);
}

/// No ray finds lights from inside clear bodies.
fn shining(path: Onward) -> f32 {
    return select(1.0, 0.0, path.medium >= 0.0);
}

fn sky_of(path: Onward) -> vec3f {
    var seen = sky_along(path.ray, path.ray.travelled == 0.0);
    if (path.density >= 0.0) {
        seen -= found_already(path);
    }
    if ((path.flags & SCATTERED) != 0u) {
        seen *= frame.ambient;
    }
    if ((path.flags & SEES_LIGHTS) != 0u) {
        for (var k = 0u; k < frame.lights; k++) {
            let light = load_light(frame.light_rows + k * LIGHT_ROWS);
            let cosine = light_width(light.sharpness);
            if (light.kind == 0.0 && light.sharpness > 0.0 && dot(light.place, path.ray.direction) > cosine) {
                seen += light.radiance * disc_power(cosine);
            }
        }
    }
    return seen;
}

/// Chooses where a ray goes on from a surface that it met at the distance `t`, into `next`. Gives the share of the sky's reflection that
/// is found that way: all of it.
fn go_on(path: Onward, at: Surface, t: f32, what: LocalMaterial, material: f32, next: ptr<function, array<Onward, 2>>) -> f32 {
    let inside = at.side < 0.0;
    let body = body_of(path, material);
    if (path.bounces.x + 1u >= frame.depth || (inside && path.medium < 0.0 && what.finish.w <= 0.0)) {
        return 1.0;
    }
    let first = decided(path, 0u);
    let u = decided(path, 1u);
    let ior = select(body.ior, 1.0 / body.ior, inside);
    let choice = vec3f(first.x, u.x, u.y);
    let way = scatter_way(what.albedo, what.finish, what.normal, at.direction, ior, choice);
    let tint = select(what.albedo, vec3f(1.0), inside);
    var weight = path.weight * scatter_weight(what.albedo, what.finish, what.normal, at.direction, ior, tint, choice);
    var medium = -1.0;
    weight *= 1.0 - select(haze(path.ray, t), 0.0, inside);
    if (inside) {
        weight *= transmittance(body.attenuation, t);
        medium = select(material, path.medium, path.medium >= 0.0);
    }
    let strongest = max(max(weight.x, weight.y), weight.z);
    if (!(strongest > 0.0 && strongest < FAR)) {
        return 1.0;
    }
    if (path.bounces.x + 1u >= PATH_SURE) {
        let chance = min(strongest, PATH_LIKELIEST);
        if (first.y >= chance) {
            return 1.0;
        }
        weight /= chance;
    }
    // lobe 0, 1 or 2, and 4 where the ray goes on behind the surface
    let through = way.w > 3.5;
    let lobe = way.w - select(0.0, 4.0, through);
    if (through) {
        medium = select(material, -1.0, inside);
    }
    let side = select(1.0, -1.0, through);
    // what bumps send behind the surface that they are on is lost
    if (dot(what.normal, at.normal) < 1.0 && dot(way.xyz, at.normal) * side <= 0.0) {
        return 1.0;
    }
    let ray = Ray(at.point + at.normal * (at.offset * side), way.xyz, path.ray.narrow, t + path.ray.travelled);
    // from inside a clear body no light is looked for, nor behind one
    var density = -1.0;
    if (lobe < 1.5 && !(inside && path.medium >= 0.0) && meets_lights()) {
        let scattered = scatter_density(what.albedo, what.finish, what.normal, at.direction, way.xyz);
        density = select(scattered.x, scattered.y, lobe > 0.5);
    }
    var flags = path.flags & SCATTERED;
    flags |= select(0u, SCATTERED, lobe < 0.5) | select(0u, SEES_LIGHTS, lobe > 1.5);
    (*next)[0] = Onward(ray, weight, path.bounces + vec2u(1u, 0u), medium, flags, path.pixel, path.index, 0.0, -1.0, FAR, density);
    return 1.0;
}
