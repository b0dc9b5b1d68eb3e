//! The number types that a field formula is evaluated over.
//!
//! A formula is written once, over the trait [`Real`]; the number type decides what it computes:
//!
//! | number | gives |
//! | --- | --- |
//! | `f32`, [`F64`] | the value at one point; `f64` is the reference |
//! | [`Lanes`] | the values at 4 to 16 points at once |
//! | [`Interval`], [`SingleInterval`] | a proven range over a box: of real numbers, of what single precision gives too |
//! | [`Dual`] of any of them | value and gradient |
//! | [`Slope`] | a proven Lipschitz constant over a box |
//! | [`Expr`] | the formula itself as data, which [`wgsl`] prints for GPUs |
//!
//! ```
//! use zeroset_number::{Argument, Dual, F64, Interval, Real, Recorder, Slope, Vec3, v3, wgsl};
//!
//! #[inline(always)]
//! fn ball<R: Real>(p: Vec3<R>) -> R {
//!     p.length() - 1.0
//! }
//!
//! assert_eq!(ball(v3(0.0_f32, 3.0, 4.0)), 4.0);
//!
//! let d = ball(Dual::point(v3(F64(0.0), F64(3.0), F64(4.0))));
//! assert_eq!((d.v, d.d), (F64(4.0), [F64(0.0), F64(0.6), F64(0.8)]));
//!
//! let cube = Vec3::splat(Interval::new(1.0, 2.0));
//! assert!(ball(cube).lo > 0.73); // no surface in there
//! assert!(ball(Slope::point(cube)).l <= 1.0 + 1e-12); // and nothing steeper than 1
//!
//! let recorder = Recorder::new();
//! let result = ball(recorder.point("p"));
//! let function = recorder.function("ball", &[("p", Argument::Vec3)], &[result])?;
//! assert_eq!(
//!     wgsl::print(&function),
//!     "fn ball(p: vec3f) -> f32 {
//!     let v3 = length(vec3f(p.x, p.y, p.z));
//!     let v5 = v3 - 1.0f;
//!     return v5;
//! }
//! "
//! );
//! # Ok::<(), zeroset_number::RecordError>(())
//! ```
//!
//! Three rules for formulas. Everything is `#[inline(always)]`, closures too (see [`inlined`]): what is compiled on its own
//! has no vector instructions. A literal or a parameter stands on the right of an operator. Branches go through
//! [`Real::select`] where the two sides agree, through [`Real::choose`] where they do not, and loops through
//! [`Real::repeat_while`] and [`Args::fold`].

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod args;
pub mod data;
pub mod dual;
pub mod elementary;
pub mod expr;
pub mod hash;
pub mod interval;
pub mod lanes;
mod level;
mod list;
pub mod real;
pub mod record;
pub mod scalar;
pub mod slope;
pub mod vector;
pub mod wgsl;
mod wgsl_words;

pub use args::Args;
pub use data::{Data, Grid, GridError};
pub use dual::Dual;
pub use expr::Expr;
pub use hash::{Hash, hash1, hash2, hash3};
pub use interval::{Interval, IntervalOf, SingleInterval};
pub use lanes::Lanes;
pub use real::{Ends, MOST_STEPS, Masked, Ops, Real, State, Truth, differ, inlined, length2};
pub use record::{Argument, Function, RecordError, Recorder};
pub use scalar::F64;
pub use slope::Slope;
pub use vector::{Vec2, Vec3, v2, v3};
