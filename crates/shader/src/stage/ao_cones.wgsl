// Nine cones over the hemisphere. A cone is open as far as the field at its samples is as large as the cone is wide there, or
// as large as over a bare plane, which so is open in full: min_t f(x + w t) / (t min(tan, cos)). (Distance field ambient
// occlusion, as in Aaltonen 2018.)

/// Tangent of the half angle of a cone with a ninth of the hemisphere.
const CONE_TANGENT: f32 = 0.5153882;
/// Samples along a cone are closer to its tip by this from one to the next.
const CONE_RATIO: f32 = 0.45;
/// The cones are made around this direction and turned from it to the normal the shortest way. It is the opposite of no face
/// that anybody builds, and only there the shortest way is not known.
const CONE_AXIS: vec3f = vec3f(0.2696803, 0.8989344, 0.3451908);

/// Cosine between cone number `k` and the axis of all.
fn cone_cosine(k: u32) -> f32 {
    return select(select(5.0 / 18.0, 13.0 / 18.0, k < 4u), 1.0, k == 0u);
}

/// Cone number `k`, around the axis: the axis itself, a ring of three and a ring of five.
fn cone_direction(k: u32) -> vec3f {
    let turns = select((f32(k) + 0.25) / 5.0, f32(k) / 3.0, k < 4u);
    let angle = turns * 6.2831855;
    let c = cone_cosine(k);
    return basis(CONE_AXIS) * (sqrt(1.0 - c * c) * vec2f(cos(angle), sin(angle))) + CONE_AXIS * c;
}

/// `w`, turned with the rotation that takes the axis to `n` the shortest way.
fn turn_cone(n: vec3f, w: vec3f) -> vec3f {
    let v = cross(CONE_AXIS, n);
    let once = cross(v, w);
    return w + once + cross(v, once) / max(dot(CONE_AXIS, n) + 1.0, 1e-4);
}

fn ao_cones(at: Surface, how: Occluder) -> Openness {
    let origin = at.point + at.normal * at.offset;
    var open = 0.0;
    var total = 0.0;
    var bent = vec3f(0.0);
    for (var k = 0u; k < 9u; k++) {
        let cosine = cone_cosine(k);
        let to = turn_cone(at.normal, cone_direction(k));
        let narrow = min(CONE_TANGENT, cosine);
        var least = 1.0;
        var t = how.reach;
        for (var j = 0u; j < u32(how.count); j++) {
            least = min(least, max(around(at, origin + to * t) / (t * narrow), 0.0));
            t *= CONE_RATIO;
        }
        open += least * cosine;
        total += cosine;
        bent += to * (least * cosine);
    }
    return Openness(open / total, normalize(bent + at.normal * 1e-3));
}
