//! What of a shader a function needs. A file from Shadertoy also shades and reads textures; that is cut away before it is parsed, so that
//! only what the distance rests on must be understood. What is cut becomes blanks: places in the text stay what they were.

use std::collections::{HashMap, HashSet};

/// A function definition, a declaration, or a directive of the preprocessor: a range of bytes.
#[derive(Clone, Debug, PartialEq)]
struct Item {
    start: usize,
    end: usize,
    kind: Kind,
    /// Names that it defines.
    defines: Vec<String>,
    /// Names that it mentions.
    mentions: HashSet<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Function,
    Declaration,
    /// `#define`.
    Macro,
    /// `#if` and the like.
    Directive,
    /// What says something to another compiler: `#version`, `precision highp float;`.
    Addressed,
}

/// A word or a sign of the text, without comments.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Token<'a> {
    start: usize,
    end: usize,
    text: &'a str,
}

/// A shader with only that in it which some function needs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slice {
    /// The text, as long as the whole was.
    pub text: String,
    /// Variables that are set from outside: `uniform`s that were kept.
    pub uniforms: Vec<String>,
    /// Every name that is mentioned.
    pub mentions: HashSet<String>,
}

/// The names of all functions of a text, each once, in its order.
pub(crate) fn functions(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    for item in items(text) {
        if item.kind == Kind::Function {
            names.extend(
                item.defines
                    .into_iter()
                    .filter(|n| !names.contains(n))
                    .collect::<Vec<_>>(),
            );
        }
    }
    names
}

/// Where brackets, or signs before an operand, are nested deeper than this.
pub(crate) fn too_deep(text: &str, most: usize) -> Option<usize> {
    let (mut open, mut signs) = (0_usize, 0_usize);
    for token in tokens(text, 0..text.len()) {
        signs = match token.text {
            "-" | "+" | "!" | "~" | "=" | "?" => signs + 1,
            ";" | "{" | "}" => 0,
            _ => signs,
        };
        match token.text {
            "(" | "[" | "{" => open += 1,
            ")" | "]" | "}" => open = open.saturating_sub(1),
            _ => {}
        }
        // long sums have many signs, and do not nest
        if open > most || signs > 40 * most {
            return Some(token.start);
        }
    }
    None
}

/// Keeps what the function of this name needs.
pub(crate) fn slice(text: &str, function: &str) -> Slice {
    let items = items(text);
    let mut by_name: HashMap<&str, Vec<usize>> = HashMap::new();
    for (k, item) in items.iter().enumerate() {
        for name in &item.defines {
            by_name.entry(name).or_default().push(k);
        }
    }
    let mut wanted = vec![false; items.len()];
    let mut mentions = HashSet::new();
    // what directives ask for is there whatever is kept
    let asked = (items.iter()).filter(|i| i.kind == Kind::Directive);
    let mut open: Vec<String> = asked.flat_map(|i| i.mentions.iter().cloned()).collect();
    open.push(function.to_owned());
    while let Some(name) = open.pop() {
        for &k in by_name.get(name.as_str()).map_or(&[][..], Vec::as_slice) {
            if !std::mem::replace(&mut wanted[k], true) {
                open.extend(
                    items[k]
                        .mentions
                        .iter()
                        .filter(|n| !mentions.contains(*n))
                        .cloned(),
                );
            }
        }
        mentions.insert(name);
    }
    let mut kept: Vec<u8> = text.as_bytes().to_vec();
    let mut blank = |range: std::ops::Range<usize>| {
        for byte in &mut kept[range] {
            if !matches!(*byte, b'\n' | b'\r') {
                *byte = b' ';
            }
        }
    };
    let mut uniforms = Vec::new();
    for (item, wanted) in items.iter().zip(&wanted) {
        match item.kind {
            Kind::Directive => {}
            Kind::Addressed => blank(item.start..item.end),
            _ if !wanted => blank(item.start..item.end),
            Kind::Declaration => {
                // a uniform becomes a variable: its value is the scene's affair
                for token in tokens(text, item.start..item.end).iter().take(2) {
                    if matches!(token.text, "uniform" | "varying" | "in") {
                        blank(token.start..token.end);
                        uniforms.extend(item.defines.iter().cloned());
                    }
                }
            }
            Kind::Function | Kind::Macro => {}
        }
    }
    // whole characters were replaced, byte by byte, by ASCII
    let text = String::from_utf8_lossy(&kept).into_owned();
    Slice {
        text,
        uniforms,
        mentions,
    }
}

fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// The items of a text, in its order.
fn items(text: &str) -> Vec<Item> {
    let mut items = Vec::new();
    let all = tokens(text, 0..text.len());
    let mut i = 0;
    while i < all.len() {
        if all[i].text.starts_with('#') {
            items.push(directive(text, all[i]));
            i += 1;
            continue;
        }
        let first = i;
        let (mut round, mut curly, mut is_function) = (0_i32, 0_i32, false);
        let mut body = None;
        while i < all.len() {
            match all[i].text {
                "(" => round += 1,
                ")" => round -= 1,
                "{" => {
                    if curly == 0 {
                        body = Some(i);
                        let head = &all[first..i];
                        is_function = head.last().is_some_and(|t| t.text == ")");
                    }
                    curly += 1;
                }
                "}" => {
                    curly -= 1;
                    if curly <= 0 && is_function {
                        break;
                    }
                }
                ";" if curly <= 0 && round <= 0 => break,
                // a directive within an item belongs to it, but not its names
                _ => {}
            }
            i += 1;
        }
        let last = i.min(all.len() - 1);
        i = last + 1;
        items.push(item(
            &all[first..=last],
            is_function,
            body.map(|b| b - first),
        ));
    }
    items
}

