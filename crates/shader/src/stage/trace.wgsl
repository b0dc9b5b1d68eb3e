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

/// Two materials mixed.
fn blend(a: LocalMaterial, b: LocalMaterial, share: f32) -> LocalMaterial {
    return LocalMaterial(
        mix(a.albedo, b.albedo, share),
        mix(a.emission, b.emission, share),
        mix(a.finish, b.finish, share),
        mix(a.shininess, b.shininess, share),
        mix(a.normal, b.normal, share),
    );
}

/// What a ray found that hit nothing.
fn background(path: Onward, steps: u32) -> Sample {
    return Sample(sky_of(path) + glow(path, FAR), -1.0, vec3f(0.0), 0.0, vec3f(0.0), 1.0, 1.0, 0.0, f32(steps), 0u);
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
    /// The part of the ray that may hold the surface, and the field's slope where that begins, as far as it is known.
    start: f32,
    slope: f32,
    end: f32,
    /// The density over directions with which the last surface chose the ray's, where lights are looked for from there too; else -1.
    density: f32,
}

/// The ray comes from the eye: it shows as much of its pixel as it weighs.
const FROM_EYE: u32 = 0x80000000u;

/// Follows ray number `index` of a pixel. `span` is the part of it that may hold the surface.
fn trace_ray(pixel: vec2u, index: u32, ray: Ray, span: vec3f) -> Sample {
    var seen = Sample();
    seen.depth = -1.0;
    var cover = 0.0;
    var waiting: array<Onward, WAITING>;
    let start = max(max(enter(ray, frame.threshold.x, frame.threshold.y), frame.near), span.x);
    let own = Onward(ray, vec3f(1.0), vec2u(0u), -1.0, FROM_EYE, pixel, index, start, span.y, span.z, -1.0);
    var count = parts_of_pixel(own, &waiting);
    while (count > 0u) {
        count -= 1u;
        let path = waiting[count];
        var next = array<Onward, 2>();
        let found = follow(path, &next);
        if ((path.flags & FROM_EYE) != 0u) {
            let share = path.weight.x;
            cover += select(0.0, share, found.depth >= 0.0);
            seen = with_part(seen, found, share);
        } else {
            seen.colour += clamped(path.weight * found.colour);
        }
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
    seen.place = bitcast<u32>(cover);
    return seen;
}

/// A pixel with what one more of its rays from the eye found, which shows this much of it.
fn with_part(pixel: Sample, found: Sample, share: f32) -> Sample {
    var seen = pixel;
    seen.colour += found.colour * share;
    seen.steps += found.steps;
    if (found.depth >= 0.0) {
        seen.normal += found.normal * share;
        seen.albedo += found.albedo * share;
        seen.open += found.open * share;
        seen.shadow += found.shadow * share;
        if (seen.depth < 0.0 || found.depth < seen.depth) {
            seen.depth = found.depth;
            seen.residual = found.residual;
            seen.object = found.object;
        }
    }
    return seen;
}

/// Light as far as it may count.
fn clamped(light: vec3f) -> vec3f {
    return light * min(1.0, frame.clamp / max(max(max(light.x, light.y), light.z), 1e-30));
}

/// Follows one ray. Rays that go on from where it ends are left in `next`, those that weigh nothing do not.
fn follow(path: Onward, next: ptr<function, array<Onward, 2>>) -> Sample {
    let ray = path.ray;
    march_side = select(1.0, -1.0, path.medium >= 0.0);
    let reach = frame.threshold.y + frame.threshold.x * ray.travelled;
    let end = min(min(leave(ray, frame.threshold.x, reach), frame.far), path.end);
    if (!(path.start < end)) {
        return background(path, 0u);
    }
    let found = march(ray, path.start, end, path.slope);
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
    let key = scramble(path.pixel, frame.seed ^ ((path.index + 1u) * HIT_SEEDS));
    let object = select(frame.objects, u32(max(marks.object, 0.0)), marks.object >= 0.0 && marks.object < f32(frame.objects));
    // inside a solid there is no sky: it is shown as if there were no solid
    var seen = AmbientVisibility(1.0, normal, vec3f(1.0));
    if (found.side > 0.0) {
        seen = sky_visibility(at, load_occluder(frame.object_rows + object * OCCLUDER_ROWS), key);
    }
    let width = pixel_here / sqrt(f32(max(frame.samples, 1u)));
    let place = place_on(point, normal, ray.direction, width, marks.orbit);
    // in a loop, so that textures are in one place only
    var what: LocalMaterial;
    for (var k = 0u; k < 2u; k++) {
        if (k == 1u && !(marks.share > 0.0)) {
            break;
        }
        let one = local_material(select(marks.second, marks.first, k == 0u), place, ray.direction);
        if (k == 0u) {
            what = one;
        } else {
            what = blend(what, one, marks.share);
            what.normal = normalize(what.normal);
        }
    }
    let followed = go_on(path, at, t, what, marks.first, next);
    let light = arriving(path, at, what, followed);
    var colour = colour_of(what, light, at, seen, followed) + surround(at, what, seen, followed);
    if (found.side > 0.0) {
        colour = hazed(ray, t, colour);
    } else if (path.medium >= 0.0 || what.finish.w > 0.0) {
        colour *= transmittance(body_of(path, marks.first).attenuation, t);
    }
    colour += glow(path, t);
    counted[COUNT_HITS] += select(0u, 1u, (path.flags & FROM_EYE) != 0u);
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
