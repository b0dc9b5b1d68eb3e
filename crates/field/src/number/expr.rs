//! A recorded formula, printed as a WGSL function.
use super::real::*;
use std::{cell::RefCell, collections::HashMap, ops::*};

/// A literal needs no recorder, so that `R::constant` needs no context.
#[derive(Clone, Copy)]
pub enum Expr<'r> { Lit(f32), Ref(&'r Recorder, u32) }
#[derive(Clone, Copy)]
pub enum Cond<'r> { Lit(bool), Ref(&'r Recorder, u32) }

#[derive(Clone, PartialEq, Eq, Hash, Debug)]
enum Op { Input(String), Bin(&'static str, u32, u32), Call(&'static str, Vec<u32>), Neg(u32), Cmp(&'static str, u32, u32), Logic(&'static str, u32, u32), Not(u32), Select(u32, u32, u32), Lit(u32), Read(String) }
enum Stmt { Let(u32), Var(u32, u32), Set(u32, u32), For { counter: u32, limit: String, needs: Option<u32> }, BreakUnless(u32), Text(String), End }
#[derive(Default)]
struct Inner { ops: Vec<Op>, body: Vec<Stmt>, seen: Vec<HashMap<Op, u32>> }
#[derive(Default)]
pub struct Recorder(RefCell<Inner>);

