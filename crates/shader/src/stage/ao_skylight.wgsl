// Distances of a volume with mips along a way that bends towards the sky, and the colours of what is near (Evans 2006, 9.6, 9.9 and
// listing 1). The twin of `ao/skylight.rs` of the CPU renderer.

fn ao_skylight(at: Surface, how: Occluder) -> AmbientVisibility {
    let volume = load_skyvolume(frame.sky_rows);
    let weights = EVANS;
    // exact, as a power need not be
    let finer_by = vec4f(1.0, 0.5, 0.25, 0.125);
    let way = skylight_way(at.normal, how.bend);
    var sums = vec3f(0.0);
    var far = how.reach;
    for (var level = 0u; level < SKYLIGHT_LEVELS; level++) {
        let p = at.point + way * far;
        let place = (p - volume.origin) / volume.voxel;
        let share = skylight_share(place, volume.cells);
        var f = 0.0;
        if (share > 0.0) {
            let finer = finer_by[level];
            f = volume_sample(volume.grid + f32(level), volume.cells * finer + 1.0, place * finer);
            if (how.bleed > 0.0) {
                let coloured = max(level, SKYLIGHT_COLOURED);
                let coarser = finer_by[coloured];
                let first = volume.grid + f32(SKYLIGHT_LEVELS + 3u * (coloured - SKYLIGHT_COLOURED));
                for (var k = 0u; k < 3u; k++) {
                    let near = volume_sample(first + f32(k), volume.cells * coarser + 1.0, place * coarser);
                    sums[k] += weights[level] * how.bleed * share * near;
                }
            }
        }
        if (share < 1.0) {
            f = mix(around(at, p), f, share);
        }
        sums += vec3f(weights[level] * (f - far));
        far *= 2.0;
    }
    let seen = skylight_split(skylight_light(sums, how.scale));
    return AmbientVisibility(seen.w, skylight_bent(at.normal, way), seen.xyz);
}
