// A ray from the camera, and those that go on from where it ends: one after the other, so that the field is in one place only.

/// A material; the last one where there is none of this number.
fn material_numbered(number: f32) -> Material {
    let known = number >= 0.0 && number < f32(frame.materials);
    let which = select(frame.materials, u32(max(number, 0.0)), known);
    return load_material(frame.material_rows + which * MATERIAL_ROWS);
}

/// The clear body that a ray is in, or that it meets from outside.
fn body_of(path: Onward, met: f32) -> Material {
    return material_numbered(select(met, path.medium, path.medium >= 0.0));
}

fn local_material(number: f32, at: Place) -> LocalMaterial {
    let m = material_numbered(number);
    let finish = vec4f(m.specular, m.metallic, m.roughness, m.transmission);
    return LocalMaterial(pattern_colour(m, at), m.emission, finish, m.shininess);
}

/// Two materials mixed.
fn blend(a: LocalMaterial, b: LocalMaterial, share: f32) -> LocalMaterial {
    return LocalMaterial(
        mix(a.albedo, b.albedo, share),
        mix(a.emission, b.emission, share),
        mix(a.finish, b.finish, share),
        mix(a.shininess, b.shininess, share),
    );
}

/// What a ray found that hit nothing.
fn background(path: Onward, steps: u32) -> Sample {
    return Sample(sky_of(path), -1.0, vec3f(0.0), 0.0, vec3f(0.0), 1.0, 1.0, 0.0, f32(steps), 0u);
}

/// A ray that waits to be followed.
struct Onward {
    ray: Ray,
    /// The share of its light that comes to the eye.
    weight: vec3f,
    /// Reflections on the way, and surfaces of clear bodies that were passed or met from inside.
    bounces: vec2u,
    /// The material of the clear body that the ray is in, by number; -1 where it is in none.
    medium: f32,
    /// What is known of the way beside that.
    flags: u32,
    /// Where the random numbers of the way come from.
    pixel: vec2u,
    index: u32,
}

/// Follows ray number `index` of a pixel. `span` is the part of it that may hold the surface.
fn trace_ray(pixel: vec2u, index: u32, ray: Ray, span: vec3f) -> Sample {
    var first = Sample();
    var waiting: array<Onward, WAITING>;
    var count = 1u;
    waiting[0] = Onward(ray, vec3f(1.0), vec2u(0u), -1.0, 0u, pixel, index);
    var is_first = true;
    while (count > 0u) {
        count -= 1u;
        let path = waiting[count];
        var next = array<Onward, 2>();
        var known = vec3f(0.0, -1.0, FAR);
        if (is_first) {
            known = span;
        }
        let found = follow(pixel, index, path, known, is_first, &next);
        if (is_first) {
            first = found;
        } else {
            first.colour += clamped(path.weight * found.colour);
        }
        is_first = false;
        if (gives_up()) {
            break;
        }
        for (var k = 0u; k < 2u; k++) {
            if (max(max(next[k].weight.x, next[k].weight.y), next[k].weight.z) > 0.0 && count < WAITING) {
                waiting[count] = next[k];
                count += 1u;
            }
        }
    }
    return first;
}

/// Light as far as it may count.
fn clamped(light: vec3f) -> vec3f {
    return light * min(1.0, frame.clamp / max(max(max(light.x, light.y), light.z), 1e-30));
}

/// Follows one ray. Rays that go on from where it ends are left in `next`, those that weigh nothing do not.
fn follow(pixel: vec2u, index: u32, path: Onward, span: vec3f, is_first: bool, next: ptr<function, array<Onward, 2>>) -> Sample {
    let ray = path.ray;
    march_side = select(1.0, -1.0, path.medium >= 0.0);
    let reach = frame.threshold.y + frame.threshold.x * ray.travelled;
    var start = span.x;
    if (is_first) {
        start = max(max(enter(ray, frame.threshold.x, frame.threshold.y), frame.near), span.x);
    }
    let end = min(min(leave(ray, frame.threshold.x, reach), frame.far), span.z);
    if (!(start < end)) {
        return background(path, 0u);
    }
    let found = march(ray, start, end, span.y);
    counted[COUNT_MARCH] += found.steps + found.refined;
    if (!found.hit) {
        return background(path, found.steps);
    }
    var t = found.t;
    var residual = found.f;
    // where the footprint of the pixel meets the surface (Keinert 2014, 3.4, equations 2 and 3); a turn more finds what is left
    // there
    let turns = frame.placing + select(0u, 1u, wants_detail());
    for (var k = 0u; k < turns; k++) {
        residual = found.side * field(ray.origin + ray.direction * t);
        counted[COUNT_MARCH] += 1u;
        if (k < frame.placing) {
            let wanted = footprint(ray, t);
            t = max(t + clamp(residual - wanted, -2.0 * wanted, 2.0 * wanted), 0.0);
        }
    }
    let point = ray.origin + ray.direction * t;
    let pixel_here = pixel_width(ray, t);
    // what is seen faces the eye: on an edge the gradient may be that of the face behind it, and that of the one before it is
    // found a little nearer
    var normal = -ray.direction;
    for (var k = 0u; k < 2u; k++) {
        let before = normal;
        let uphill = gradient(point - ray.direction * (f32(k) * footprint(ray, t)), pixel_here) * found.side;
        let steepness = length(uphill);
        normal = select(-ray.direction, uphill / steepness, steepness > 0.0 && steepness < FAR);
        if (dot(normal, ray.direction) <= 0.0) {
            break;
        }
        if (k == 1u) {
            normal = normalize(before - ray.direction * dot(before, ray.direction));
        }
    }
    let at = Surface(point, normal, found.side, 2.0 * max(abs(found.f), footprint(ray, t)), ray.direction);
    // where a clear and an opaque body touch, the opaque one counts
    march_side = select(1.0, INSIDE_MARKS, path.medium >= 0.0);
    let marks = field_marks(point - normal * (MARKS_BEHIND * (frame.rounding.x * (t + ray.travelled) + frame.rounding.y)));
    // from here on only what is outside matters
    march_side = 1.0;
    counted[COUNT_MATERIAL] += 1u;
    let key = scramble(pixel, frame.seed ^ ((index + 1u) * HIT_SEEDS));
    let object = select(frame.objects, u32(max(marks.object, 0.0)), marks.object >= 0.0 && marks.object < f32(frame.objects));
    // inside a solid there is no sky: it is shown as if there were no solid
    var seen = AmbientVisibility(1.0, normal);
    if (found.side > 0.0) {
        seen = sky_visibility(at, load_occluder(frame.object_rows + object * OCCLUDER_ROWS), key);
    }
    let width = pixel_here / sqrt(f32(max(frame.samples, 1u)));
    let place = place_on(point, normal, ray.direction, width, marks.orbit);
    var what = local_material(marks.first, place);
    if (marks.share > 0.0) {
        what = blend(what, local_material(marks.second, place), marks.share);
    }
    let light = arriving(path, at, what);
    let followed = go_on(path, at, t, what, marks.first, next);
    var colour = colour_of(what, light, at, seen, followed);
    if (found.side > 0.0) {
        colour = hazed(ray, t, colour);
    } else if (path.medium >= 0.0 || what.finish.w > 0.0) {
        colour *= transmittance(body_of(path, marks.first).attenuation, t);
    }
    counted[COUNT_HITS] += select(0u, 1u, is_first);
    return Sample(
        colour,
        t,
        normal,
        abs(residual),
        what.albedo,
        seen.open,
        light.lit / max(light.share, 1e-20),
        marks.object + 1.0,
        f32(found.steps),
        0u,
    );
}
