//! Every operation that only the compiler emits is WGSL that naga accepts, with its gradient.

use zeroset_field::formula::{Binary, Unary};
use zeroset_field::number::{Args, Argument, Dual, Expr, Real, Recorder, Vec3, wgsl};
use zeroset_field::op::{Change, Leaf, Warp, arithmetic, domain};

fn validate(name: &str, source: &str) {
    let head = "@group(0) @binding(0) var<storage, read> params: array<f32>;\n";
    let source = format!("{head}{source}");
    let module = naga::front::wgsl::parse_str(&source)
        .unwrap_or_else(|error| panic!("{name}: {}\n{source}", error.emit_to_string(&source)));
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{name}: {}\n{source}", error.emit_to_string(&source)));
}

trait Recorded {
    fn record<'r, R: Real<Scalar = Expr<'r>, Store = &'r Recorder>>(
        &self,
        p: Vec3<R>,
        d: R,
        e: R,
        a: Args<'_, R>,
    ) -> Vec<R>;
}

fn print(name: &str, recorder: &Recorder, results: &[Expr<'_>]) -> String {
    let arguments = [
        ("p", Argument::Vec3),
        ("d", Argument::Number),
        ("e", Argument::Number),
        ("at", Argument::Offset),
    ];
    let function = recorder.function(name, &arguments, results);
    wgsl::print(&function.unwrap_or_else(|error| panic!("{name}: {error}")))
}

fn prove(name: &str, f: &impl Recorded) {
    let recorder = Recorder::new();
    let values = f.record(
        recorder.point("p"),
        recorder.input("d"),
        recorder.input("e"),
        Args::new(&&recorder),
    );
    let value = print("value", &recorder, &values);
    let recorder = Recorder::new();
    let p = Dual::point(recorder.point("p"));
    let zero = recorder.input("p.x") * 0.0;
    let number = |name: &str| Dual {
        v: recorder.input(name),
        d: [recorder.input("p.y"), zero, recorder.input("p.z")],
    };
    let values = f.record(p, number("d"), number("e"), Args::new(&&recorder));
    let [x, y, z] = values[0].d;
    let gradient = print("gradient", &recorder, &[x, y, z, values[0].v]);
    validate(name, &(value + &gradient));
}

struct One(Unary);
impl Recorded for One {
    fn record<'r, R: Real<Scalar = Expr<'r>, Store = &'r Recorder>>(
        &self,
        _p: Vec3<R>,
        d: R,
        _e: R,
        _a: Args<'_, R>,
    ) -> Vec<R> {
        vec![arithmetic::unary(self.0, d)]
    }
}

struct Two(Binary);
impl Recorded for Two {
    fn record<'r, R: Real<Scalar = Expr<'r>, Store = &'r Recorder>>(
        &self,
        _p: Vec3<R>,
        d: R,
        e: R,
        _a: Args<'_, R>,
    ) -> Vec<R> {
        vec![arithmetic::binary(self.0, d, e)]
    }
}

#[test]
fn arithmetic_is_wgsl() {
    for f in Unary::ALL {
        prove(&format!("{f:?}"), &One(f));
    }
    for f in Binary::ALL {
        prove(&format!("{f:?}"), &Two(f));
    }
}

macro_rules! operations {
    ($($what:ident $name:ty),* $(,)?) => {$({
        struct Operation;
        impl Recorded for Operation {
            fn record<'r, R: Real<Scalar = Expr<'r>, Store = &'r Recorder>>(
                &self,
                p: Vec3<R>,
                d: R,
                _e: R,
                a: Args<'_, R>,
            ) -> Vec<R> {
                operations!(@$what $name, p, d, a)
            }
        }
        prove(stringify!($name), &Operation);
    })*};
    (@leaf $name:ty, $p:ident, $d:ident, $a:ident) => {{ let _ = $d; vec![<$name as Leaf>::leaf($p, $a)] }};
    (@warp $name:ty, $p:ident, $d:ident, $a:ident) => {{ let _ = $d; <$name as Warp>::warp($p, $a).array().to_vec() }};
    (@change $name:ty, $p:ident, $d:ident, $a:ident) => { vec![<$name as Change>::change($d, $p, $a)] };
}

#[test]
fn placements_continuations_and_walls_are_wgsl() {
    operations! {
        leaf arithmetic::Coordinate<0>,
        leaf arithmetic::Coordinate<1>,
        leaf arithmetic::Coordinate<2>,
        leaf arithmetic::Constant,
        warp domain::Offset,
        warp domain::Rigid,
        warp domain::Clamp,
        warp domain::RepeatCell,
        warp domain::PolarCell,
        change domain::Scale,
        change domain::Continue,
        change domain::RepeatWall,
        change domain::PolarWall,
    }
}
