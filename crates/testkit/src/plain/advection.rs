//! Light that flows through a volume (Evans 2006, 9.9), written anew but for where the volume lies: in double precision, node after node.

use super::light::Surface;
use super::skylight::Mip;
use super::{Plain, Probe, Quality};
use glam::{DVec3, Vec3};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Shadow;
use zeroset_shade::advection::wanted;
use zeroset_shade::lamp::Lamp;
use zeroset_shade::skylight::Extent;
use zeroset_shade::view::on_disc;

/// What is left of the lights of a scene at the nodes of a volume, for those that ask for it.
pub(super) struct Volume {
    extent: Extent,
    left: Vec<Option<Mip>>,
}

impl Volume {
    pub(super) fn of(scene: &Scene, quality: &Quality, probe: &mut impl Probe) -> Option<Volume> {
        let extent = Extent::of(scene, wanted(scene)?);
        let nodes = extent.nodes(0).map(|n| n as usize);
        let all: Vec<DVec3> = (0..nodes.iter().product::<usize>())
            .map(|n| {
                let node = [
                    n % nodes[0],
                    n / nodes[0] % nodes[1],
                    n / nodes[0] / nodes[1],
                ];
                DVec3::from(node.map(|c| c as f64))
            })
            .collect();
        let voxel = f64::from(extent.voxel);
        let world = |node: DVec3| Vec3::from(extent.origin).as_dvec3() + node * voxel;
        let open: Vec<f64> = (all.iter())
            .map(|node| {
                let p = world(*node).as_vec3();
                let f = match quality.close {
                    true => probe.value(p),
                    false => probe.value(p) / probe.gradient(p).length().max(1e-12),
                };
                (f64::from(f) / voxel + 0.5).clamp(0.0, 1.0)
            })
            .collect();
        let mut left = Vec::new();
        for light in scene.lights() {
            let Shadow::Advected { spread, .. } = light.shadow else {
                left.push(None);
                continue;
            };
            let from: Vec<Option<DVec3>> = (all.iter())
                .map(|node| Some(*node - way(light, world(*node), voxel)?))
                .map(|from| from.filter(|p| inside(*p, nodes)))
                .collect();
            let flowing = Flowing {
                nodes,
                open: &open,
                from: &from,
                spread: f64::from(spread),
            };
            let values = flowing.left().iter().map(|x| *x as f32).collect();
            left.push(Some(Mip { nodes, values }));
        }
        Some(Volume { extent, left })
    }
}

fn inside(p: DVec3, nodes: [usize; 3]) -> bool {
    let last = DVec3::from(nodes.map(|n| (n - 1) as f64));
    p.cmpge(DVec3::ZERO).all() && p.cmple(last).all()
}

/// The way of light at a place, in voxels; none where it comes from there.
fn way(light: &Light, p: DVec3, voxel: f64) -> Option<DVec3> {
    // from these places, each as much as the second number says at a distance of 1, and by the cosine of a normal
    let (middle, places) = match light.source {
        Source::Directional { direction } => return Some(direction.as_dvec3()),
        Source::Point { position } => (position, vec![position.as_dvec3()]),
        Source::Sphere {
            position, radius, ..
        } => {
            let to = p - position.as_dvec3();
            let sine = f64::from(radius) / to.length();
            if to.length() < voxel || sine >= 1.0 {
                return None;
            }
            // the mean of the directions of a cap
            let cosine = (1.0 - sine * sine).sqrt();
            let solid = 2.0 * std::f64::consts::PI * (1.0 - cosine);
            return Some(to.normalize() * (std::f64::consts::PI * sine * sine / solid));
        }
        Source::Rectangle { position, .. } | Source::Disc { position, .. } => {
            let lamp = Lamp::of(light)?;
            let [x, y] = [lamp.right, lamp.up].map(|v| Vec3::from(v.array()).as_dvec3());
            let mut all = Vec::new();
            for k in 0..16 {
                let u = [k % 4, k / 4].map(|n| 0.125 + 0.25 * n as f32);
                let [a, b] = match light.source {
                    Source::Disc { .. } => on_disc(u),
                    _ => u.map(|u| 2.0 * u - 1.0),
                };
                all.push(position.as_dvec3() + x * f64::from(a) + y * f64::from(b));
            }
            (position, all)
        }
    };
    if (p - middle.as_dvec3()).length() < voxel {
        return None;
    }
    let front = Lamp::of(light).map(|lamp| {
        let [x, y] = [lamp.right, lamp.up].map(|v| Vec3::from(v.array()).as_dvec3());
        x.cross(y).normalize()
    });
    let (mut all, mut sum) = (0.0, DVec3::ZERO);
    for place in places {
        let to = (p - place).normalize();
        let much = front.map_or(1.0, |n| n.dot(to).max(0.0)) / (p - place).length_squared();
        all += much;
        sum += to * much;
    }
    (all > 0.0 && sum.length() > 0.0).then(|| sum / all)
}

