//! Fields of samples.

use super::Leaf;
use zeroset_number::{Args, Real, Vec3, v3};

/// What lies between the nearest nodes of a grid, interpolated along the axes. Parameters: where the first node is, nodes a
/// scene unit along each axis, the grid's number, its nodes along each axis.
///
/// Beyond the grid its nearest place counts: what a distance is there is for
/// [`Continue`](super::domain::Continue) to say.
pub struct Sampled;

impl Leaf for Sampled {
    #[inline(always)]
    fn leaf<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let node = v3(
            (p.x - a.get(0)) * a.get(3),
            (p.y - a.get(1)) * a.get(4),
            (p.z - a.get(2)) * a.get(5),
        );
        a.sample(6, node)
    }
}
