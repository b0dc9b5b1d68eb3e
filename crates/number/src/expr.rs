//! The number type whose operations are recorded.

use super::real::{Ends, MOST_STEPS, Masked, Ops, Real, State, steps};
use super::record::{Binary, Comparison, Id, Logic, LoopId, Op, Recorder, Turns, Unary};
use super::vector::Vec3;
use std::cell::Cell;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number of a recorded formula: a literal, which operations fold, or a value of the record.
///
/// Operations whose result is plain (x + 0, x * 1, x * 0, min(x, x)) leave no trace: it is what keeps recorded gradients short.
#[derive(Clone, Copy, Debug)]
pub struct Expr<'r>(Number<'r>);

#[derive(Clone, Copy, Debug)]
enum Number<'r> {
    /// A literal knows the recorder of the number that it was made beside, if any.
    Literal(f32, Option<&'r Recorder>),
    Value(&'r Recorder, Id),
}

/// A condition of a recorded formula.
#[derive(Clone, Copy, Debug)]
pub struct Condition<'r>(Truth<'r>);

#[derive(Clone, Copy, Debug)]
enum Truth<'r> {
    Literal(bool),
    Value(&'r Recorder, Id),
}

impl<'r> Expr<'r> {
    /// A value of the record.
    pub(super) fn value(recorder: &'r Recorder, id: Id) -> Self {
        Expr(Number::Value(recorder, id))
    }

    fn literal(c: f32, recorder: Option<&'r Recorder>) -> Self {
        Expr(Number::Literal(c, recorder))
    }

    /// Its place in the record.
    pub(super) fn id(self, recorder: &Recorder) -> Id {
        match self.0 {
            Number::Literal(c, _) => recorder.add(Op::Literal(c.to_bits())),
            Number::Value(own, id) => {
                debug_assert!(std::ptr::eq(own, recorder), "two recorders in one formula");
                id
            }
        }
    }

    fn recorder(self) -> Option<&'r Recorder> {
        match self.0 {
            Number::Literal(_, recorder) => recorder,
            Number::Value(recorder, _) => Some(recorder),
        }
    }

    fn is(self, c: f32) -> bool {
        matches!(self.0, Number::Literal(x, _) if x == c)
    }

    fn unary(self, f: Unary) -> Self {
        match self.0 {
            Number::Literal(c, r) => Expr::literal(fold_unary(f, c), r),
            Number::Value(r, id) => Expr::value(r, r.add(Op::Unary(f, id))),
        }
    }

    fn binary(self, f: Binary, o: Self) -> Self {
        match (self.0, o.0) {
            (Number::Literal(a, r), Number::Literal(b, s)) => {
                Expr::literal(fold_binary(f, a, b), r.or(s))
            }
            (Number::Value(_, a), Number::Value(_, b))
                if a == b && matches!(f, Binary::Min | Binary::Max) =>
            {
                self
            }
            (Number::Value(r, _), _) | (_, Number::Value(r, _)) => {
                Expr::value(r, r.add(Op::Binary(f, self.id(r), o.id(r))))
            }
        }
    }

    fn compare(self, f: Comparison, o: Self) -> Condition<'r> {
        Condition(match (self.0, o.0) {
            (Number::Literal(a, _), Number::Literal(b, _)) => Truth::Literal(match f {
                Comparison::Below => a < b,
                Comparison::Above => a > b,
            }),
            (Number::Value(r, _), _) | (_, Number::Value(r, _)) => {
                Truth::Value(r, r.add(Op::Compare(f, self.id(r), o.id(r))))
            }
        })
    }
}

fn fold_unary(f: Unary, x: f32) -> f32 {
    match f {
        Unary::Neg => -x,
        Unary::Abs => x.abs(),
        Unary::Sqrt => x.sqrt(),
        Unary::Floor => x.floor(),
        Unary::Sin => x.sin(),
        Unary::Cos => x.cos(),
        Unary::Exp => x.exp(),
        Unary::Exp2 => x.exp2(),
        Unary::Ln => x.ln(),
    }
}

