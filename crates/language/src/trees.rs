//! What the syntax tree of a script takes, before there is one.

use crate::budget::{LoadBudget, Spent};
use starlark_syntax::codemap::CodeMap;
use starlark_syntax::dialect::Dialect;
use starlark_syntax::lexer::{Lexer, Token};

/// Bytes of the tree, and of the parser's own stack, that a word or sign may become. An estimate: `tests/memory.rs` holds the peak of
/// files that are just within it.
const TOKEN: u64 = 256;
/// How often the text is held beside the one that was read: by its source, and by the lexer and the parser for messages.
const COPIES: u64 = 3;
/// Tokens between two looks at the clock.
const CLOCK: u64 = 4096;

/// Charges the syntax tree of a text, an upper bound that follows from its words and signs.
pub(crate) fn charge(name: &str, text: &str, budget: &mut LoadBudget) -> Result<(), Spent> {
    let what = || format!("what \"{name}\" says");
    budget.hold(COPIES * text.len() as u64, what)?;
    let dialect = Dialect {
        enable_f_strings: true,
        ..Dialect::Standard
    };
    let codes = CodeMap::new(String::new(), text.to_string());
    let mut tokens = 0;
    // the parser goes no further than the first mistake either
    for token in Lexer::new(text, &dialect, codes).map_while(Result::ok) {
        if matches!(token.1, Token::Comment(_)) {
            continue;
        }
        tokens += 1;
        if tokens % CLOCK == 0 {
            budget.check_clock()?;
            budget.hold(TOKEN * CLOCK, what)?;
        }
    }
    budget.hold(TOKEN * (tokens % CLOCK), what)
}
