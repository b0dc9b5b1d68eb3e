// A picture without buffers: every pixel is the mean of its rays.

/// Fits the frame to a picture of this size.
fn fit(size: vec2f) {
    let ratio = f32(frame.size.y) / size.y;
    frame.scale *= ratio;
    frame.pixel *= ratio;
    frame.threshold *= ratio;
    frame.half = 0.5 * size;
    frame.size = vec2u(size);
}

/// Turns the camera around the middle of what it sees: by `angles.x` around the vertical, by `angles.y` upwards.
fn orbit(angles: vec2f) {
    let forwards = -frame.back;
    let pivot = frame.eye + forwards * PIVOT;
    let height = asin(clamp(frame.back.y, -1.0, 1.0));
    let lift = clamp(height + angles.y, -1.5, 1.5) - height;
    let level = normalize(vec3f(frame.right.x, 0.0, frame.right.z) + vec3f(1e-20, 0.0, 0.0));
    let about = vec2f(cos(lift), sin(lift));
    // first upwards around the level axis, then around the vertical
    let back = turned(frame.back, level, about);
    let up = turned(frame.up, level, about);
    let spin = vec2f(cos(angles.x), sin(angles.x));
    let axis = vec3f(0.0, 1.0, 0.0);
    frame.back = turned(back, axis, spin);
    frame.up = turned(up, axis, spin);
    frame.right = turned(frame.right, axis, spin);
    frame.eye = pivot + frame.back * PIVOT;
}

/// A vector turned around an axis by the angle with this cosine and sine.
fn turned(v: vec3f, axis: vec3f, angle: vec2f) -> vec3f {
    return v * angle.x + cross(axis, v) * angle.y + axis * (dot(axis, v) * (1.0 - angle.x));
}

/// The colour of the pixel whose top left corner is `corner`, in pixels from the top left of a picture of this size.
fn picture(corner: vec2f, size: vec2f, angles: vec2f) -> vec4f {
    fit(size);
    if (any(angles != vec2f(0.0))) {
        orbit(angles);
    }
    let pixel = vec2u(corner);
    var sum = vec3f(0.0);
    let rays = max(frame.samples, 1u);
    for (var k = 0u; k < rays; k++) {
        let ray = pixel_ray(corner + jitter(pixel, k), pixel, k);
        sum += trace_ray(pixel, k, ray, vec3f(0.0, -1.0, FAR)).colour;
    }
    return vec4f(srgb(sum / f32(rays) * EXPOSURE), 1.0);
}
