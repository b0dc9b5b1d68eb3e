//! Texts of strangers, fit to be shown.
//!
//! A scene, its names, and what it prints may come from anybody. A terminal obeys some characters instead of showing them
//! (ECMA-48: escape sequences set its title, move the cursor, write its clipboard), some turn the order of what follows
//! (Unicode's bidirectional controls), some are not seen at all, and a text may be as long as a file. So nothing is shown
//! before it has been through here.

use std::borrow::Cow;

/// Most characters of a line that is shown.
pub const LINE: usize = 1000;
/// Most lines of a text that is shown.
pub const LINES: usize = 1000;
/// Most characters of a name in a list, a title or a button.
pub const NAME: usize = 60;

/// Whether a character does something else than to show itself or to move on by a space or a line: the controls C0 (but
/// tab and line feed), DEL and C1, separators of lines and paragraphs, directions, formats that are not seen, tags.
/// Joiners stay: scripts and emoji need them.
pub const fn is_control(c: char) -> bool {
    matches!(
        c,
        '\0'..='\u{8}'
            | '\u{b}'..='\u{1f}'
            | '\u{7f}'..='\u{9f}'
            | '\u{ad}'
            | '\u{61c}'
            | '\u{180e}'
            | '\u{200b}'
            | '\u{200e}'
            | '\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
            | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e0fff}'
    )
}

/// A text with its controls written out, as `\u{1b}`. Line feeds and tabs stay; a carriage return before a line feed goes.
pub fn clean(text: &str) -> Cow<'_, str> {
    if !text.contains(is_control) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\r' if rest.peek() == Some(&'\n') => {}
            '\r' => out.push_str("\\r"),
            c if is_control(c) => out.extend(c.escape_unicode()),
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}

/// A text of at most about `most` characters: its beginning and its end, and how much is left out between them.
pub fn clip(text: &str, most: usize) -> Cow<'_, str> {
    // every character has a byte: most texts need not be counted
    if text.len() <= most {
        return Cow::Borrowed(text);
    }
    let count = text.chars().count();
    if count <= most {
        return Cow::Borrowed(text);
    }
    let (head, tail) = (most - most / 3, most / 3);
    let at = |n: usize| text.char_indices().nth(n).map_or(text.len(), |(i, _)| i);
    Cow::Owned(format!(
        "{}…({} characters left out)…{}",
        &text[..at(head)],
        count - head - tail,
        &text[at(count - tail)..]
    ))
}

/// A text of several lines as it is shown: clean, no line longer than [`LINE`], not more than [`LINES`].
pub fn text(from: &str) -> Cow<'_, str> {
    let cleaned = clean(from);
    let lines = cleaned.split_inclusive('\n');
    if cleaned.len() <= LINE || (lines.clone().all(|l| l.len() <= LINE) && lines.count() <= LINES) {
        return cleaned;
    }
    let all = cleaned.split_inclusive('\n').count();
    let mut out = String::new();
    for line in cleaned.split_inclusive('\n').take(LINES) {
        let (line, end) = line.strip_suffix('\n').map_or((line, ""), |l| (l, "\n"));
        out += &clip(line, LINE);
        out += end;
    }
    if all > LINES {
        out += &format!("…({} lines left out)", all - LINES);
    }
    Cow::Owned(out)
}

/// A name as it is shown: clean, in one line, not longer than `most` characters.
pub fn name(from: &str, most: usize) -> String {
    // clipped first: what is left out need not be cleaned
    let clipped = clip(from, most);
    let cleaned = clean(&clipped);
    cleaned.replace('\n', "\\n").replace('\t', " ")
}