impl Recorder {
    pub fn new() -> Self { let r = Recorder::default(); r.0.borrow_mut().seen.push(HashMap::new()); r }
    fn add(&self, op: Op) -> u32 {
        let mut n = self.0.borrow_mut();
        if let Some(&i) = n.seen.iter().find_map(|s| s.get(&op)) { return i; }
        let i = n.ops.len() as u32;
        n.ops.push(op.clone());
        n.seen.last_mut().unwrap().insert(op.clone(), i);
        if !matches!(op, Op::Input(_) | Op::Lit(_)) { n.body.push(Stmt::Let(i)); }
        i
    }
    fn var(&self, init: u32) -> u32 { let mut n = self.0.borrow_mut(); let i = n.ops.len() as u32; n.ops.push(Op::Input(format!("s{i}"))); n.body.push(Stmt::Var(i, init)); i }
    fn push(&self, s: Stmt) { self.0.borrow_mut().body.push(s); }
    fn open(&self, limit: String, needs: Option<u32>) -> u32 {
        let mut n = self.0.borrow_mut(); let i = n.ops.len() as u32; n.ops.push(Op::Input(format!("i{i}")));
        n.body.push(Stmt::For { counter: i, limit, needs }); n.seen.push(HashMap::new()); i
    }
    fn close(&self) { let mut n = self.0.borrow_mut(); n.body.push(Stmt::End); n.seen.pop(); }
    pub fn input(&self, name: &str) -> Expr<'_> { Expr::Ref(self, self.add(Op::Input(name.into()))) }
    /// Parameter `i` of this instruction.
    pub fn param(&self, i: u32) -> Expr<'_> { Expr::Ref(self, self.add(Op::Read(format!("params[at + {i}u]")))) }
    pub fn function(&self, name: &str, results: &[Expr<'_>]) -> String {
        let ids: Vec<u32> = results.iter().map(|e| e.id(self)).collect();
        let n = self.0.borrow();
        // what is used, backwards from the results (loops are kept whole)
        let mut used = vec![false; n.ops.len()];
        for &i in &ids { used[i as usize] = true; }
        for s in n.body.iter().rev() {
            match s {
                Stmt::Let(i) if used[*i as usize] => for a in args(&n.ops[*i as usize]) { used[a as usize] = true; },
                Stmt::Var(_, a) | Stmt::BreakUnless(a) => used[*a as usize] = true,
                Stmt::Set(_, a) => used[*a as usize] = true,
                Stmt::For { needs: Some(a), .. } => used[*a as usize] = true,
                _ => {}
            }
        }
        let mut out = format!("fn {name}(p: vec3f, at: u32) -> {} {{\n", if ids.len() == 1 { "f32" } else { "vec4f" });
        let mut pad = 1;
        for s in &n.body {
            let line = match s {
                Stmt::Let(i) => { if !used[*i as usize] { continue; } format!("let v{i} = {};", print(&n.ops, &n.ops[*i as usize])) }
                Stmt::Var(i, a) => format!("var s{i} = {};", name_of(&n.ops, *a)),
                Stmt::Set(i, a) => format!("s{i} = {};", name_of(&n.ops, *a)),
                Stmt::For { counter, limit, .. } => format!("for (var i{counter} = 0u; i{counter} < {limit}; i{counter}++) {{"),
                Stmt::BreakUnless(c) => format!("if (!{}) {{ break; }}", name_of(&n.ops, *c)),
                Stmt::Text(t) => t.clone(),
                Stmt::End => { pad -= 1; "}".into() }
            };
            out += &format!("{}{line}\n", "    ".repeat(pad));
            if matches!(s, Stmt::For { .. }) { pad += 1; }
        }
        let r: Vec<String> = ids.iter().map(|&i| name_of(&n.ops, i)).collect();
        out + &if r.len() == 1 { format!("    return {};\n}}\n", r[0]) } else { format!("    return vec4f({});\n}}\n", r.join(", ")) }
    }
}
fn args(o: &Op) -> Vec<u32> { match o {
    Op::Input(_) | Op::Lit(_) | Op::Read(_) => vec![], Op::Bin(_, a, b) | Op::Cmp(_, a, b) | Op::Logic(_, a, b) => vec![*a, *b],
    Op::Call(_, v) => v.clone(), Op::Neg(a) | Op::Not(a) => vec![*a], Op::Select(a, b, c) => vec![*a, *b, *c] } }
fn name_of(ops: &[Op], i: u32) -> String { match &ops[i as usize] {
    Op::Input(s) => s.clone(),
    Op::Lit(b) => { let x = f32::from_bits(*b); if x.is_sign_negative() { format!("({x:?}f)") } else { format!("{x:?}f") } }
    _ => format!("v{i}") } }
fn print(ops: &[Op], o: &Op) -> String {
    let n = |i: &u32| name_of(ops, *i);
    match o {
        Op::Input(s) | Op::Read(s) => s.clone(),
        Op::Lit(_) => unreachable!(),
        Op::Bin(s, a, b) | Op::Cmp(s, a, b) | Op::Logic(s, a, b) => format!("{} {s} {}", n(a), n(b)),
        Op::Call(f, v) => format!("{f}({})", v.iter().map(n).collect::<Vec<_>>().join(", ")),
        Op::Neg(a) => format!("-{}", n(a)), Op::Not(a) => format!("!{}", n(a)),
        Op::Select(m, a, b) => format!("select({}, {}, {})", n(b), n(a), n(m)),
    }
}

impl<'r> Expr<'r> {
    fn id(self, r: &Recorder) -> u32 { match self { Expr::Lit(c) => r.add(Op::Lit(c.to_bits())), Expr::Ref(_, i) => i } }
    fn one(self, k: impl Fn(f32) -> f32, op: impl Fn(u32) -> Op) -> Self { match self { Expr::Lit(c) => Expr::Lit(k(c)), Expr::Ref(r, i) => Expr::Ref(r, r.add(op(i))) } }
    fn two(self, o: Self, k: impl Fn(f32, f32) -> f32, op: impl Fn(u32, u32) -> Op) -> Self {
        match (self, o) { (Expr::Lit(a), Expr::Lit(b)) => Expr::Lit(k(a, b)), (Expr::Ref(r, _), _) | (_, Expr::Ref(r, _)) => Expr::Ref(r, r.add(op(self.id(r), o.id(r)))) }
    }
    fn cmp(self, o: Self, k: impl Fn(f32, f32) -> bool, op: &'static str) -> Cond<'r> {
        match (self, o) { (Expr::Lit(a), Expr::Lit(b)) => Cond::Lit(k(a, b)), (Expr::Ref(r, _), _) | (_, Expr::Ref(r, _)) => Cond::Ref(r, r.add(Op::Cmp(op, self.id(r), o.id(r)))) }
    }
    fn call1(self, k: impl Fn(f32) -> f32, f: &'static str) -> Self { self.one(k, |a| Op::Call(f, vec![a])) }
    fn is(self, c: f32) -> bool { matches!(self, Expr::Lit(x) if x == c) }
    fn rec(self) -> Option<&'r Recorder> { match self { Expr::Ref(r, _) => Some(r), _ => None } }
}
impl From<f32> for Expr<'_> { fn from(c: f32) -> Self { Expr::Lit(c) } }
macro_rules! bin { ($t:ident $f:ident $s:literal, |$a:ident, $b:ident| $fold:expr) => {
    impl $t for Expr<'_> { type Output = Self; fn $f(self, o: Self) -> Self {
        let ($a, $b) = (self, o);
        if let Some(e) = $fold { return e; }
        self.two(o, |a, b| $t::$f(a, b), |a, b| Op::Bin($s, a, b)) } }
    impl $t<f32> for Expr<'_> { type Output = Self; fn $f(self, o: f32) -> Self { $t::$f(self, Expr::Lit(o)) } }
}; }
// x * 0 = 0 and x * 1 = x: what makes a recorded gradient short
bin!(Add add "+", |a, b| if a.is(0.0) { Some(b) } else if b.is(0.0) { Some(a) } else { None });
bin!(Sub sub "-", |a, b| if b.is(0.0) { Some(a) } else if a.is(0.0) { Some(-b) } else { None });
bin!(Mul mul "*", |a, b| if a.is(0.0) || b.is(0.0) { Some(Expr::Lit(0.0)) } else if a.is(1.0) { Some(b) } else if b.is(1.0) { Some(a) } else { None });
bin!(Div div "/", |a, b| if b.is(1.0) || a.is(0.0) { Some(a) } else { None });
impl Neg for Expr<'_> { type Output = Self; fn neg(self) -> Self { self.one(|a| -a, Op::Neg) } }
impl<'r> BitAnd for Cond<'r> { type Output = Self; fn bitand(self, o: Self) -> Self { match (self, o) { (Cond::Lit(a), x) | (x, Cond::Lit(a)) => if a { x } else { Cond::Lit(false) }, (Cond::Ref(r, a), Cond::Ref(_, b)) => Cond::Ref(r, r.add(Op::Logic("&", a, b))) } } }
impl<'r> BitOr for Cond<'r> { type Output = Self; fn bitor(self, o: Self) -> Self { match (self, o) { (Cond::Lit(a), x) | (x, Cond::Lit(a)) => if a { Cond::Lit(true) } else { x }, (Cond::Ref(r, a), Cond::Ref(_, b)) => Cond::Ref(r, r.add(Op::Logic("|", a, b))) } } }
impl<'r> Not for Cond<'r> { type Output = Self; fn not(self) -> Self { match self { Cond::Lit(a) => Cond::Lit(!a), Cond::Ref(r, a) => Cond::Ref(r, r.add(Op::Not(a))) } } }
impl<'r> Masked for Expr<'r> { type Mask = Cond<'r>; }
macro_rules! ops { ($($t:ty),*) => {$( impl<'r> Ops<$t> for Expr<'r> {
    fn min(self, o: $t) -> Self { self.two(o.into(), f32::min, |a, b| Op::Call("min", vec![a, b])) }
    fn max(self, o: $t) -> Self { self.two(o.into(), f32::max, |a, b| Op::Call("max", vec![a, b])) }
    fn below(self, o: $t) -> Cond<'r> { self.cmp(o.into(), |a, b| a < b, "<") }
    fn above(self, o: $t) -> Cond<'r> { self.cmp(o.into(), |a, b| a > b, ">") }
} )*}; }
ops!(Expr<'r>, f32);
impl<'r> State<Expr<'r>> for Expr<'r> { fn zip(self, o: Self, f: impl Fn(Self, Self) -> Self + Copy) -> Self { f(self, o) } }

impl<'r> Real for Expr<'r> {
    type Base = Self;
    type Scalar = Self;
    type Store = &'r Recorder;
    fn param(r: &&'r Recorder, at: usize) -> Self { r.param(at as u32) }
    fn constant(c: f64) -> Self { Expr::Lit(c as f32) }
    fn like(self, s: Self) -> Self { s }
    fn lit(self, c: f32) -> Self { Expr::Lit(c) }
    fn select(m: Cond<'r>, a: Self, b: Self) -> Self {
        match m { Cond::Lit(true) => a, Cond::Lit(false) => b,
            Cond::Ref(r, m) => { let (a, b) = (a.id(r), b.id(r)); if a == b { Expr::Ref(r, a) } else { Expr::Ref(r, r.add(Op::Select(m, a, b))) } } }
    }
    fn sqrt(self) -> Self { self.call1(f32::sqrt, "sqrt") }
    fn abs(self) -> Self { self.call1(f32::abs, "abs") }
    fn floor(self) -> Self { self.call1(f32::floor, "floor") }
    fn exp(self) -> Self { self.call1(f32::exp, "exp") }
    fn ln(self) -> Self { self.call1(f32::ln, "log") }
    fn sin_cos(self) -> (Self, Self) { (self.call1(f32::sin, "sin"), self.call1(f32::cos, "cos")) }
    fn atan2(self, x: Self) -> Self { self.two(x, f32::atan2, |a, b| Op::Call("atan2", vec![a, b])) }
    fn powf(self, k: Self) -> Self { self.two(k, f32::powf, |a, b| Op::Call("pow", vec![a, b])) }
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let Some(r) = v.iter().find_map(|e| e.rec()) else { let mut s = 0.0; for e in v { if let Expr::Lit(c) = e { s += c * c; } } return Expr::Lit(s.sqrt()) };
        let ids: Vec<u32> = v.iter().map(|e| e.id(r)).collect();
        let ctor = r.add(Op::Call(match N { 2 => "vec2f", 3 => "vec3f", _ => "vec4f" }, ids));
        Expr::Ref(r, r.add(Op::Call("length", vec![ctor])))
    }
    fn repeat_while<T: State<Self>>(limit: Self, init: T, live: impl Fn(T) -> Cond<'r>, step: impl Fn(T) -> T) -> T {
        let rec = std::cell::Cell::new(limit.rec());
        init.zip(init, |a: Expr<'r>, b| { rec.set(rec.get().or(a.rec())); b });
        let r = rec.get().expect("a loop over nothing but literals");
        let vars = init.zip(init, |a: Expr<'r>, _| Expr::Ref(r, r.var(a.id(r))));
        let l = match limit { Expr::Lit(c) => format!("{}u", c as u32), Expr::Ref(_, i) => { let n = r.0.borrow(); format!("u32({})", name_of(&n.ops, i)) } };
        r.open(l, match limit { Expr::Ref(_, i) => Some(i), _ => None });
        if let Cond::Ref(_, c) = live(vars) { r.push(Stmt::BreakUnless(c)); }
        let next = step(vars);
        // every new value is a `let` (or a variable not yet assigned), so assigning in order is safe unless a variable is copied
        let next = next.zip(next, |a: Expr<'r>, _| Expr::Ref(r, r.copy_if_var(a.id(r))));
        vars.zip(next, |v: Expr<'r>, n: Expr<'r>| { r.push(Stmt::Set(v.id(r), n.id(r))); v });
        r.close();
        // the variables as they are after the loop, frozen
        vars.zip(vars, |v: Expr<'r>, _| Expr::Ref(r, r.freeze(v.id(r))))
    }
    fn fold<const W: usize, T: State<Self>>(store: &&'r Recorder, at: usize, ends: Ends, init: T, step: impl Fn(T, [Self; W], [Self; W]) -> T) -> T {
        let r = *store;
        let (n, first) = (format!("u32(params[at + {at}u])"), format!("at + {}u", at + 1));
        let vars = init.zip(init, |a: Expr<'r>, _| Expr::Ref(r, r.var(a.id(r))));
        let i = r.open(if ends == Ends::Ring { n.clone() } else { format!("max({n}, 1u) - 1u") }, None);
        r.push(Stmt::Text(format!("let a{i} = {first} + i{i} * {W}u;")));
        r.push(Stmt::Text(format!("let b{i} = {first} + ((i{i} + 1u) % {n}) * {W}u;")));
        let item = |c: &str| std::array::from_fn(|k| Expr::Ref(r, r.add(Op::Read(format!("params[{c}{i} + {k}u]")))));
        let next = step(vars, item("a"), item("b"));
        let next = next.zip(next, |a: Expr<'r>, _| Expr::Ref(r, r.copy_if_var(a.id(r))));
        vars.zip(next, |v: Expr<'r>, n: Expr<'r>| { r.push(Stmt::Set(v.id(r), n.id(r))); v });
        r.close();
        vars.zip(vars, |v: Expr<'r>, _| Expr::Ref(r, r.freeze(v.id(r))))
    }
}
impl Recorder {
    /// A loop's new value that is itself a loop variable must be read before the variables are written.
    fn copy_if_var(&self, i: u32) -> u32 { if matches!(self.0.borrow().ops[i as usize], Op::Input(_)) { self.freeze(i) } else { i } }
    fn freeze(&self, i: u32) -> u32 {
        let mut n = self.0.borrow_mut(); let name = name_of(&n.ops, i); let k = n.ops.len() as u32;
        n.ops.push(Op::Read(name)); n.body.push(Stmt::Let(k)); k
    }
}
