//! Every operation as recorded functions: the text of a field in a shading language is made of them.
//!
//! The lists are generated from those of the evaluators: an entry of the catalogue is here without a further line.

use zeroset_catalogue::op::*;
use zeroset_catalogue::tape::Operation;
use zeroset_catalogue::{each_change, each_leaf, each_pair, each_put, each_warp};
use zeroset_number::{Args, Argument, Dual, Expr, Function, Ops, Real, Recorder};

/// What a recorded function takes and gives. All take `at` last: where the operation's parameters begin.
///
/// A number with its gradient is a vector of four: the value, then the derivatives along x, y and z. A point with its
/// derivatives is three of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// Values: a point `p` to a number (leaf) or a point (warp), a number `d` and a point `p` to a point (put) or a number
    /// (change), two numbers `x` and `y` to a number (pair).
    Value,
    /// As [`Form::Value`], for numbers with their gradients and points with their derivatives.
    Gradient,
    /// As [`Form::Gradient`], where the point is the one that the gradient is taken at: `p` is a plain vector. Not for
    /// pairs, which have no point.
    PlainGradient,
    /// For pairs: how much of the joined value follows `y`, 0 to 1, from the numbers `x` and `y`. See
    /// `zeroset_eval::marks`.
    Share,
    /// For leaves that have them: a vector of the four orbit traps at the point `p`.
    Traps,
}

impl Form {
    /// Every form.
    pub const ALL: [Form; 5] = [
        Form::Value,
        Form::Gradient,
        Form::PlainGradient,
        Form::Share,
        Form::Traps,
    ];

    fn prefix(self) -> &'static str {
        match self {
            Form::Value => "",
            Form::Gradient => "gradient_",
            Form::PlainGradient => "plain_gradient_",
            Form::Share => "share_",
            Form::Traps => "traps_",
        }
    }
}

/// Every operation that has functions, kind by kind: all but marks.
pub fn operations() -> impl Iterator<Item = Operation> {
    let codes = |n: usize| (0..n).map(|code| code as u16);
    (codes(LEAVES.len()).map(Operation::Leaf))
        .chain(codes(WARPS.len()).map(Operation::Warp))
        .chain(codes(PUTS.len()).map(Operation::Put))
        .chain(codes(CHANGES.len()).map(Operation::Change))
        .chain(codes(PAIRS.len()).map(Operation::Pair))
}

/// The name of an operation's function, such as `leaf_sphere` or `share_pair_smooth_union`: different for each operation and
/// form, and one that WGSL and GLSL allow. None for marks, and for codes that are in no list.
pub fn name(operation: Operation, form: Form) -> Option<String> {
    let kind = match operation {
        Operation::Leaf(_) => "leaf",
        Operation::Warp(_) => "warp",
        Operation::Put(_) => "put",
        Operation::Change(_) => "change",
        Operation::Pair(_) => "pair",
        Operation::Mark(..) => return None,
    };
    let path = entry(operation)?.path;
    Some(format!("{}{kind}{}", form.prefix(), type_name(path)))
}

/// The function of an operation in a form. None where there is none, for marks, and for codes that are in no list.
pub fn function(operation: Operation, form: Form) -> Option<Function> {
    let name = name(operation, form)?;
    let recorder = Recorder::new();
    let (arguments, results) = (entry(operation)?.record)(&recorder, form)?;
    let arguments = [arguments, &[("at", Argument::Offset)]].concat();
    let function = recorder.function(&name, &arguments, &results);
    Some(function.expect("operations use their own arguments and no constant that is no number"))
}

type Arguments = &'static [(&'static str, Argument)];
/// Arguments (without the offset) and results.
type Recording<'r> = (Arguments, Vec<Expr<'r>>);

struct Entry {
    /// The type as it is written in the list.
    path: &'static str,
    record: for<'r> fn(&'r Recorder, Form) -> Option<Recording<'r>>,
}

fn leaf<E: Leaf>(r: &Recorder, form: Form) -> Option<Recording<'_>> {
    Some(match form {
        Form::Value => (POINT, vec![E::leaf(r.point("p"), Args::new(&r))]),
        Form::Traps if E::TRAPS => (POINT, E::traps(r.point("p"), Args::new(&r)).to_vec()),
        Form::Gradient | Form::PlainGradient => {
            let (arguments, p) = match form {
                Form::Gradient => (DUAL_POINT, r.dual_point("p")),
                _ => (POINT, Dual::point(r.point("p"))),
            };
            (arguments, flat([E::leaf(p, Args::new(&r))]))
        }
        Form::Share | Form::Traps => return None,
    })
}

fn warp<E: Warp>(r: &Recorder, form: Form) -> Option<Recording<'_>> {
    Some(match form {
        Form::Value => (POINT, E::warp(r.point("p"), Args::new(&r)).array().to_vec()),
        Form::Gradient | Form::PlainGradient => {
            let (arguments, p) = match form {
                Form::Gradient => (DUAL_POINT, r.dual_point("p")),
                _ => (POINT, Dual::point(r.point("p"))),
            };
            (arguments, flat(E::warp(p, Args::new(&r)).array()))
        }
        Form::Share | Form::Traps => return None,
    })
}

