// Fog, and the sun before the sky.

/// A colour behind the way `t` through the air along a ray.
fn hazed(ray: Ray, t: f32, colour: vec3f) -> vec3f {
    if (frame.density == 0.0) {
        return colour;
    }
    let fog = fog_light(frame.fog, frame.sun, frame.sun_radiance, frame.glow, ray.direction);
    return mix(colour, fog, haze(ray, t));
}

/// The share of light that fog takes on the way `t` along a ray.
fn haze(ray: Ray, t: f32) -> f32 {
    if (frame.density == 0.0) {
        return 0.0;
    }
    return fog_share(frame.density, frame.falloff, ray.origin.y, ray.direction.y, t);
}

/// The sky along a ray, with the disc of the sun where it is looked at.
fn sky_along(ray: Ray, looks: bool) -> vec3f {
    var seen = sky_seen(ray.direction);
    if (looks && frame.sun_cosine <= 1.0) {
        seen += sun_disc(frame.sun, frame.sun_radiance, frame.sun_cosine, ray.direction);
    }
    return hazed(ray, ENDLESS, seen);
}
