//! Every join, map and modifier of the catalogue is what it says: a new entry is proven by being listed.
//!
//! `cargo test --test operators Twist` proves one entry (any part of the struct's name, with its capitals).

#![allow(unreachable_pub, reason = "nothing outside a test can use it")]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "what is not a number must fail"
)]
#![allow(
    clippy::type_complexity,
    reason = "plain functions of numbers need no names"
)]

use zeroset_catalogue::{each_join, each_map, each_modify};

mod field;
mod formula;
mod joins;
mod maps;
mod modifiers;
mod mutants;
mod numbers;
mod shapes;
mod statement;

macro_rules! proofs {
    ($tests:ident $kind:ident $($root:ident :: $module:ident :: $entry:ident,)*) => {
        #[allow(non_snake_case, reason = "a test has the name of its entry")]
        mod $tests {
            use super::$kind;
            $(
                #[test]
                fn $entry() {
                    if let Err(failure) = $kind::prove(&$kind::table::<$root::$module::$entry>()) {
                        panic!("{failure}");
                    }
                }
            )*

            pub(super) fn names() -> Vec<&'static str> {
                vec![$($kind::table::<$root::$module::$entry>().common.info.name),*]
            }
        }
    };
}
each_join!(proofs join joins);
each_map!(proofs map maps);
each_modify!(proofs modify modifiers);

#[test]
fn names_are_unique() {
    let mut names = [join::names(), map::names(), modify::names()].concat();
    names.sort_unstable();
    assert!(names.windows(2).all(|w| w[0] != w[1]), "{names:?}");
}
