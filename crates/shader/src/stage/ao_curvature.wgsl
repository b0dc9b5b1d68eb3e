// How a surface bends, from what a mip of a volume of distances is off there (Evans 2006, 9.5 and figure 5).

fn ao_curvature(at: Surface, how: Occluder) -> f32 {
    let volume = load_skyvolume(frame.sky_rows);
    // exact, as a power need not be
    let finer = vec4f(1.0, 0.5, 0.25, 0.125)[u32(how.count)];
    let place = (at.point - volume.origin) / volume.voxel;
    let off = volume_sample(volume.grid + how.count, volume.cells * finer + 1.0, place * finer);
    return skylight_curved(off * skylight_share(place, volume.cells), how.scale);
}
