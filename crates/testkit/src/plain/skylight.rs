//! Skylight from a volume (Evans 2006, 9.6 and 9.9), written anew but for where the volume lies.

use super::light::Surface;
use super::{Plain, Probe, Quality};
use glam::Vec3;
use zeroset_scene::material::Material;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Occlusion;
use zeroset_shade::skylight::{Extent, average, wanted};

/// Samples of one mip.
pub(super) struct Mip {
    pub(super) nodes: [usize; 3],
    pub(super) values: Vec<f32>,
}

impl Mip {
    fn at(&self, [i, j, k]: [usize; 3]) -> f32 {
        self.values[i + self.nodes[0] * (j + self.nodes[1] * k)]
    }

    /// Interpolated at a place in its voxels.
    pub(super) fn read(&self, place: Vec3) -> f32 {
        let (mut low, mut t) = ([0; 3], [0.0; 3]);
        for axis in 0..3 {
            let c = place[axis].clamp(0.0, (self.nodes[axis] - 1) as f32);
            low[axis] = (c.floor() as usize).min(self.nodes[axis] - 2);
            t[axis] = c - low[axis] as f32;
        }
        let mut sum = 0.0;
        for corner in 0..8 {
            let step = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight: f32 = (0..3)
                .map(|axis| {
                    if step[axis] == 1 {
                        t[axis]
                    } else {
                        1.0 - t[axis]
                    }
                })
                .product();
            sum += weight * self.at([0, 1, 2].map(|axis| low[axis] + step[axis]));
        }
        sum
    }

    /// Each node mixed with those beside it, of which a half stays: along each axis with a quarter of either. `every`: of two nodes one, or all.
    fn mixed(&self, every: usize) -> Mip {
        let nodes = self.nodes.map(|n| (n - 1) / every + 1);
        let mut values = Vec::new();
        for k in 0..nodes[2] {
            for j in 0..nodes[1] {
                for i in 0..nodes[0] {
                    let (mut sum, middle) = (0.0, [i, j, k].map(|n| n * every));
                    for beside in 0..27 {
                        let step = [beside % 3, beside / 3 % 3, beside / 9];
                        let (mut weight, mut node) = (1.0, middle);
                        for axis in 0..3 {
                            let ends = middle[axis] == 0 || middle[axis] == self.nodes[axis] - 1;
                            weight *= match (ends, step[axis]) {
                                (false, 1) => 0.5,
                                (false, _) => 0.25,
                                (true, 1) => 1.0,
                                (true, _) => 0.0,
                            };
                            if !ends {
                                node[axis] = middle[axis] + step[axis] - 1;
                            }
                        }
                        sum += weight * self.at(node);
                    }
                    values.push(sum);
                }
            }
        }
        Mip { nodes, values }
    }
}

/// The volume of a scene.
pub(super) struct Volume {
    extent: Extent,
    distances: Vec<Mip>,
    /// From the second on: red, green and blue.
    colours: Vec<[Mip; 3]>,
}

impl Volume {
    pub(super) fn of(scene: &Scene, quality: &Quality, probe: &mut impl Probe) -> Option<Volume> {
        let (resolution, is_coloured) = wanted(scene)?;
        let extent = Extent::of(scene, resolution);
        let places = |level: usize| {
            let nodes = extent.nodes(level).map(|n| n as usize);
            let step = extent.voxel * (1 << level) as f32;
            let all = (0..nodes.iter().product::<usize>()).map(move |n| {
                let node = [
                    n % nodes[0],
                    n / nodes[0] % nodes[1],
                    n / nodes[0] / nodes[1],
                ];
                Vec3::from(extent.origin) + Vec3::from(node.map(|c| c as f32)) * step
            });
            (nodes, all)
        };
        let (nodes, all) = places(0);
        let values = all.map(|p| {
            let f = probe.value(p);
            let f = match quality.close {
                true => f,
                false => f / probe.gradient(p).length().max(1e-12),
            };
            f.clamp(-2048.0 * extent.voxel, 2048.0 * extent.voxel)
        });
        let values = values.collect();
        let mut distances = vec![Mip { nodes, values }];
        for level in 0..3 {
            distances.push(distances[level].mixed(2));
        }
        let mut colours = Vec::new();
        if is_coloured {
            let matte = |m: &Material| average(&m.pattern) * (1.0 - m.transmission);
            let (nodes, all) = places(1);
            let seen: Vec<Vec3> = all
                .map(|p| {
                    let mark = probe.marks(p);
                    let mut colour = |mark: f32| {
                        let count = scene.materials().len();
                        let number = match probe.placed(mark, count, p) {
                            Some((number, ..)) => number,
                            None => mark.max(-1.0) as isize as usize,
                        };
                        let known = scene.materials().get(number);
                        known.map_or_else(|| matte(&Material::default()), matte)
                    };
                    let first = colour(mark.first);
                    match mark.share > 0.0 {
                        true => first.lerp(colour(mark.second), mark.share),
                        false => first,
                    }
                })
                .collect();
            let channel = |axis: usize| {
                let values = seen.iter().map(|c| c[axis]).collect();
                Mip { nodes, values }.mixed(1)
            };
            colours.push([0, 1, 2].map(channel));
            for level in 0..2 {
                let next = colours[level].each_ref().map(|mip| mip.mixed(2));
                colours.push(next);
            }
        }
        Some(Volume {
            extent,
            distances,
            colours,
        })
    }
}

