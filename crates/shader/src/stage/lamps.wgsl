// Lamps: lights with an extent, that surfaces see parts of and rays may meet. The twin of `trace/lamps.rs`.

/// The way `t` leaves so much of light along a ray.
fn left_of(path: Onward, t: f32) -> vec3f {
    if (path.medium >= 0.0) {
        return transmittance(material_numbered(path.medium).attenuation, t);
    }
    return vec3f(1.0 - haze(path.ray, t));
}

/// Where a ray meets a lamp, and what distance leaves; not above 0 where it does not.
fn meet_lamp(lamp: Light, ray: Ray) -> vec2f {
    if (lamp.kind == LAMP_SPHERE) {
        return meet_sphere(lamp.place, lamp.radius, ray.origin, ray.direction);
    }
    let met = meet_sheet(lamp.place, lamp.right, lamp.up, ray.origin, ray.direction);
    let within = select(dot(met.yz, met.yz) <= 1.0, max(abs(met.y), abs(met.z)) <= 1.0, lamp.kind == LAMP_RECTANGLE);
    if (!within || !(met.x > 0.0)) {
        return vec2f(-1.0, 0.0);
    }
    return vec2f(met.x, sheet_falloff(lamp.right, lamp.up, ray.direction, met.x));
}

/// The light of all lamps that a ray meets before it ends at `t`.
fn glow(path: Onward, t: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var k = 0u; k < frame.lights; k++) {
        let lamp = load_light(frame.light_rows + k * LIGHT_ROWS);
        if (lamp.kind < LAMP_RECTANGLE || lamp.visible == 0.0) {
            continue;
        }
        let met = meet_lamp(lamp, path.ray);
        if (!(met.x > 0.0 && met.y > 0.0 && met.x < t)) {
            continue;
        }
        var counts = 1.0;
        if (path.density >= 0.0) {
            counts = balance(path.density, lamp_density(met.y, lamp.area));
        }
        sum += lamp.radiance * (counts * LAMP_PI / lamp.area) * left_of(path, met.x);
    }
    return sum;
}

/// Where a lamp is looked for: direction and distance.
fn aim_lamp(path: Onward, lamp: Light, number: u32, p: vec3f) -> vec4f {
    if (lamp.kind == LAMP_AROUND) {
        return vec4f(lamp.place, FAR);
    }
    let surfaces = path.bounces.x + path.bounces.y;
    let u = decided_point(path.pixel, path.index, surfaces * PATH_DECISIONS + 2u + number);
    if (lamp.kind == LAMP_SPHERE) {
        return towards_sphere(lamp.place, lamp.radius, p, u);
    }
    var on = u * 2.0 - 1.0;
    if (lamp.kind == LAMP_DISC) {
        on = on_disc(u);
    }
    return towards_sheet(lamp.place, lamp.right, lamp.up, p, on);
}

/// What arrives of a lamp: by the cosine law, in the highlight, the part of that at grazing angles, and what distance leaves.
fn lamp_response(path: Onward, lamp: Light, ray: vec4f, at: Surface, what: LocalMaterial, followed: f32, origin: vec3f) -> vec4f {
    var falloff = 1.0;
    var found = lamp.area;
    if (lamp.kind == LAMP_SPHERE) {
        falloff = seen_sphere(lamp.place, lamp.radius, origin);
    } else if (lamp.kind != LAMP_AROUND) {
        falloff = sheet_falloff(lamp.right, lamp.up, ray.xyz, ray.w);
    }
    if (lamp.kind != LAMP_AROUND) {
        found = lamp_density(falloff, lamp.area);
    }
    var answer = light_response(ray.xyz, ray.w, 0.0, what.normal, at.direction, light_finish(what));
    if (lamp.visible != 0.0) {
        answer = counted_light(path, answer, ray.xyz, found, at, what, followed);
    }
    if (lamp.kind == LAMP_AROUND) {
        answer = as_lighting(path, answer);
    }
    return vec4f(answer.xyz, falloff * (1.0 - haze(ray_from(origin, ray.xyz), min(ray.w, ENDLESS))));
}

/// Whether rays may meet lights that are looked for too.
fn meets_lights() -> bool {
    return true;
}
