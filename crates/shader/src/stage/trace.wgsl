// One ray, from the camera to its colour.

fn local_material(number: f32, at: Place) -> LocalMaterial {
    let known = number >= 0.0 && number < f32(frame.materials);
    let which = select(frame.materials, u32(max(number, 0.0)), known);
    let m = load_material(frame.material_rows + which * MATERIAL_ROWS);
    return LocalMaterial(pattern_colour(m, at), m.emission, m.specular, m.metallic, m.roughness, m.shininess);
}

fn blend(a: LocalMaterial, b: LocalMaterial, share: f32) -> LocalMaterial {
    return LocalMaterial(
        mix(a.albedo, b.albedo, share),
        mix(a.emission, b.emission, share),
        mix(a.specular, b.specular, share),
        mix(a.metallic, b.metallic, share),
        mix(a.roughness, b.roughness, share),
        mix(a.shininess, b.shininess, share),
    );
}

/// What a ray found that hit nothing.
fn background(ray: Ray, steps: u32) -> Sample {
    let colour = sky_colour(frame.sky_horizon, frame.sky_top, frame.sky_bottom, ray.direction.y);
    return Sample(colour, -1.0, vec3f(0.0), 0.0, vec3f(0.0), 1.0, 1.0, 0.0, f32(steps), 0u);
}

/// Follows ray number `index` of a pixel. `span` is the part of it that may hold the surface.
fn trace_ray(pixel: vec2u, index: u32, ray: Ray, span: vec3f) -> Sample {
    let start = max(max(enter(ray, frame.threshold.x, frame.threshold.y), frame.near), span.x);
    let end = min(min(leave(ray, frame.threshold.x, frame.threshold.y), frame.far), span.z);
    if (!(start < end)) {
        return background(ray, 0u);
    }
    let found = march(ray, start, end, span.y);
    counted[COUNT_MARCH] += found.steps + found.refined;
    if (!found.hit) {
        return background(ray, found.steps);
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
    let marks = field_marks(point - normal * (MARKS_BEHIND * (frame.rounding.x * t + frame.rounding.y)));
    counted[COUNT_MATERIAL] += 1u;
    let key = scramble(pixel, frame.seed ^ ((index + 1u) * HIT_SEEDS));
    let object = select(frame.objects, u32(max(marks.object, 0.0)), marks.object >= 0.0 && marks.object < f32(frame.objects));
    // inside a solid there is no sky: it is shown as if there were no solid
    var seen = AmbientVisibility(1.0, normal);
    if (found.side > 0.0) {
        seen = occlusion(at, load_occluder(frame.object_rows + object * OCCLUDER_ROWS), key);
    }
    let width = pixel_here / sqrt(f32(max(frame.samples, 1u)));
    let place = place_on(point, normal, ray.direction, width, marks.orbit);
    var what = local_material(marks.first, place);
    if (marks.share > 0.0) {
        what = blend(what, local_material(marks.second, place), marks.share);
    }
    let light = arriving(at, what.shininess);
    let colour = colour_of(what, light, at, seen);
    counted[COUNT_HITS] += 1u;
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
