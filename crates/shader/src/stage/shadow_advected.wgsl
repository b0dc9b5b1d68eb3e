// Shadows of light that flowed through a volume (Evans 2006, 9.9 and figure 12). The twin of `advected` of the CPU renderer's `shadow.rs`.

/// How much of a light reaches a surface that sees it along `to`, so far away.
fn advected(at: Surface, light: Light, to: vec3f, distance: f32) -> f32 {
    let volume = load_skyvolume(frame.advected_rows);
    let p = at.point + at.normal * light.sharpness;
    let place = (p - volume.origin) / volume.voxel;
    let t = advected_entry(place, to, volume.cells);
    if (t < 0.0 || t * volume.voxel > distance) {
        return 1.0;
    }
    return volume_sample(light.grid, volume.cells + 1.0, place + to * t);
}