/// JSON with its controls as escapes, which mean the same: some writers of JSON only escape C0.
pub fn json(written: &str) -> Cow<'_, str> {
    // those outside of strings are only spaces, tabs and line feeds
    if !written.contains(is_control) {
        return Cow::Borrowed(written);
    }
    let mut out = String::with_capacity(written.len() + 16);
    for c in written.chars() {
        if is_control(c) {
            for unit in c.encode_utf16(&mut [0; 2]) {
                out += &format!("\\u{unit:04x}");
            }
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Source text of the same length with its controls blotted out, so that places in it stay what they are.
pub fn blot(text: &str) -> Cow<'_, str> {
    if !text.contains(is_control) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match (is_control(c), c.len_utf8()) {
            (false, _) => out.push(c),
            // the end of a line, as some systems write it
            _ if c == '\r' && rest.peek() == Some(&'\n') => out.push(' '),
            (true, 1) => out.push('?'),
            (true, 2) => out.push_str("??"),
            (true, 3) => out.push(char::REPLACEMENT_CHARACTER),
            (true, _) => {
                out.push('?');
                out.push(char::REPLACEMENT_CHARACTER);
            }
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_a_terminal_obeys_is_written_out() {
        for (from, right) in [
            (
                "plain ü 東京 👩\u{200d}🚀\n\tnext",
                "plain ü 東京 👩\u{200d}🚀\n\tnext",
            ),
            ("\u{1b}]0;title\u{7}", "\\u{1b}]0;title\\u{7}"),
            ("\u{9b}31m", "\\u{9b}31m"),
            ("a\rb\r\nc\r", "a\\rb\nc\\r"),
            ("\u{7f}\u{0}\u{8}", "\\u{7f}\\u{0}\\u{8}"),
            ("x\u{202e}gnp.\u{2066}", "x\\u{202e}gnp.\\u{2066}"),
            ("\u{feff}\u{e0041}", "\\u{feff}\\u{e0041}"),
        ] {
            assert_eq!(clean(from), right);
        }
    }

    #[test]
    fn long_texts_keep_their_ends() {
        assert_eq!(clip("größe", 5), "größe");
        let long = format!("a{}z", "ö".repeat(1_000_000));
        let short = clip(&long, 30);
        assert!(short.starts_with("aö") && short.ends_with("öz") && short.chars().count() < 80);
        assert!(short.contains("999972 characters"), "{short}");
        let many = "line\n".repeat(5000);
        assert_eq!(text(&many).lines().count(), LINES + 1);
        assert!(text(&many).ends_with("…(4000 lines left out)"));
        let wide = format!("first\n{long}\nlast");
        assert!(text(&wide).len() < 4000 && text(&wide).ends_with("\nlast"));
        assert_eq!(name("two\nlines", 20), "two\\nlines");
    }

    proptest! {
        #[test]
        fn nothing_gets_through(from in any::<String>(), most in 1usize..50) {
            for shown in [clean(&from).into_owned(), text(&from).into_owned(), name(&from, most), blot(&from).into_owned()] {
                prop_assert!(!shown.contains(is_control), "{shown:?}");
            }
            prop_assert_eq!(blot(&from).len(), from.len());
            prop_assert!(clip(&from, most).chars().count() < most + 40);
        }

        #[test]
        fn json_means_the_same(from in any::<String>(), c in proptest::sample::select(vec!['\u{1b}', '\u{9b}', '\u{7f}', '\u{202e}', '\u{e0041}', '"'])) {
            let value = format!("{from}{c}{from}");
            // as a writer does that escapes what JSON asks for and nothing else
            let mut written = String::from("\"");
            for c in value.chars() {
                match c {
                    '"' | '\\' => written.extend(['\\', c]),
                    '\0'..='\u{1f}' => written += &format!("\\u{:04x}", u32::from(c)),
                    c => written.push(c),
                }
            }
            written.push('"');
            let escaped = json(&written);
            prop_assert!(!escaped.contains(is_control));
            let mut units = Vec::new();
            let mut rest = escaped[1..escaped.len() - 1].chars();
            while let Some(c) = rest.next() {
                match c {
                    '\\' => match rest.next() {
                        Some('u') => {
                            let digits: String = rest.by_ref().take(4).collect();
                            units.push(u16::from_str_radix(&digits, 16).unwrap());
                        }
                        Some(c) => units.push(c as u16),
                        None => panic!(),
                    },
                    c => units.extend(c.encode_utf16(&mut [0; 2]).iter()),
                }
            }
            prop_assert_eq!(String::from_utf16(&units).unwrap(), value);
        }
    }
}