struct Flowing<'a> {
    nodes: [usize; 3],
    open: &'a [f64],
    from: &'a [Option<DVec3>],
    spread: f64,
}

impl Flowing<'_> {
    /// What is left of a light when nothing changes any more.
    fn left(&self) -> Vec<f64> {
        let around = self.blurred(self.open.to_vec());
        let mut light = vec![1.0; self.open.len()];
        for _ in 0..4 * self.nodes.iter().sum::<usize>() {
            let through = light.iter().zip(self.open).map(|(l, o)| l * o).collect();
            let mut sent = self.blurred(through);
            for (n, sent) in sent.iter_mut().enumerate() {
                *sent = match around[n] > 1e-6 {
                    true => (*sent / around[n]).min(1.0) * self.open[n],
                    false => 0.0,
                };
            }
            let next: Vec<f64> = (self.from.iter())
                .map(|from| from.map_or(1.0, |p| self.read(&sent, p)))
                .collect();
            let changes = next.iter().zip(&light).map(|(a, b)| (a - b).abs());
            let most = changes.fold(0.0, f64::max);
            light = next;
            if most <= 1.0 / 4096.0 {
                break;
            }
        }
        light
    }

    /// Along one axis after the other: of each node a part of a half is shared among the two beside it.
    fn blurred(&self, mut values: Vec<f64>) -> Vec<f64> {
        let [nx, ny, nz] = self.nodes;
        for (axis, count, step) in [(0, nx, 1), (1, ny, nx), (2, nz, nx * ny)] {
            let old = values.clone();
            for (n, value) in values.iter_mut().enumerate() {
                let at = [n % nx, n / nx % ny, n / nx / ny][axis];
                if at > 0 && at + 1 < count {
                    let beside = 0.5 * (old[n - step] + old[n + step]);
                    *value += 0.5 * self.spread * (beside - old[n]);
                }
            }
        }
        values
    }

    fn read(&self, values: &[f64], p: DVec3) -> f64 {
        let [nx, ny, nz] = self.nodes;
        let low = [0, 1, 2].map(|k| (p[k] as usize).min([nx, ny, nz][k] - 2));
        let t = p - DVec3::from(low.map(|n| n as f64));
        (0..8)
            .map(|corner| {
                let step = [corner & 1, corner >> 1 & 1, corner >> 2];
                let share = |k: usize| match step[k] {
                    1 => t[k],
                    _ => 1.0 - t[k],
                };
                let [i, j, k] = [0, 1, 2].map(|k| low[k] + step[k]);
                share(0) * share(1) * share(2) * values[i + nx * (j + ny * k)]
            })
            .sum()
    }
}

impl Plain<'_> {
    /// How much of a light reaches a surface that sees it along `to`, so far away, by its volume; none where it has none.
    pub(super) fn advected(
        &self,
        number: usize,
        at: &Surface,
        to: Vec3,
        distance: f32,
    ) -> Option<f32> {
        let volume = self.lit.as_ref()?;
        let left = volume.left.get(number)?.as_ref()?;
        let Shadow::Advected { bias, .. } = self.scene.lights().get(number)?.shadow else {
            return None;
        };
        let Extent {
            origin,
            voxel,
            cells,
        } = volume.extent;
        let cells = Vec3::from(cells.map(|n| n as f32));
        let place = (at.p + at.normal * (bias * voxel) - Vec3::from(origin)) / voxel;
        let (mut enters, mut leaves) = (0.0f32, f32::INFINITY);
        for axis in 0..3 {
            let ends = [-place[axis], cells[axis] - place[axis]].map(|x| x / to[axis]);
            if to[axis] == 0.0 {
                if place[axis] < 0.0 || place[axis] > cells[axis] {
                    return Some(1.0);
                }
                continue;
            }
            enters = enters.max(ends[0].min(ends[1]));
            leaves = leaves.min(ends[0].max(ends[1]));
        }
        Some(match enters <= leaves && enters * voxel <= distance {
            true => left.read(place + to * enters),
            false => 1.0,
        })
    }
}
