//! Random formulas, and random places that lean towards trouble.

use proptest::prelude::*;
use zeroset_number::{F64, Interval, MOST_STEPS, Real, Vec3, v2, v3};

/// A formula as data.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    X,
    Y,
    Z,
    Literal(f32),
    /// A parameter.
    Constant(f32),
    Unary(Unary, Box<Tree>),
    Binary(Binary, Box<Tree>, Box<Tree>),
    /// Length of a vector.
    Length(Box<[Tree; 3]>),
    /// Where the first is below the second: the third, else the fourth. Jumps.
    Choose(Box<[Tree; 4]>),
    /// A loop that ends early: starts from the first two, runs while below the third.
    Loop(f32, Box<[Tree; 3]>),
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Unary {
    Neg,
    Abs,
    Sqrt,
    Floor,
    Fract,
    Sin,
    Cos,
    Exp,
    Exp2,
    Ln,
    Sq,
    Recip,
    Tanh,
    Asin,
    Acos,
    Atan,
    Sign,
    Cube,
    Clamp01,
    Round,
}
const UNARY: [Unary; 20] = [
    Unary::Neg,
    Unary::Abs,
    Unary::Sqrt,
    Unary::Floor,
    Unary::Fract,
    Unary::Sin,
    Unary::Cos,
    Unary::Exp,
    Unary::Exp2,
    Unary::Ln,
    Unary::Sq,
    Unary::Recip,
    Unary::Tanh,
    Unary::Asin,
    Unary::Acos,
    Unary::Atan,
    Unary::Sign,
    Unary::Cube,
    Unary::Clamp01,
    Unary::Round,
];

#[derive(Clone, Copy, Debug)]
pub(crate) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Atan2,
    /// The power of the first by a constant.
    Pow(f32),
    Modulo(f32),
    /// The smaller by selection.
    Select,
    Smoothstep(f32),
    Unit,
}

fn binary() -> impl Strategy<Value = Binary> {
    prop_oneof![
        Just(Binary::Add),
        Just(Binary::Sub),
        Just(Binary::Mul),
        Just(Binary::Div),
        Just(Binary::Min),
        Just(Binary::Max),
        Just(Binary::Atan2),
        Just(Binary::Select),
        Just(Binary::Unit),
        prop::sample::select(vec![0.0, 0.5, 1.0, 2.0, 2.5, -1.0, 8.0]).prop_map(Binary::Pow),
        prop::sample::select(vec![0.25, 1.0, 3.3]).prop_map(Binary::Modulo),
        prop::sample::select(vec![0.1, 1.0]).prop_map(Binary::Smoothstep),
    ]
}

/// A number that something may go wrong with.
pub(crate) fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -4.0_f32..4.0,
        2 => prop::sample::select(vec![
            0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-30, -1e-30, 1e-20, 1e6, -1e6, 1e-3,
            std::f32::consts::PI, std::f32::consts::FRAC_PI_2, -std::f32::consts::PI,
            f32::MIN_POSITIVE, 1.0 + f32::EPSILON, 1.0 - f32::EPSILON,
        ]),
        1 => (-8_i32..8).prop_map(|i| i as f32 * 0.5),
    ]
}

/// A random formula.
pub(crate) fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        4 => prop::sample::select(vec![0, 1, 2]).prop_map(|k| match k {
            0 => Tree::X,
            1 => Tree::Y,
            _ => Tree::Z,
        }),
        1 => number().prop_map(Tree::Literal),
        1 => number().prop_map(Tree::Constant),
    ];
    leaf.prop_recursive(6, 40, 4, |inner| {
        let boxed = inner.clone().prop_map(Box::new);
        prop_oneof![
            6 => (prop::sample::select(UNARY.to_vec()), boxed.clone()).prop_map(|(f, a)| Tree::Unary(f, a)),
            6 => (binary(), boxed.clone(), boxed).prop_map(|(f, a, b)| Tree::Binary(f, a, b)),
            2 => prop::array::uniform3(inner.clone()).prop_map(|v| Tree::Length(Box::new(v))),
            1 => prop::array::uniform4(inner.clone()).prop_map(|v| Tree::Choose(Box::new(v))),
            1 => (0.0_f32..6.0, prop::array::uniform3(inner)).prop_map(|(n, v)| Tree::Loop(n, Box::new(v))),
        ]
    })
}