fn item(tokens: &[Token<'_>], is_function: bool, body: Option<usize>) -> Item {
    let words = |tokens: &[Token<'_>]| -> HashSet<String> {
        let inner = tokens.iter().flat_map(|t| {
            let is_line = t.text.starts_with('#');
            let own = is_word(t.text).then(|| t.text.to_owned());
            own.into_iter().chain(if is_line {
                named_in(t.text)
            } else {
                Vec::new()
            })
        });
        inner.collect()
    };
    let before = |sign: &str| tokens.iter().position(|t| t.text == sign);
    let (kind, defines) = match tokens {
        [first, ..] if first.text == "precision" => (Kind::Addressed, Vec::new()),
        _ if is_function || (before("(").is_some() && before("=").is_none() && body.is_none()) => {
            let name = before("(")
                .and_then(|k| k.checked_sub(1))
                .map(|k| tokens[k].text.to_owned());
            (Kind::Function, name.into_iter().collect())
        }
        _ => {
            // whatever it names: more than it defines, so that rather too much is kept
            let mut names: Vec<String> = words(tokens)
                .into_iter()
                .filter(|n| !COMMON.contains(&n.as_str()))
                .collect();
            names.sort();
            (Kind::Declaration, names)
        }
    };
    Item {
        start: tokens.first().map_or(0, |t| t.start),
        end: tokens.last().map_or(0, |t| t.end),
        kind,
        defines,
        mentions: words(tokens),
    }
}

/// The names in a line of the preprocessor.
fn named_in(line: &str) -> Vec<String> {
    line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|w| is_word(w))
        .map(str::to_owned)
        .collect()
}

fn directive(text: &str, token: Token<'_>) -> Item {
    let names = named_in(token.text);
    let (kind, defines) = match names.first().map(String::as_str) {
        Some("define") => (Kind::Macro, names.get(1).cloned().into_iter().collect()),
        Some("version" | "extension" | "pragma" | "line") => (Kind::Addressed, Vec::new()),
        _ => (Kind::Directive, Vec::new()),
    };
    let is_asked = matches!(kind, Kind::Macro | Kind::Directive);
    let _ = text;
    Item {
        start: token.start,
        end: token.end,
        kind,
        defines,
        mentions: if is_asked {
            names.into_iter().skip(1).collect()
        } else {
            HashSet::new()
        },
    }
}

/// Words that declarations share without defining them.
const COMMON: [&str; 40] = [
    "const",
    "uniform",
    "varying",
    "in",
    "out",
    "inout",
    "highp",
    "mediump",
    "lowp",
    "float",
    "int",
    "uint",
    "bool",
    "vec2",
    "vec3",
    "vec4",
    "ivec2",
    "ivec3",
    "ivec4",
    "uvec2",
    "uvec3",
    "uvec4",
    "bvec2",
    "bvec3",
    "bvec4",
    "mat2",
    "mat3",
    "mat4",
    "struct",
    "void",
    "true",
    "false",
    "layout",
    "flat",
    "sampler2D",
    "samplerCube",
    "sampler3D",
    "buffer",
    "shared",
    "precise",
];

/// Words, numbers and signs; a directive with its continued lines is one token.
fn tokens(text: &str, range: std::ops::Range<usize>) -> Vec<Token<'_>> {
    let bytes = text.as_bytes();
    let (mut at, end) = (range.start, range.end.min(bytes.len()));
    let mut found = Vec::new();
    let mut line_begins = true;
    while at < end {
        let start = at;
        match bytes[at] {
            b'\n' => {
                line_begins = true;
                at += 1;
                continue;
            }
            b if b.is_ascii_whitespace() => {
                at += 1;
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                while at < end && bytes[at] != b'\n' {
                    at += 1;
                }
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'*') => {
                at += 2;
                while at < end && !(bytes[at] == b'*' && bytes.get(at + 1) == Some(&b'/')) {
                    at += 1;
                }
                at = (at + 2).min(end);
                continue;
            }
            b'#' if line_begins => {
                while at < end && bytes[at] != b'\n' {
                    let comment =
                        bytes[at] == b'/' && matches!(bytes.get(at + 1), Some(b'/' | b'*'));
                    if comment {
                        break;
                    }
                    let continued = bytes[at] == b'\\'
                        && (bytes.get(at + 1) == Some(&b'\n')
                            || bytes.get(at + 1..at + 3) == Some(b"\r\n"));
                    at += if continued { 2 } else { 1 };
                    if continued && bytes.get(at - 1) == Some(&b'\r') {
                        at += 1;
                    }
                }
                at = at.min(end);
            }
            b if b.is_ascii_alphabetic() || b == b'_' => {
                while at < end && (bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_') {
                    at += 1;
                }
            }
            b if b.is_ascii_digit() => {
                while at < end && (bytes[at].is_ascii_alphanumeric() || bytes[at] == b'.') {
                    at += 1;
                }
            }
            _ => {
                at += 1;
                while at < end && !text.is_char_boundary(at) {
                    at += 1;
                }
            }
        }
        line_begins = false;
        found.push(Token {
            start,
            end: at,
            text: &text[start..at],
        });
    }
    found
}