fn put<E: Put>(r: &Recorder, form: Form) -> Option<Recording<'_>> {
    Some(match form {
        Form::Value => {
            let q = E::put(r.input("d"), r.point("p"));
            (VALUE_AND_POINT, q.array().to_vec())
        }
        Form::Gradient | Form::PlainGradient => {
            let (arguments, p) = match form {
                Form::Gradient => (DUAL_AND_DUAL_POINT, r.dual_point("p")),
                _ => (DUAL_AND_POINT, Dual::point(r.point("p"))),
            };
            (arguments, flat(E::put(r.dual("d"), p).array()))
        }
        Form::Share | Form::Traps => return None,
    })
}

fn change<E: Change>(r: &Recorder, form: Form) -> Option<Recording<'_>> {
    Some(match form {
        Form::Value => {
            let d = E::change(r.input("d"), r.point("p"), Args::new(&r));
            (VALUE_AND_POINT, vec![d])
        }
        Form::Gradient | Form::PlainGradient => {
            let (arguments, p) = match form {
                Form::Gradient => (DUAL_AND_DUAL_POINT, r.dual_point("p")),
                _ => (DUAL_AND_POINT, Dual::point(r.point("p"))),
            };
            (arguments, flat([E::change(r.dual("d"), p, Args::new(&r))]))
        }
        Form::Share | Form::Traps => return None,
    })
}

fn pair<E: Pair>(r: &Recorder, form: Form) -> Option<Recording<'_>> {
    const NUMBERS: Arguments = &[("x", Argument::Number), ("y", Argument::Number)];
    const DUALS: Arguments = &[("x", Argument::Vec4), ("y", Argument::Vec4)];
    Some(match form {
        Form::Value => {
            let joined = E::pair(r.input("x"), r.input("y"), Args::new(&r));
            (NUMBERS, vec![joined])
        }
        Form::Gradient | Form::Share => {
            let [x, y] = match form {
                Form::Gradient => [r.dual("x"), r.dual("y")],
                // derivatives with respect to the operands themselves
                _ => {
                    let [x, y] = [r.input("x"), r.input("y")];
                    let (o, l) = (x.lit(0.0), x.lit(1.0));
                    [Dual { v: x, d: [l, o, o] }, Dual { v: y, d: [o, l, o] }]
                }
            };
            let joined = E::pair(x, y, Args::new(&r));
            if form == Form::Gradient {
                (DUALS, flat([joined]))
            } else {
                let (u, v) = (joined.d[0].abs(), joined.d[1].abs());
                (NUMBERS, vec![v / Ops::<f32>::max(u + v, 1e-20)])
            }
        }
        Form::PlainGradient | Form::Traps => return None,
    })
}

const POINT: Arguments = &[("p", Argument::Vec3)];
const VALUE_AND_POINT: Arguments = &[("d", Argument::Number), ("p", Argument::Vec3)];
const DUAL_AND_POINT: Arguments = &[("d", Argument::Vec4), ("p", Argument::Vec3)];
const DUAL_AND_DUAL_POINT: Arguments = &[("d", Argument::Vec4), ("p", Argument::Mat3x4)];
const DUAL_POINT: Arguments = &[("p", Argument::Mat3x4)];

/// Values and derivatives, one number behind the other.
fn flat<'r, const N: usize>(duals: [Dual<Expr<'r>>; N]) -> Vec<Expr<'r>> {
    duals
        .into_iter()
        .flat_map(|Dual { v, d: [x, y, z] }| [v, x, y, z])
        .collect()
}

/// `_smooth_union` from `join_smooth::SmoothUnion`, `_sphere` from `Centred<solid::Sphere>`, `_coordinate_0` from
/// `Coordinate<0>`.
fn type_name(path: &str) -> String {
    let mut out = String::new();
    for part in path.split(['<', '>']) {
        let part = part.rsplit("::").next().unwrap_or(part).trim();
        if part == "Centred" {
            continue;
        }
        for (i, c) in part.char_indices() {
            if c.is_ascii_uppercase() || (i == 0 && c.is_ascii_digit()) {
                out.push('_');
            }
            out.push(c.to_ascii_lowercase());
        }
    }
    out
}

fn entry(operation: Operation) -> Option<&'static Entry> {
    match operation {
        Operation::Leaf(code) => LEAVES.get(usize::from(code)),
        Operation::Warp(code) => WARPS.get(usize::from(code)),
        Operation::Put(code) => PUTS.get(usize::from(code)),
        Operation::Change(code) => CHANGES.get(usize::from(code)),
        Operation::Pair(code) => PAIRS.get(usize::from(code)),
        Operation::Mark(..) => None,
    }
}

macro_rules! entries {
    ($kind:ident $($entry:ty,)*) => {
        &[$(Entry { path: stringify!($entry), record: $kind::<$entry> }),*]
    };
}
const LEAVES: &[Entry] = each_leaf!(entries leaf);
const WARPS: &[Entry] = each_warp!(entries warp);
const PUTS: &[Entry] = each_put!(entries put);
const CHANGES: &[Entry] = each_change!(entries change);
const PAIRS: &[Entry] = each_pair!(entries pair);

#[cfg(test)]
mod tests;
