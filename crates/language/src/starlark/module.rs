//! Files of the language: parsed, checked for nesting, and the files that they load before them.

use super::depth::MAX_TOKENS;
use super::letters::Letters;
use super::mistake::{Run, mistake};
use super::scope::NameCheck;
use crate::limits::Limits;
use crate::report::Place;
use starlark_syntax::codemap::CodeMap;
use starlark_syntax::dialect::{Dialect, DialectTypes};
use starlark_syntax::lexer::{Lexer, Token};
use starlark_syntax::syntax::AstModule;
use starlark_syntax::syntax::ast::AstStmt;
use starlark_syntax::syntax::module::AstModuleFields;
use std::collections::HashMap;

/// A parsed file.
pub(crate) struct Module {
    /// The number of its source.
    pub(crate) file: u32,
    pub(crate) statement: AstStmt,
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

/// `elif` branches in a file; each is one level deeper to the parser.
const MAX_ELIF: usize = 1000;

/// What a file says, and the files that its `load` statements name with where they do.
pub(crate) type Parsed = (AstStmt, Vec<(String, Place)>);

/// Parses and checks one file.
pub(crate) fn parse(file: u32, name: &str, text: &str, limits: &Limits) -> Run<Parsed> {
    let letters = Letters::of(text).map_err(|(start, m)| {
        let start = start as u32;
        m.at(Place {
            file,
            start,
            end: start + 1,
        })
    })?;
    check_nesting(file, letters.text(), limits)?;
    let ast = AstModule::parse(name, letters.text().to_string(), &DIALECT).map_err(|e| {
        let message = e.without_diagnostic().to_string();
        let message = letters.in_message(message.strip_prefix("Parse error: ").unwrap_or(&message));
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
    let loads = (ast.loads().into_iter())
        .map(|l| {
            let place = Place {
                file,
                start: l.span.span.begin().get(),
                end: l.span.span.end().get(),
            };
            (l.module_id.to_string(), place)
        })
        .collect();
    let (_, mut statement, ..) = ast.into_parts();
    letters.restore(&mut statement);
    let builtins = super::builtins();
    NameCheck::module(
        file,
        &statement,
        |name| builtins.contains_key(name),
        builtins.keys().copied(),
    )?;
    Ok((statement, loads))
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
    /// What word processors and web pages put in place of plain signs.
    const SIGNS: &[(&str, &str)] = &[
        ("\u{2212}\u{2013}\u{2014}", "write the plain sign -"),
        (
            "\u{201c}\u{201d}\u{201e}\u{ab}\u{bb}",
            "write the plain quotation mark \"",
        ),
        (
            "\u{2018}\u{2019}\u{201a}`\u{b4}",
            "write the plain quotation mark '",
        ),
        ("\u{d7}\u{b7}\u{22c5}", "write * for times"),
        ("\u{f7}", "write / for divided by"),
        (
            "\u{a0}\u{2009}\u{202f}\u{3000}\u{feff}\u{200b}",
            "write a plain space",
        ),
        ("\u{b2}\u{b3}", "write pow(x, 2) for a power"),
    ];
    /// What shaders, C and OpenSCAD have: what the message begins with, or holds, and what to write.
    const HABITS: &[(&str, &str)] = &[
        ("'**'", "write pow(x, 2) for a power"),
        ("invalid input `?`", "write `a if condition else b`"),
        ("invalid input `!`", "write `not`, and `!=` for unequal"),
        (
            "unexpected symbol '&'",
            "write `and` between conditions; a & b is what lies in both shapes",
        ),
        (
            "unexpected symbol '|'",
            "write `or` between conditions; a | b joins shapes",
        ),
        ("unexpected symbol '//'", "a comment begins with #"),
        ("comparisons are not associative", "write 0 < x and x < 2"),
        (
            "unexpected identifier",
            "what is done to a shape stands behind it, as in box(1).move(x = 2); variables have no types, as in d = 1.0",
        ),
    ];
    if let Some((_, write)) = HABITS.iter().find(|(words, _)| message.contains(words)) {
        return Some(write);
    }
    let word = message.split('`').nth(1)?;
    if message.starts_with("invalid input") {
        let sign = word.chars().next()?;
        return SIGNS.iter().find(|s| s.0.contains(sign)).map(|s| s.1);
    }
    if !message.contains("reserved keyword") {
        return None;
    }
    WORDS.iter().find(|w| w.0 == word).map(|w| w.1)
}

/// Tokens of one bracket, or of a statement outside of brackets.
#[derive(Default)]
struct Level {
    /// Since the last comma.
    tokens: usize,
    /// Lambdas whose parameters are not over yet: their commas separate nothing else.
    lambdas: usize,
}

/// Refuses a text that would make the parser, the passes over its tree or the interpreter go too deep, before any of them
/// sees it.
fn check_nesting(file: u32, text: &str, limits: &Limits) -> Run<()> {
    let mut lexer = Lexer::new(
        text,
        &DIALECT,
        CodeMap::new(String::new(), text.to_string()),
    );
    // open brackets, and the innermost
    let (mut outer, mut level) = (Vec::new(), Level::default());
    let (mut chain, mut blocks, mut elifs) = (0_usize, 0_usize, 0_usize);
    while let Some(Ok((start, token, end))) = lexer.next() {
        match token {
            // nobody goes deeper for what is left out
            Token::Comment(_) => {}
            Token::ClosingRound
            | Token::ClosingSquare
            | Token::ClosingCurly
            | Token::FStringExprEnd => {
                chain -= level.tokens;
                level = outer.pop().unwrap_or_default();
            }
            Token::Newline => {
                chain -= level.tokens;
                level = Level::default();
            }
            Token::Semicolon if outer.is_empty() => {
                chain -= level.tokens;
                level = Level::default();
            }
            Token::Comma if level.lambdas == 0 => {
                chain -= level.tokens;
                level.tokens = 0;
            }
            Token::Indent => blocks += 1,
            Token::Dedent => blocks = blocks.saturating_sub(1),
            ref token => {
                (level.tokens, chain) = (level.tokens + 1, chain + 1);
                match token {
                    Token::Elif => elifs += 1,
                    Token::Lambda => level.lambdas += 1,
                    Token::Colon => level.lambdas = level.lambdas.saturating_sub(1),
                    Token::OpeningRound
                    | Token::OpeningSquare
                    | Token::OpeningCurly
                    | Token::FStringExprStart => outer.push(std::mem::take(&mut level)),
                    _ => {}
                }
            }
        }
        let place = Place {
            file,
            start: start as u32,
            end: end as u32,
        };
        if (outer.len() + blocks) as u64 > limits.nesting {
            let message = format!(
                "more than {} brackets and blocks inside each other",
                limits.nesting
            );
            return Err(mistake(message)
                .help("give parts of it names first, or raise the limit `nesting`")
                .at(place));
        }
        // a block is a statement in a list of statements
        if chain + 2 * blocks > MAX_TOKENS {
            return Err(mistake(format!(
                "this expression is too long: more than {MAX_TOKENS} words and signs inside each other"
            ))
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
