//! Writes a grid of OpenVDB: the tree of 32, 16 and 8 slots a side that every program knows. Nodes without a sample of the narrow
//! band are left out; what is inside of them is told by the sign of their tiles.

use super::{mask, vdb};
use crate::volume::Volume;

pub(super) fn write(volume: &Volume) -> Vec<u8> {
    let mut out = Out(Vec::new());
    out.bytes(&vdb::MAGIC);
    out.u32(vdb::VERSION);
    // the library's version that programs show
    out.u32(10);
    out.u32(0);
    // where grids are is told
    out.bytes(&[1]);
    out.bytes(uuid(volume).as_bytes());
    out.u32(1);
    out.metadata("creator", "string", b"Zeroset");
    out.u32(1);
    out.text(volume.name());
    out.text("Tree_float_5_4_3");
    out.text("");
    let places = out.0.len();
    out.bytes(&[0; 24]);
    let grid = out.0.len();
    out.u32(vdb::ACTIVE_MASK);
    out.u32(3);
    out.metadata("class", "string", b"level set");
    out.metadata("is_saved_as_half_float", "bool", &[0]);
    out.metadata("name", "string", volume.name().as_bytes());
    transform(volume, &mut out);
    let tree = Tree::new(volume);
    out.u32(1);
    tree.topology(&mut out);
    let blocks = out.0.len();
    tree.buffers(&mut out);
    let end = out.0.len();
    for (i, place) in [grid, blocks, end].into_iter().enumerate() {
        out.0[places + 8 * i..][..8].copy_from_slice(&(place as u64).to_le_bytes());
    }
    out.0
}

struct Out(Vec<u8>);

impl Out {
    fn bytes(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }
    fn u32(&mut self, x: u32) {
        self.bytes(&x.to_le_bytes());
    }
    fn f32(&mut self, x: f32) {
        self.bytes(&x.to_le_bytes());
    }
    fn text(&mut self, text: &str) {
        self.u32(text.len() as u32);
        self.bytes(text.as_bytes());
    }
    fn metadata(&mut self, name: &str, kind: &str, value: &[u8]) {
        self.text(name);
        self.text(kind);
        self.u32(value.len() as u32);
        self.bytes(value);
    }
}

/// 36 characters that differ between contents and do not from run to run.
fn uuid(volume: &Volume) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut hashes = [0; 2];
    for part in &mut hashes {
        for bits in volume.values().iter().map(|x| x.to_bits()) {
            hash = (hash ^ u64::from(bits)).wrapping_mul(0x0100_0000_01b3);
        }
        *part = hash;
    }
    let hex = format!("{:016x}{:016x}", hashes[0], hashes[1]);
    let (a, b, c, d, e) = (
        &hex[..8],
        &hex[8..12],
        &hex[12..16],
        &hex[16..20],
        &hex[20..],
    );
    format!("{a}-{b}-{c}-{d}-{e}")
}

fn transform(volume: &Volume, out: &mut Out) {
    let (origin, step) = (volume.origin(), volume.step());
    let uniform = step[0] == step[1] && step[1] == step[2];
    out.text(if uniform {
        "UniformScaleTranslateMap"
    } else {
        "ScaleTranslateMap"
    });
    // what the library keeps beside the scale: voxel, inverse, inverse square, inverse of twice
    for numbers in [
        origin,
        step,
        step,
        step.map(|s| 1.0 / s),
        step.map(|s| 1.0 / (s * s)),
        step.map(|s| 0.5 / s),
    ] {
        numbers.iter().for_each(|x| out.bytes(&x.to_le_bytes()));
    }
}

/// Slots of the one node below the root, which spans more than any volume has, that have nodes of leaves.
struct Tree<'a> {
    volume: &'a Volume,
    background: f32,
    /// Whether every sample is active.
    dense: bool,
    /// Leaves along each axis; whether one has active samples.
    leaves: [usize; 3],
    active: Vec<bool>,
}

