// How much of something far reaches a surface: shadows, and the rays of occlusion that is sampled.
// See `zeroset_shade::secondary` for the steps.

/// What a secondary ray found.
struct SecondaryRay {
    /// What is left of the light: 0 or 1 for a hard one.
    light: f32,
    /// How far it came.
    t: f32,
    samples: u32,
}

/// Looks from a surface along `to`, at most as far as `distance`. `kind` is that of a shadow, one of `SHADOW_...`, which has a penumbra
/// unless it is hard.
fn secondary_ray(at: Surface, to: vec3f, distance: f32, kind: u32, sharpness: f32) -> SecondaryRay {
    let origin = at.point + at.normal * at.offset;
    let hard = kind == SHADOW_HARD;
    let width = select(1.0 / max(sharpness, 1e-20), 0.0, hard);
    // beside a loose bound penumbrae are seen where samples happen to be
    let close = is_close();
    let careful = select(0.0, width, close);
    let skins = has_skins() && !hard;
    let touch = skin_touch(at.point, at.offset);
    let least = select(at.offset * SECONDARY_LEAST, touch, skins);
    // whether the ray has touched something: from there on only what it hits is dark
    var touched = false;
    let stop = select(2.0 * behind_surface(at.point), at.offset * SECONDARY_STOP, is_fractal());
    let end = min(min(leave(ray_from(origin, to), width, at.offset), distance), frame.far);
    var t = min(at.offset * SECONDARY_FIRST, end);
    var z = 0.0;
    var r = 0.0;
    var m = dot(at.normal, to);
    var light = 1.0;
    var steps = 0u;
    while (steps < frame.max_steps) {
        let there = t + z;
        let found = sensed(origin + to * there);
        let f = found.x;
        steps += 1u;
        let wide = select(light, 0.0, touched) * careful;
        if (z > r && z > least && 0.5 * (r + f - z) < wide * there) {
            // something between the samples can matter: back to the radius itself, which is sure to be kept
            m = -1.0;
            z = max(r, least);
        } else {
            if (z > 0.0) {
                m = mix(m, slope_between(r, f, z), SECONDARY_SMOOTHING);
            }
            m = min(m, SECONDARY_STEEPEST);
            if (hard) {
                if (f < stop) {
                    return SecondaryRay(0.0, there, steps);
                }
            } else {
                light = min(light, penumbra(found.y, select(0.0, z, close), r, there, kind, sharpness));
                if (light < DARK) {
                    // it may have come to a skin: it goes on until it touches something or moves away, and where it touched,
                    // until it is behind a surface
                    let touches = f < touch;
                    let leaves = !touched && !touches && z > 0.0 && f > r;
                    if (!skins || f < touch * SKIN_BEHIND || leaves) {
                        return SecondaryRay(0.0, there, steps);
                    }
                    touched = touched || touches;
                }
            }
            t = there;
            r = f;
            let narrow = select(light, 0.0, touched) * careful;
            // where a skin may be touched, no step leads past it
            let reach = secondary_step(r, t, m, narrow);
            z = max(max(r, least), select(reach, 0.0, light < DARK && !touched));
        }
        if (!(t + max(r, 0.0) < end)) {
            break;
        }
        z = min(z, end - t);
    }
    return SecondaryRay(select(light, 1.0, touched), t, steps);
}
