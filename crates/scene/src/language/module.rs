//! Files of the language: parsed, checked for nesting, and the files that they load before them.

use super::mistake::{Run, mistake};
use super::scope::Check;
use crate::limits::Limits;
use crate::report::Place;
use starlark_syntax::codemap::CodeMap;
use starlark_syntax::dialect::{Dialect, DialectTypes};
use starlark_syntax::lexer::{Lexer, Token};
use starlark_syntax::syntax::AstModule;
use std::collections::HashMap;

/// A parsed file.
pub(crate) struct Module {
    /// The number of its source.
    pub(crate) file: u32,
    pub(crate) ast: AstModule,
    /// What its `load` statements name, as numbers of modules that stand before it.
    pub(crate) loads: HashMap<String, u32>,
}

/// What of Starlark the scene language has: everything but types.
const DIALECT: Dialect = Dialect {
    enable_types: DialectTypes::Disable,
    enable_keyword_only_arguments: true,
    enable_top_level_stmt: true,
    enable_f_strings: true,
    ..Dialect::Standard
};

/// Tokens that may stand in one expression around the innermost one, without those in brackets that are closed again:
/// an upper bound of how deep the parser goes.
const MAX_CHAIN: usize = 4000;
/// `elif` branches in a file; each is one level deeper to the parser.
const MAX_ELIF: usize = 1000;

/// Parses and checks one file.
pub(crate) fn parse(file: u32, name: &str, text: &str, limits: &Limits) -> Run<AstModule> {
    check_nesting(file, text, limits)?;
    let ast = AstModule::parse(name, text.to_string(), &DIALECT).map_err(|e| {
        let message = e.without_diagnostic().to_string();
        let message = message
            .strip_prefix("Parse error: ")
            .unwrap_or(&message)
            .to_string();
        let place = e.span().map(|s| Place {
            file,
            start: s.span.begin().get(),
            end: s.span.end().get(),
        });
        let whole = Place {
            file,
            start: 0,
            end: 0,
        };
        let help = instead(&message).map(String::from);
        mistake(message).maybe_help(help).at(place.unwrap_or(whole))
    })?;
    let builtins = super::builtins();
    Check::module(
        file,
        ast.statement(),
        |name| builtins.contains_key(name),
        builtins.keys().copied(),
    )?;
    Ok(ast)
}

/// What to write in place of a word that Python has and this language does not.
fn instead(message: &str) -> Option<&'static str> {
    const WORDS: &[(&str, &str)] = &[
        (
            "while",
            "a `for` loop over range(n) ends by itself; `break` ends it earlier",
        ),
        ("import", "write load(\"parts.star\", \"name\")"),
        ("from", "write load(\"parts.star\", \"name\")"),
        ("class", "a function can give a field, a tuple or a dict"),
        (
            "try",
            "mistakes end the script; test a condition with `if` before",
        ),
        ("raise", "write fail(\"message\")"),
        ("assert", "write `if not ...: fail(\"message\")`"),
        ("is", "write `==`"),
        ("global", "give the value back with `return`"),
    ];
    let word = message
        .split('`')
        .nth(1)
        .filter(|_| message.contains("reserved keyword"))?;
    WORDS.iter().find(|w| w.0 == word).map(|w| w.1)
}

/// Refuses a text that would make the parser or the interpreter go too deep, before either sees it.
fn check_nesting(file: u32, text: &str, limits: &Limits) -> Run<()> {
    let mut lexer = Lexer::new(
        text,
        &DIALECT,
        CodeMap::new(String::new(), text.to_string()),
    );
    // open brackets, each with its tokens since the last comma and whether it is among the parameters of a lambda
    let (mut outer, mut level) = (Vec::new(), (0_usize, false));
    let (mut chain, mut blocks, mut elifs) = (0_usize, 0_u64, 0_usize);
    while let Some(Ok((start, token, end))) = lexer.next() {
        match token {
            Token::ClosingRound | Token::ClosingSquare | Token::ClosingCurly => {
                chain -= level.0;
                level = outer.pop().unwrap_or_default();
            }
            Token::Newline => {
                chain -= level.0;
                level = (0, false);
            }
            Token::Comma if !level.1 => {
                chain -= level.0;
                level.0 = 0;
            }
            Token::Indent => blocks += 1,
            Token::Dedent => blocks = blocks.saturating_sub(1),
            ref token => {
                (level.0, chain) = (level.0 + 1, chain + 1);
                match token {
                    Token::Elif => elifs += 1,
                    Token::Lambda => level.1 = true,
                    Token::Colon => level.1 = false,
                    Token::OpeningRound | Token::OpeningSquare | Token::OpeningCurly => {
                        outer.push(std::mem::take(&mut level));
                    }
                    _ => {}
                }
            }
        }
        let place = Place {
            file,
            start: start as u32,
            end: end as u32,
        };
        if outer.len() as u64 + blocks > limits.nesting {
            let message = format!(
                "more than {} brackets and blocks inside each other",
                limits.nesting
            );
            return Err(mistake(message)
                .help("give parts of it names first, or raise the limit `nesting`")
                .at(place));
        }
        if chain > MAX_CHAIN {
            return Err(mistake("this expression is too long")
                .help("give parts of it names first, or use a list")
                .at(place));
        }
        if elifs > MAX_ELIF {
            return Err(mistake(format!("more than {MAX_ELIF} `elif`"))
                .help("look values up in a dict instead")
                .at(place));
        }
    }
    Ok(())
}
