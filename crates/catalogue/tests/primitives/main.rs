//! Every primitive of the catalogue is what it says: a new entry is proven by being listed.
//!
//! `cargo test --test primitives torus` proves one entry (any part of the struct's name, with its capitals).

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a number that is none must fail a proof"
)]
#![allow(
    clippy::type_complexity,
    reason = "tables of functions are what entries are made of"
)]
#![allow(unreachable_pub, reason = "the modules of a test are its own")]

use zeroset_catalogue::bounds::Exactness;
use zeroset_catalogue::each_primitive;

mod case;
mod entry;
mod geometry;
mod mutants;
mod numbers;
mod statement;

use case::{Case, Failure};
use entry::{Entry, entry};

/// All proofs at all sets of parameters.
fn prove(e: &Entry) -> Result<(), Failure> {
    statement::info(e)?;
    statement::shader(e)?;
    for params in statement::sets(e) {
        let case = Case::new(e, &params)?;
        geometry::sign(&case)?;
        if e.exactness != Exactness::Estimate {
            geometry::slope(&case)?;
            geometry::empty_ball(&case)?;
            geometry::reached(&case)?;
            numbers::gradient(&case)?;
        }
        geometry::bounds(&case)?;
        geometry::levels(&case)?;
        numbers::single(&case)?;
        numbers::interval(&case)?;
        numbers::any_size(&case)?;
    }
    Ok(())
}

macro_rules! proofs {
    ($($root:ident :: $module:ident :: $entry:ident,)*) => {
        /// Every entry.
        const ALL: &[fn() -> Entry] = &[$(entry::<$root::$module::$entry>),*];

        #[allow(non_snake_case, reason = "a test has the name of its entry")]
        mod prove {
            use super::*;
            $(
                #[test]
                fn $entry() {
                    if let Err(failure) = super::prove(&entry::<$root::$module::$entry>()) {
                        panic!("{failure}");
                    }
                }
            )*
        }
    };
}
each_primitive!(proofs);

#[test]
fn names_are_unique() {
    let mut names: Vec<&str> = ALL.iter().map(|e| e().info.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|w| w[0] != w[1]), "{names:?}");
}