fn fold_binary(f: Binary, x: f32, y: f32) -> f32 {
    match f {
        Binary::Add => x + y,
        Binary::Sub => x - y,
        Binary::Mul => x * y,
        Binary::Div => x / y,
        Binary::Min => Ops::min(x, y),
        Binary::Max => Ops::max(x, y),
        Binary::Atan2 => x.atan2(y),
        Binary::Pow => Real::powf(x, y),
    }
}

impl From<f32> for Expr<'_> {
    fn from(c: f32) -> Self {
        Expr::literal(c, None)
    }
}

impl Neg for Expr<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        if let Number::Value(r, id) = self.0
            && let Some(a) = r.negated(id)
        {
            return Expr::value(r, a);
        }
        self.unary(Unary::Neg)
    }
}

impl Add for Expr<'_> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        if self.is(0.0) {
            o
        } else if o.is(0.0) {
            self
        } else {
            self.binary(Binary::Add, o)
        }
    }
}

impl Sub for Expr<'_> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        if o.is(0.0) {
            self
        } else if self.is(0.0) {
            -o
        } else {
            self.binary(Binary::Sub, o)
        }
    }
}

impl Mul for Expr<'_> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        if self.is(0.0) || o.is(0.0) {
            Expr::literal(0.0, self.recorder().or(o.recorder()))
        } else if self.is(1.0) {
            o
        } else if o.is(1.0) {
            self
        } else {
            self.binary(Binary::Mul, o)
        }
    }
}

impl Div for Expr<'_> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if o.is(1.0) || (self.is(0.0) && !o.is(0.0)) {
            self
        } else {
            self.binary(Binary::Div, o)
        }
    }
}

macro_rules! literal_arithmetic {
    ($($t:ident $f:ident),*) => {$(
        impl $t<f32> for Expr<'_> {
            type Output = Self;
            fn $f(self, o: f32) -> Self {
                $t::$f(self, Expr::from(o))
            }
        }
    )*};
}
literal_arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl<'r> Condition<'r> {
    fn logic(self, f: Logic, o: Self) -> Self {
        Condition(match (self.0, o.0) {
            (Truth::Literal(a), other) | (other, Truth::Literal(a)) => match (f, a) {
                (Logic::And, true) | (Logic::Or, false) => other,
                (Logic::And, false) | (Logic::Or, true) => Truth::Literal(a),
            },
            (Truth::Value(r, a), Truth::Value(_, b)) => Truth::Value(r, r.add(Op::Logic(f, a, b))),
        })
    }
}

impl BitAnd for Condition<'_> {
    type Output = Self;
    fn bitand(self, o: Self) -> Self {
        self.logic(Logic::And, o)
    }
}

impl BitOr for Condition<'_> {
    type Output = Self;
    fn bitor(self, o: Self) -> Self {
        self.logic(Logic::Or, o)
    }
}

impl Not for Condition<'_> {
    type Output = Self;
    fn not(self) -> Self {
        Condition(match self.0 {
            Truth::Literal(a) => Truth::Literal(!a),
            Truth::Value(r, a) => Truth::Value(r, r.add(Op::Not(a))),
        })
    }
}

impl<'r> Masked for Expr<'r> {
    type Mask = Condition<'r>;
}

macro_rules! ops {
    ($($rhs:ty),*) => {$(
        impl<'r> Ops<$rhs> for Expr<'r> {
            fn min(self, o: $rhs) -> Self {
                self.binary(Binary::Min, o.into())
            }
            fn max(self, o: $rhs) -> Self {
                self.binary(Binary::Max, o.into())
            }
            fn below(self, o: $rhs) -> Condition<'r> {
                self.compare(Comparison::Below, o.into())
            }
            fn above(self, o: $rhs) -> Condition<'r> {
                self.compare(Comparison::Above, o.into())
            }
        }
    )*};
}
ops!(Expr<'r>, f32);

impl<'r> State<Expr<'r>> for Expr<'r> {
    fn zip(self, o: Self, f: impl Fn(Self, Self) -> Self + Copy) -> Self {
        f(self, o)
    }
}

