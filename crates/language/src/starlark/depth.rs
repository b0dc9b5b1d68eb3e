//! How deep parsing and running may go.
//!
//! The parser, the passes over the syntax tree and the interpreter recurse: calls, blocks and expressions inside each other
//! all take of one stack. So there is one budget for all of them, that no limit of a user raises: a text that nests deeper
//! than [`MAX_TOKENS`] is refused before the parser sees it, and the interpreter counts [`MAX_LEVELS`] whatever they are made
//! of. The thread that does it has a stack of its own, which is several times of what these take in a build without
//! optimisation. Should a compiler need even more, [`Depth`] sees the stack run out and refuses as well.

use super::mistake::{Mistake, mistake};

/// Stack of the thread that loads a scene. The system backs only what of it is used.
pub(crate) const STACK: usize = 256 << 20;

/// Stack that is left alone for what does not count its depth: functions of the language, the field's bounds, messages.
const RESERVE: usize = 16 << 20;

/// Levels that the interpreter may go deep: an expression or statement inside another is one, a call is [`CALL`].
pub(crate) const MAX_LEVELS: u32 = 10_000;

/// Levels that a call, a loop or a clause of a comprehension counts for, besides the expressions and statements in it: so
/// many functions of the interpreter lie between these.
pub(crate) const CALL: u32 = 4;

/// Tokens that may stand in one expression around the innermost one, without those in brackets that are closed again: an
/// upper bound of how deep the parser and the passes over its tree go. Fewer than [`MAX_LEVELS`], so that whatever is parsed
/// can also be run.
pub(crate) const MAX_TOKENS: usize = 4000;

/// How deep the interpreter is.
#[derive(Debug)]
pub(crate) struct Depth {
    levels: u32,
    /// Where the stack was when it began.
    base: usize,
}

impl Depth {
    /// At the beginning of the thread's work.
    pub(crate) fn new() -> Depth {
        Depth {
            levels: 0,
            base: here(),
        }
    }

    /// Goes down by so many levels. [`Depth::leave`] must follow, also after a refusal.
    #[inline]
    pub(crate) fn enter(&mut self, levels: u32) -> Result<(), Box<Mistake>> {
        self.levels += levels;
        let used = self.base.abs_diff(here());
        // more than there is of the stack: the place tells nothing, as with an address sanitiser's stacks
        let is_low = (STACK - RESERVE..STACK).contains(&used);
        if self.levels > MAX_LEVELS || is_low {
            return Err(too_deep());
        }
        Ok(())
    }

    /// Comes up by as many levels.
    #[inline]
    pub(crate) fn leave(&mut self, levels: u32) {
        self.levels -= levels;
    }
}

/// A place on the stack.
#[inline(always)]
fn here() -> usize {
    let on_stack = 0_u8;
    std::hint::black_box(&raw const on_stack).addr()
}

#[cold]
fn too_deep() -> Box<Mistake> {
    mistake(format!(
        "calls, blocks and expressions are more than {MAX_LEVELS} levels deep inside each other"
    ))
    .help("end the recursion earlier, or use a loop; give parts of long expressions names first")
}