impl Plain<'_> {
    /// How a surface bends: what a mip is off there, in its voxels.
    pub(super) fn curvature(&self, at: &Surface, blur: u32, strength: f32) -> f32 {
        let Some(volume) = &self.sky else {
            return 1.0;
        };
        let place = (at.p - Vec3::from(volume.extent.origin)) / volume.extent.voxel;
        let cells = Vec3::from(volume.extent.cells.map(|n| n as f32));
        let inner = (place.min(cells - place).min_element() / 8.0).clamp(0.0, 1.0);
        let share = inner * inner * (3.0 - 2.0 * inner);
        let wide = (1 << blur) as f32;
        let off = share * volume.distances[blur as usize].read(place / wide);
        let shade = 0.5 + (strength * off / (wide * volume.extent.voxel)).exp();
        (shade / 2.5).min(1.0)
    }

    /// How open a place is, where the sky is seen, and what colours its light has.
    pub(super) fn skylight(
        &self,
        f: &mut impl FnMut(Vec3) -> f32,
        at: &Surface,
        method: Occlusion,
    ) -> (f32, Vec3, Vec3) {
        let Occlusion::Skylight {
            step,
            strength,
            bend,
            bleed,
            ..
        } = method
        else {
            return (1.0, at.normal, Vec3::ONE);
        };
        let Some(volume) = &self.sky else {
            return (1.0, at.normal, Vec3::ONE);
        };
        let first = step * volume.extent.voxel;
        let samples = [(1.0, 1.0), (1.2, 2.0), (1.4, 4.0), (1.8, 8.0)];
        let all: f32 = samples.iter().map(|(w, d)| w * d * first).sum();
        let way = at.normal + Vec3::Y * bend;
        let cells = Vec3::from(volume.extent.cells.map(|n| n as f32));
        let mut sums = Vec3::ZERO;
        for (level, (weight, far)) in samples.into_iter().enumerate() {
            let p = at.p + way * (far * first);
            let place = (p - Vec3::from(volume.extent.origin)) / volume.extent.voxel;
            let depth = place.min(cells - place).min_element();
            let inner = (depth / 8.0).clamp(0.0, 1.0);
            let share = inner * inner * (3.0 - 2.0 * inner);
            let mut distance = 0.0;
            if share > 0.0 {
                distance += share * volume.distances[level].read(place / far);
                if bleed > 0.0 {
                    let coarser = level.max(1);
                    let colours = &volume.colours[coarser - 1];
                    let near = colours
                        .each_ref()
                        .map(|c| c.read(place / (1 << coarser) as f32));
                    // a white thing is as much farther away as the samples are on average
                    sums += Vec3::from(near) * (weight * share * bleed * all / 5.4);
                }
            }
            if share < 1.0 {
                distance += (1.0 - share) * f(p);
            }
            sums += Vec3::splat(weight * (distance - far * first));
        }
        let light = Vec3::from(
            (sums * (strength / all))
                .min(Vec3::ZERO)
                .to_array()
                .map(f32::exp),
        );
        let open = light.element_sum() / 3.0;
        let bent = match way.length() < 1e-3 {
            true => at.normal,
            false => way.normalize(),
        };
        (open, bent, light / open.max(1e-20))
    }
}
