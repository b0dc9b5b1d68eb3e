//! Where in a JSON text a value stands.

use super::Step;
use std::ops::Range;

/// The bytes of the value at the end of a path, or of the last one on the way that is there. The text must be JSON.
pub(super) fn locate(text: &str, path: &[Step]) -> Range<usize> {
    let mut scanner = Scanner {
        text: text.as_bytes(),
        at: 0,
    };
    let mut found = scanner.clone().value();
    for step in path {
        match scanner.enter(step) {
            Some(range) => found = range,
            None => break,
        }
    }
    found
}

#[derive(Clone)]
struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
}

impl Scanner<'_> {
    fn peek(&self) -> u8 {
        self.text.get(self.at).copied().unwrap_or(0)
    }

    fn space(&mut self) {
        while self.peek().is_ascii_whitespace() {
            self.at += 1;
        }
    }

    /// Passes a value and gives its bytes.
    fn value(&mut self) -> Range<usize> {
        self.space();
        let start = self.at;
        let mut depth = 0;
        while self.at < self.text.len() {
            match self.peek() {
                b'"' => {
                    self.string();
                    if depth == 0 {
                        break;
                    }
                    continue;
                }
                b'[' | b'{' => depth += 1,
                b']' | b'}' if depth == 0 => break,
                b']' | b'}' => {
                    depth -= 1;
                    if depth == 0 {
                        self.at += 1;
                        break;
                    }
                }
                b',' | b':' if depth == 0 => break,
                c if depth == 0 && c.is_ascii_whitespace() => break,
                _ => {}
            }
            self.at += 1;
        }
        let length = self.text.len();
        start.min(length)..self.at.min(length)
    }

    /// Passes a string and gives what it says.
    fn string(&mut self) -> String {
        let start = self.at;
        self.at += 1;
        while self.at < self.text.len() && self.peek() != b'"' {
            self.at += if self.peek() == b'\\' { 2 } else { 1 };
        }
        self.at = (self.at + 1).min(self.text.len());
        serde_json::from_slice(&self.text[start..self.at]).unwrap_or_default()
    }

    /// Goes to a member of the value that begins here and gives its bytes; the scanner then stands at its beginning.
    fn enter(&mut self, step: &Step) -> Option<Range<usize>> {
        self.space();
        let open = self.peek();
        if open
            != if matches!(step, Step::Key(_)) {
                b'{'
            } else {
                b'['
            }
        {
            return None;
        }
        self.at += 1;
        let mut index = 0;
        loop {
            self.space();
            if matches!(self.peek(), b']' | b'}' | 0) {
                return None;
            }
            let hit = match step {
                Step::Key(wanted) => {
                    let name = self.string();
                    self.space();
                    self.at += 1;
                    name == *wanted
                }
                Step::Index(wanted) => index == *wanted,
            };
            self.space();
            let start = self.at;
            let range = self.value();
            if hit {
                self.at = start;
                return Some(range);
            }
            self.space();
            if self.peek() == b',' {
                self.at += 1;
            }
            index += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_values() {
        let text = r#" {"a": [1, {"b\"": "x,]"}, 22], "c": -1.5e3 } "#;
        let at = |path: &[Step]| &text[locate(text, path)];
        let key = |k: &str| Step::Key(k.to_string());
        assert_eq!(at(&[key("c")]), "-1.5e3");
        assert_eq!(at(&[key("a"), Step::Index(2)]), "22");
        assert_eq!(at(&[key("a"), Step::Index(1), key("b\"")]), "\"x,]\"");
        assert_eq!(
            at(&[key("a"), Step::Index(7)]),
            r#"[1, {"b\"": "x,]"}, 22]"#
        );
        assert_eq!(at(&[key("a"), Step::Index(0), key("z")]), "1");
        assert_eq!(at(&[]), text.trim());
    }

    #[test]
    fn survives_what_is_not_json() {
        for text in ["", "{", "[1,", "\"", "{\"a\"", "{\"a\":", "]]]", "{\"\\"] {
            let range = locate(text, &[Step::Key("a".into()), Step::Index(1)]);
            assert!(range.end <= text.len());
        }
    }
}