impl<'a> Tree<'a> {
    fn new(volume: &'a Volume) -> Tree<'a> {
        let largest = || volume.values().iter().fold(0.0_f32, |m, x| m.max(x.abs()));
        let nodes = volume.nodes();
        let mut tree = Tree {
            volume,
            background: volume.background().unwrap_or_else(largest),
            dense: volume.background().is_none(),
            leaves: nodes.map(|n| (n as usize).div_ceil(1 << vdb::LEAF)),
            active: Vec::new(),
        };
        let [x, y, z] = tree.leaves;
        tree.active = (0..x * y * z)
            .map(|i| {
                let leaf = [i % x, i / x % y, i / (x * y)];
                (0..1 << (3 * vdb::LEAF)).any(|n| tree.sample(leaf, n).1)
            })
            .collect();
        tree
    }

    /// A sample of a leaf, z fastest as OpenVDB counts, and whether it is active.
    fn sample(&self, leaf: [usize; 3], n: usize) -> (f32, bool) {
        let nodes = self.volume.nodes();
        let (nx, ny, nz) = (nodes[0] as usize, nodes[1] as usize, nodes[2] as usize);
        let (i, j, k) = (
            8 * leaf[0] + (n >> 6),
            8 * leaf[1] + (n >> 3 & 7),
            8 * leaf[2] + (n & 7),
        );
        if i >= nx || j >= ny || k >= nz {
            return (self.background, false);
        }
        let value = self.volume.values()[i + nx * (j + ny * k)];
        let active = self.dense || value.abs() < self.background;
        if active {
            return (value, true);
        }
        (self.background.copysign(value), false)
    }

    fn is_active(&self, leaf: [usize; 3]) -> bool {
        let [x, y, z] = self.leaves;
        leaf[0] < x
            && leaf[1] < y
            && leaf[2] < z
            && self.active[leaf[0] + x * (leaf[1] + y * leaf[2])]
    }

    /// The leaves of a node of leaves.
    fn of_lower(lower: [usize; 3]) -> impl Iterator<Item = (usize, [usize; 3])> {
        let side = 1 << vdb::LOWER.0;
        (0..side * side * side).map(move |n| {
            let at = [n / (side * side), n / side % side, n % side];
            let leaf = [
                lower[0] * side + at[0],
                lower[1] * side + at[1],
                lower[2] * side + at[2],
            ];
            (n, leaf)
        })
    }

    /// The nodes of leaves with their slots, of which any leaf is active.
    fn lowers(&self) -> Vec<(usize, [usize; 3])> {
        let side = 1 << vdb::UPPER.0;
        (0..side * side * side)
            .map(|n| (n, [n / (side * side), n / side % side, n % side]))
            .filter(|(_, at)| {
                let first = at.map(|i| i << vdb::LOWER.0);
                (0..3).all(|k| first[k] < self.leaves[k])
                    && Tree::of_lower(*at).any(|(_, leaf)| self.is_active(leaf))
            })
            .collect()
    }

    /// Whether a leaf without active samples is inside. What has no samples is outside.
    fn is_inside(&self, leaf: [usize; 3]) -> bool {
        self.sample(leaf, 0).0 < 0.0
    }

    fn topology(&self, out: &mut Out) {
        out.f32(self.background);
        // no tiles, one child
        out.u32(0);
        out.u32(1);
        out.bytes(&[0; 12]);
        let lowers = self.lowers();
        let slots = 1 << (3 * vdb::UPPER.0);
        let mut children = vec![0; slots / 8];
        let mut outside = vec![0; slots / 8];
        for n in 0..slots {
            let side = 1 << vdb::UPPER.0;
            let at = [n / (side * side), n / side % side, n % side];
            if !self.is_inside(at.map(|i| i << vdb::LOWER.0)) {
                mask::set(&mut outside, n);
            }
        }
        lowers
            .iter()
            .for_each(|(n, _)| mask::set(&mut children, *n));
        self.node(&children, &outside, out);
        for (_, lower) in &lowers {
            let slots = 1 << (3 * vdb::LOWER.0);
            let (mut children, mut outside) = (vec![0; slots / 8], vec![0; slots / 8]);
            for (n, leaf) in Tree::of_lower(*lower) {
                if self.is_active(leaf) {
                    mask::set(&mut children, n);
                } else if !self.is_inside(leaf) {
                    mask::set(&mut outside, n);
                }
            }
            self.node(&children, &outside, out);
            for (_, leaf) in Tree::of_lower(*lower).filter(|(_, l)| self.is_active(*l)) {
                self.active_mask(leaf, out);
            }
        }
    }

    /// The masks and tiles of a node that has no active tile.
    fn node(&self, children: &[u8], outside: &[u8], out: &mut Out) {
        out.bytes(children);
        out.bytes(&vec![0; children.len()]);
        out.bytes(&(vdb::EITHER).to_le_bytes());
        out.bytes(outside);
    }

    fn active_mask(&self, leaf: [usize; 3], out: &mut Out) {
        let mut active = [0; 64];
        (0..512)
            .filter(|n| self.sample(leaf, *n).1)
            .for_each(|n| mask::set(&mut active, n));
        out.bytes(&active);
    }

    fn buffers(&self, out: &mut Out) {
        for (_, lower) in self.lowers() {
            for (_, leaf) in Tree::of_lower(lower).filter(|(_, l)| self.is_active(*l)) {
                self.active_mask(leaf, out);
                let mut outside = [0; 64];
                (0..512)
                    .filter(|n| self.sample(leaf, *n).0 > 0.0)
                    .for_each(|n| mask::set(&mut outside, n));
                out.bytes(&(vdb::EITHER).to_le_bytes());
                out.bytes(&outside);
                for n in 0..512 {
                    let (value, active) = self.sample(leaf, n);
                    if active {
                        out.f32(value);
                    }
                }
            }
        }
    }
}
