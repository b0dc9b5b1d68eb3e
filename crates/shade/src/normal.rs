//! Where the samples of a normal lie. The sum of their directions, each times the value found there, points along the gradient
//! (Zucker and Hummel 1981 weight the neighbours on a grid so).

use zeroset_number::{Real, Vec3};

/// Least distance between the samples of a normal, as a share of the largest coordinate: with less, the rounding of single
/// precision would show as noise.
const LEAST_STEP: f32 = 1.0 / 16384.0;

/// The corners of a tetrahedron, from its middle.
pub const TETRAHEDRON: [[f32; 3]; 4] = [
    [1.0, -1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [-1.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
];
/// Both ways along each axis.
pub const CENTRAL: [[f32; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
];

/// The neighbours in a cube of 27 that differ in at most `most` coordinates, sides first.
const fn neighbours<const N: usize>(most: usize) -> [[f32; 3]; N] {
    let mut out = [[0.0; 3]; N];
    let (mut at, mut axes) = (0, 1);
    while axes <= most {
        let mut i = 0;
        while i < 27 {
            let c = [i % 3, i / 3 % 3, i / 9];
            if (c[0] != 1) as usize + (c[1] != 1) as usize + (c[2] != 1) as usize == axes {
                out[at] = [c[0] as f32 - 1.0, c[1] as f32 - 1.0, c[2] as f32 - 1.0];
                at += 1;
            }
            i += 1;
        }
        axes += 1;
    }
    out
}

/// Sides and edges of a cube (Tomczak 2012, 3.1).
pub const NEIGHBOURS_18: [[f32; 3]; 18] = neighbours(2);
/// Sides, edges and corners of a cube (Tomczak 2012, 3.1).
pub const NEIGHBOURS_26: [[f32; 3]; 26] = neighbours(3);

/// Distance between the samples of a normal at `p`: half a pixel, but not less than single precision can tell.
#[inline(always)]
pub fn step<R: Real>(p: Vec3<R>, pixel: R) -> R {
    (pixel * 0.5)
        .max(p.abs().max_component() * LEAST_STEP)
        .max(1e-18)
}