impl Tree {
    /// The formula at `p`; `seen` is told of every value on the way.
    pub(crate) fn eval<R: Real>(&self, p: Vec3<R>, seen: &mut impl FnMut(R)) -> R {
        let v = match self {
            Tree::X => p.x,
            Tree::Y => p.y,
            Tree::Z => p.z,
            Tree::Literal(c) => p.x.lit(*c),
            Tree::Constant(c) => p.x.like(R::constant((*c).into())),
            Tree::Unary(f, a) => unary(*f, a.eval(p, seen)),
            Tree::Binary(f, a, b) => apply(*f, a.eval(p, seen), b.eval(p, seen)),
            Tree::Length(v) => {
                let [a, b, c] = v.each_ref().map(|t| t.eval(p, seen));
                v3(a, b, c).length()
            }
            Tree::Choose(v) => {
                let [a, b, c, d] = v.each_ref().map(|t| t.eval(p, seen));
                R::choose(a.below(b), c, d)
            }
            Tree::Loop(n, v) => {
                let [a, b, c] = v.each_ref().map(|t| t.eval(p, seen));
                let (x, y) = R::repeat_while(
                    R::constant((*n).into()),
                    (a, b),
                    |(x, _)| x.below(c),
                    |(x, y)| (x * 0.75 + y, y.sin() - 0.5),
                );
                x - y
            }
        };
        seen(v);
        v
    }

    /// The value at a point and the largest value on the way, if all are finite.
    pub(crate) fn at(&self, p: [f64; 3]) -> Option<(f64, f64)> {
        let (mut finite, mut largest) = (true, 0.0_f64);
        let p = v3(F64(p[0]), F64(p[1]), F64(p[2]));
        let v = self.eval(p, &mut |x: F64| {
            finite &= x.0.is_finite();
            largest = largest.max(x.0.abs());
        });
        finite.then_some((v.0, largest))
    }
}

fn unary<R: Real>(f: Unary, a: R) -> R {
    match f {
        Unary::Neg => -a,
        Unary::Abs => a.abs(),
        Unary::Sqrt => a.sqrt(),
        Unary::Floor => a.floor(),
        Unary::Fract => a.fract(),
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        Unary::Exp => a.exp(),
        Unary::Exp2 => a.exp2(),
        Unary::Ln => a.ln(),
        Unary::Sq => a.sq(),
        Unary::Recip => a.recip(),
        Unary::Tanh => a.tanh(),
        Unary::Asin => a.asin(),
        Unary::Acos => a.acos(),
        Unary::Atan => a.atan(),
        Unary::Sign => a.sign(),
        Unary::Cube => a.powi(3),
        Unary::Clamp01 => a.clamp01(),
        Unary::Round => a.round(),
    }
}

fn apply<R: Real>(f: Binary, a: R, b: R) -> R {
    match f {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        Binary::Atan2 => a.atan2(b),
        Binary::Pow(k) => a.powf(R::constant(k.into())) + b,
        Binary::Modulo(c) => a.modulo(c) + b,
        Binary::Select => R::select(a.below(b), a, b),
        Binary::Smoothstep(c) => a.smoothstep(-c, c) * b,
        Binary::Unit => v2(a, b).normalize().x,
    }
}

/// A box, and places in it.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    centre: [f64; 3],
    half: [f64; 3],
    inside: Vec<[f64; 3]>,
}

/// A box to prove something in: near-equal coordinates, zeros, huge and tiny boxes, single points.
pub(crate) fn place() -> impl Strategy<Value = Place> {
    let half = || prop::sample::select(vec![0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 1.0, 10.0]);
    let centre = prop_oneof![
        3 => prop::array::uniform3(number()),
        1 => number().prop_map(|x| [x, x, -x]),
        1 => number().prop_map(|x| [x, x.next_up(), x.next_down()]),
    ];
    let fraction =
        || prop_oneof![2 => -1.0_f64..1.0, 1 => Just(-1.0), 1 => Just(1.0), 1 => Just(0.0)];
    let halves = prop_oneof![half().prop_map(|h| [h; 3]), [half(), half(), half()]];
    (
        centre,
        halves,
        prop::collection::vec([fraction(), fraction(), fraction()], 12),
    )
        .prop_map(|(centre, half, inside)| Place {
            centre: centre.map(f64::from),
            half,
            inside,
        })
}

impl Place {
    pub(crate) fn intervals(&self) -> Vec3<Interval> {
        let side =
            |k: usize| Interval::new(self.centre[k] - self.half[k], self.centre[k] + self.half[k]);
        v3(side(0), side(1), side(2))
    }

    /// Points of the box.
    pub(crate) fn points(&self) -> impl Iterator<Item = [f64; 3]> {
        let sides = self.intervals().array();
        self.inside.iter().map(move |t| {
            std::array::from_fn(|k| {
                (self.centre[k] + t[k] * self.half[k]).clamp(sides[k].lo, sides[k].hi)
            })
        })
    }
}

#[test]
fn counts_are_bounded() {
    // a limit that no loop could reach in a lifetime
    let turns = |limit: f32| f32::repeat_while(limit, 0.0, |_| true, |s| s + 1.0);
    assert_eq!(turns(f32::MAX), MOST_STEPS as f32);
    assert_eq!(turns(f32::NAN), 0.0);
    assert_eq!(turns(-3.0), 0.0);
    assert_eq!(turns(3.9), 3.0);
}
