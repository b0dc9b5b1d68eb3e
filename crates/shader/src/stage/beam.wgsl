// How much of something far reaches a surface: shadows, and the rays of occlusion that is sampled.
//
// A ray needs samples only where they can darken it. Between two samples z apart with the radii r and f the field is nowhere
// below (r + f - z) / 2; where even that is no penumbra, the step was free to be longer than r. The step that just meets
// this, for a field that goes on with the slope m, is 2 (r - w t) / (1 - m + 2 w), with w the width of the penumbra that
// still matters. For hard shadows w is 0.

/// A ray's first sample is this many offsets from its origin.
const BEAM_FIRST: f32 = 2.0;
/// A value of an estimate below this many offsets stops a ray that has no penumbra; any other field must change its sign.
const BEAM_STOP: f32 = 0.125;
/// Steps are at least this many offsets long; where there are skins, no longer than what touches one.
const BEAM_LEAST: f32 = 0.03125;
/// Less light than this counts as dark.
const BEAM_DARK: f32 = 1.0 / 256.0;
/// Smoothing of the slope along a ray.
const BEAM_SMOOTHING: f32 = 0.3;
/// Share of the step that would just do.
const BEAM_SHARE: f32 = 0.95;
/// Steeper slopes count as this.
const BEAM_STEEPEST: f32 = 0.98;

/// What a beam found.
struct Beam {
    /// What is left of the light: 0 or 1 for a hard one.
    light: f32,
    /// How far it came.
    t: f32,
    samples: u32,
}

/// Looks from a surface along `to`, at most as far as `distance`. `kind` is that of a shadow, one of `SHADOW_...`, which has a penumbra
/// unless it is hard.
fn look(at: Surface, to: vec3f, distance: f32, kind: u32, sharpness: f32) -> Beam {
    let origin = at.point + at.normal * at.offset;
    let hard = kind == SHADOW_HARD;
    let width = select(1.0 / max(sharpness, 1e-20), 0.0, hard);
    // beside a loose bound penumbrae are seen where samples happen to be
    let close = is_close();
    let careful = select(0.0, width, close);
    let skins = has_skins() && !hard;
    let touch = skin_touch(at);
    let least = select(at.offset * BEAM_LEAST, touch, skins);
    // whether the ray has touched something: from there on only what it hits is dark
    var touched = false;
    let stop = select(2.0 * behind_surface(at.point), at.offset * BEAM_STOP, is_fractal());
    let end = min(min(leave(Ray(origin, to), width, at.offset), distance), frame.far);
    var t = min(at.offset * BEAM_FIRST, end);
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
                m = mix(m, clamp((f - r) / max(z, 1e-20), -1.0, 1.0), BEAM_SMOOTHING);
            }
            m = min(m, BEAM_STEEPEST);
            if (hard) {
                if (f < stop) {
                    return Beam(0.0, there, steps);
                }
            } else {
                light = min(light, penumbra(found.y, select(0.0, z, close), r, there, kind) * sharpness);
                if (light < BEAM_DARK) {
                    // it may have come to a skin: it goes on until it touches something or moves away, and where it touched,
                    // until it is behind a surface
                    let touches = f < touch;
                    let leaves = !touched && !touches && z > 0.0 && f > r;
                    if (!skins || f < touch * SKIN_BEHIND || leaves) {
                        return Beam(0.0, there, steps);
                    }
                    touched = touched || touches;
                }
            }
            t = there;
            r = f;
            let narrow = select(light, 0.0, touched) * careful;
            // where a skin may be touched, no step leads past it
            let reach = (r - narrow * t) * 2.0 * BEAM_SHARE / (1.0 - m + 2.0 * narrow);
            z = max(max(r, least), select(reach, 0.0, light < BEAM_DARK && !touched));
        }
        if (!(t + max(r, 0.0) < end)) {
            break;
        }
        z = min(z, end - t);
    }
    return Beam(select(light, 1.0, touched), t, steps);
}

/// How wide the way of a ray is for its length, at a sample `f` at `t` (Tomczak 2012, algorithm 3.3).
fn penumbra_soft(f: f32, t: f32) -> f32 {
    return f / max(t, 1e-20);
}

/// The same, at the closest place between this sample and one of radius `r` that is `z` before it (Aaltonen 2018).
fn penumbra_closest(f: f32, z: f32, r: f32, t: f32) -> f32 {
    if (z > 0.0 && z <= r * 1.000001 && f < r && f >= 0.0) {
        let before = max((z * z + f * f - r * r) / max(2.0 * z, 1e-20), 0.0);
        return sqrt(max(f * f - before * before, 0.0)) / max(t - before, 1e-20);
    }
    return penumbra_soft(f, t);
}