impl<'r> Real for Expr<'r> {
    const SHOWN: bool = true;
    type Base = Self;
    type Scalar = Self;
    type Store = &'r Recorder;

    fn param(store: &&'r Recorder, at: usize) -> Self {
        store.param(at as u32)
    }
    fn fetch(store: &&'r Recorder, grid: Self, node: Vec3<Self>) -> Self {
        let [x, y, z] = node.array().map(|c| c.id(store));
        Expr::value(store, store.add(Op::Fetch(grid.id(store), [x, y, z])))
    }
    fn constant(c: f64) -> Self {
        Expr::from(c as f32)
    }
    fn like(self, s: Self) -> Self {
        s
    }
    fn lit(self, c: f32) -> Self {
        Expr::literal(c, self.recorder())
    }
    fn select(m: Condition<'r>, yes: Self, no: Self) -> Self {
        match m.0 {
            Truth::Literal(true) => yes,
            Truth::Literal(false) => no,
            Truth::Value(r, m) => {
                let (yes, no) = (yes.id(r), no.id(r));
                if yes == no {
                    Expr::value(r, yes)
                } else {
                    Expr::value(r, r.add(Op::Select(m, yes, no)))
                }
            }
        }
    }
    fn sqrt(self) -> Self {
        self.unary(Unary::Sqrt)
    }
    fn abs(self) -> Self {
        self.unary(Unary::Abs)
    }
    fn floor(self) -> Self {
        self.unary(Unary::Floor)
    }
    fn sin_cos(self) -> (Self, Self) {
        (self.unary(Unary::Sin), self.unary(Unary::Cos))
    }
    fn exp(self) -> Self {
        self.unary(Unary::Exp)
    }
    fn exp2(self) -> Self {
        self.unary(Unary::Exp2)
    }
    fn ln(self) -> Self {
        self.unary(Unary::Ln)
    }
    fn atan2(self, x: Self) -> Self {
        self.binary(Binary::Atan2, x)
    }
    fn powf(self, k: Self) -> Self {
        self.binary(Binary::Pow, k)
    }
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let Some(r) = v.iter().find_map(|e| match e.0 {
            Number::Value(r, _) => Some(r),
            Number::Literal(..) => None,
        }) else {
            return v.iter().fold(Expr::from(0.0), |s, e| s + *e * *e).sqrt();
        };
        // zeros (of flattened shapes) do not make it longer; languages have vectors of up to four components
        let mut rest: Vec<Self> = v.into_iter().filter(|e| !e.is(0.0)).collect();
        while rest.len() > 4 {
            let tail = rest.split_off(rest.len() - 4);
            rest.push(length(r, &tail));
        }
        length(r, &rest)
    }

    fn repeat_while<T: State<Self>>(
        limit: Self,
        init: T,
        live: impl Fn(T) -> Condition<'r>,
        step: impl Fn(T) -> T,
    ) -> T {
        let turns = match limit.0 {
            Number::Literal(c, _) => Turns::Fixed(steps(c.into())),
            Number::Value(_, id) => Turns::Number(id),
        };
        if let Some(r) = limit.recorder().or(recorder_of(init)) {
            return record_loop(r, turns, init, live, step);
        }
        // nothing but literals so far: the loop runs here until a value of a record shows up
        let (mut state, mut left) = (init, steps_of(&turns));
        while left > 0 {
            match live(state).0 {
                Truth::Literal(true) => state = step(state),
                Truth::Literal(false) => return state,
                Truth::Value(r, _) => return record_loop(r, Turns::Fixed(left), state, live, step),
            }
            left -= 1;
            if let Some(r) = recorder_of(state) {
                return record_loop(r, Turns::Fixed(left), state, live, step);
            }
        }
        state
    }

    fn fold<const W: usize, T: State<Self>>(
        store: &&'r Recorder,
        at: usize,
        ends: Ends,
        init: T,
        step: impl Fn(T, [Self; W], [Self; W]) -> T,
    ) -> T {
        let r = *store;
        let of = r.open(Turns::Items {
            at: at as u32,
            width: W as u32,
            ends,
        });
        let states = init.zip(init, |a: Self, _| Expr::value(r, r.state(of, a.id(r))));
        let item = |next: bool| {
            std::array::from_fn(|k| {
                let component = k as u32;
                Expr::value(
                    r,
                    r.add(Op::Item {
                        of,
                        next,
                        component,
                    }),
                )
            })
        };
        let next = step(states, item(false), item(true));
        finish_loop(r, states, next);
        r.close(of);
        states
    }

    fn walk<const W: usize, const V: usize, T: State<Self>>(
        store: &&'r Recorder,
        at: usize,
        init: T,
        look: impl Fn(T, [Self; W]) -> (T, T, Condition<'r>),
        take: impl Fn(T, [Self; V]) -> T,
    ) -> T {
        fn numbers<const W: usize>(r: &Recorder, of: LoopId) -> [Expr<'_>; W] {
            std::array::from_fn(|k| {
                let (next, component) = (false, k as u32);
                Expr::value(
                    r,
                    r.add(Op::Item {
                        of,
                        next,
                        component,
                    }),
                )
            })
        }
        let r = *store;
        let carried =
            |of: LoopId, init: T| init.zip(init, |a: Self, _| Expr::value(r, r.state(of, a.id(r))));
        let (at, width) = (at as u32, W as u32);
        let of = r.open(Turns::Nodes { at, width });
        let states = carried(of, init);
        let node = numbers(r, of);
        let (entered, passed, enters) = look(states, node);
        if let Truth::Value(_, condition) = enters.0 {
            r.enter_if(of, condition);
        }
        let before = entered.zip(passed, |entered, passed| {
            Self::select(enters, entered, passed)
        });
        let none = Expr::literal(0.0, Some(r));
        let slice = Turns::Slice {
            at,
            nodes: width,
            width: V as u32,
            first: node[W - 3].id(r),
            count: Self::select(enters, node[W - 2], none).id(r),
        };
        let inner = r.open(slice);
        let taken = carried(inner, before);
        finish_loop(r, taken, take(taken, numbers(r, inner)));
        r.close(inner);
        finish_loop(r, states, taken);
        r.close(of);
        states
    }
}

