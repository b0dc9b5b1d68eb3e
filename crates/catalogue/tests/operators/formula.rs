//! A join, a map or a modifier as one formula over four numbers, in every number type.

use std::marker::PhantomData;

use fearless_simd::{Level, Simd, prelude::*};
use zeroset_catalogue::{Join, Map, Modify};
use zeroset_number::{
    Args, Argument, Data, Dual, Expr, F64, Interval, Lanes, Real, Recorder, Slope, v3, wgsl,
};

/// What a formula takes: a field's value, and three numbers, which are a point or the operands of a join.
pub type Input<T> = [T; 4];
/// What it gives; joins and modifiers only the first of them.
pub type Output<T> = [T; 3];
pub type Gradient = [f64; 3];
/// Derivatives of the inputs: of the field's value, and of the three numbers by themselves.
pub type Seeds = [Gradient; 4];

pub trait Formula: 'static {
    fn eval<R: Real>(q: Input<R>, a: Args<'_, R>) -> Output<R>;
}

pub struct OfJoin<J>(PhantomData<J>);
impl<J: Join> Formula for OfJoin<J> {
    #[inline(always)]
    fn eval<R: Real>([_, x, y, _]: Input<R>, a: Args<'_, R>) -> Output<R> {
        [J::join(x, y, a), x.lit(0.0), x.lit(0.0)]
    }
}

pub struct OfMap<M>(PhantomData<M>);
impl<M: Map> Formula for OfMap<M> {
    #[inline(always)]
    fn eval<R: Real>([_, x, y, z]: Input<R>, a: Args<'_, R>) -> Output<R> {
        M::map(v3(x, y, z), a).array()
    }
}

pub struct OfModify<M>(PhantomData<M>);
impl<M: Modify> Formula for OfModify<M> {
    #[inline(always)]
    fn eval<R: Real>([d, x, y, z]: Input<R>, a: Args<'_, R>) -> Output<R> {
        [M::modify(d, v3(x, y, z), a), x.lit(0.0), x.lit(0.0)]
    }
}

/// One formula, over every number type.
#[derive(Clone, Copy)]
pub struct Numbers {
    /// The reference.
    pub value: fn(Input<f64>, &[f32]) -> Output<f64>,
    /// Values and gradients.
    pub gradient: fn(Input<f64>, Seeds, &[f32]) -> Output<(f64, Gradient)>,
    /// `f32`, with gradients.
    pub single: fn(Input<f32>, Seeds, &[f32]) -> Output<(f32, [f32; 3])>,
    /// SIMD at a level of instructions.
    pub lanes: fn(Level, &[Input<f32>], &[f32]) -> Vec<Output<f32>>,
    /// Proven ranges.
    pub range: fn(Input<Interval>, &[f32]) -> Output<Interval>,
    /// Proven ranges of values and gradients.
    pub slope: fn(Input<Interval>, Seeds, &[f32]) -> Output<Slope>,
    /// The formula and its gradient as WGSL.
    pub shader: fn() -> String,
}

pub fn numbers<F: Formula>() -> Numbers {
    Numbers {
        value: |q, a| F::eval(q.map(F64), Args::new(&Data::from(a))).map(|v| v.0),
        gradient: |q, s, a| {
            let q = std::array::from_fn(|i| Dual {
                v: F64(q[i]),
                d: s[i].map(F64),
            });
            F::eval(q, Args::new(&Data::from(a))).map(|r| (r.v.0, r.d.map(|x| x.0)))
        },
        single: |q, s, a| {
            let q = std::array::from_fn(|i| Dual {
                v: q[i],
                d: s[i].map(|x| x as f32),
            });
            F::eval(q, Args::new(&Data::from(a))).map(|r| (r.v, r.d))
        },
        lanes: |level, q, a| zeroset_number::at_level!(level, s => lanes::<F, _>(s, q, a)),
        range: |q, a| F::eval(q, Args::new(&Data::from(a))),
        slope: |q, s, a| {
            let q = std::array::from_fn(|i| Slope {
                v: q[i],
                d: s[i].map(Interval::point),
                l: s[i].iter().map(|x| x * x).sum::<f64>().sqrt(),
            });
            F::eval(q, Args::new(&Data::from(a)))
        },
        shader: shader::<F>,
    }
}

#[inline(always)]
fn lanes<F: Formula, S: Simd>(s: S, q: &[Input<f32>], a: &[f32]) -> Vec<Output<f32>> {
    let mut out = Vec::with_capacity(q.len());
    let data = Data::from(a);
    for chunk in q.chunks(S::f32s::LEN) {
        let axis = |k: usize| Lanes::<S>(S::f32s::from_fn(s, |i| chunk[i.min(chunk.len() - 1)][k]));
        let r = F::eval([axis(0), axis(1), axis(2), axis(3)], Args::new(&data));
        out.extend((0..chunk.len()).map(|i| r.map(|v| v.0.as_slice()[i])));
    }
    out
}

fn shader<F: Formula>() -> String {
    let recorder = Recorder::new();
    let q = ["d", "p.x", "p.y", "p.z"].map(|n| recorder.input(n));
    let [x, y, z] = F::eval(q, Args::new(&&recorder));
    let value = print("value", &recorder, &[x, y, z]);
    let recorder = Recorder::new();
    let d = Dual {
        v: recorder.input("d"),
        d: recorder.point("g").array(),
    };
    let p = Dual::point(recorder.point("p"));
    let [first, ..] = F::eval([d, p.x, p.y, p.z], Args::new(&&recorder));
    value
        + &print(
            "gradient",
            &recorder,
            &[first.d[0], first.d[1], first.d[2], first.v],
        )
}

fn print(name: &str, recorder: &Recorder, results: &[Expr<'_>]) -> String {
    let arguments = [
        ("d", Argument::Number),
        ("g", Argument::Vec3),
        ("p", Argument::Vec3),
        ("at", Argument::Offset),
    ];
    match recorder.function(name, &arguments, results) {
        Ok(function) => wgsl::print(&function),
        // no shader: naga refuses the message, and the failure shows it
        Err(e) => e.to_string(),
    }
}

/// Every level of instructions that this machine has.
pub fn levels() -> Vec<(&'static str, Level)> {
    let mut levels = vec![("baseline", Level::baseline())];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let best = Level::new();
        levels.extend(best.as_avx2().map(|s| ("avx2", s.level())));
    }
    levels
}
