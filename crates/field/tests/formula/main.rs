//! Free-form formulas: how they are written down and that their slopes are proven.

#![allow(unreachable_pub, reason = "nothing outside a test can use it")]

mod build;
mod proof;
mod random;
mod refusal;

use zeroset_catalogue::bounds::Aabb;
use zeroset_field::formula::{Budget, Builder, Expression, Formula, ProofError, Steps};

/// The steps of a formula of the point.
pub fn steps(f: impl Fn(&Expression) -> Expression) -> Steps {
    let builder = Builder::new();
    let value = f(&builder.point());
    builder.finish(&value).unwrap()
}

/// A formula proven over a cube around the origin.
pub fn proven(half: f64, f: impl Fn(&Expression) -> Expression) -> Result<Formula, ProofError> {
    Formula::prove(steps(f), Aabb::centred([half; 3]), &Budget::default())
}

/// Xorshift.
pub struct Random(pub u64);

impl Random {
    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in a cube around the origin.
    pub fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| reach * (2.0 * self.unit() - 1.0))
    }
}