/// Length of one to four components.
fn length<'r>(r: &'r Recorder, v: &[Expr<'r>]) -> Expr<'r> {
    match v {
        [] => Expr::literal(0.0, Some(r)),
        [x] => x.abs(),
        _ => {
            let ids = v.iter().map(|e| e.id(r)).collect();
            Expr::value(r, r.add(Op::Length(ids)))
        }
    }
}

fn steps_of(turns: &Turns) -> u32 {
    match turns {
        Turns::Fixed(n) => *n,
        _ => MOST_STEPS,
    }
}

/// The recorder that one of a loop's numbers belongs to.
fn recorder_of<'r, T: State<Expr<'r>>>(state: T) -> Option<&'r Recorder> {
    let found = Cell::new(None);
    state.zip(state, |a, _| {
        found.set(found.get().or(a.recorder()));
        a
    });
    found.get()
}

fn record_loop<'r, T: State<Expr<'r>>>(
    r: &'r Recorder,
    turns: Turns,
    init: T,
    live: impl Fn(T) -> Condition<'r>,
    step: impl Fn(T) -> T,
) -> T {
    if matches!(turns, Turns::Fixed(0)) {
        return init;
    }
    let of = r.open(turns);
    let states = init.zip(init, |a, _| Expr::value(r, r.state(of, a.id(r))));
    match live(states).0 {
        Truth::Literal(true) => {}
        Truth::Literal(false) => {
            r.abandon();
            return init;
        }
        Truth::Value(_, condition) => r.break_unless(of, condition),
    }
    finish_loop(r, states, step(states));
    r.close(of);
    states
}

fn finish_loop<'r, T: State<Expr<'r>>>(r: &'r Recorder, states: T, next: T) {
    states.zip(next, |state, next| {
        r.set_next(state.id(r), next.id(r));
        state
    });
}
