//! Where in a JSON text values stand. Every question takes one pass over the text.

use super::JsonStep;
use std::ops::Range;

/// The bytes of the value at the end of a path, or of the last one on the way that is there. The text must be JSON.
pub(crate) fn locate(text: &str, path: &[JsonStep]) -> Range<usize> {
    let mut scanner = Scanner::new(text);
    scanner.space();
    for step in path {
        let outer = scanner.at;
        if !scanner.enter(step) {
            scanner.at = outer;
            break;
        }
    }
    scanner.value()
}

/// Where each item begins of the list that is a member of the outermost object.
pub(super) fn items(text: &str, key: &str) -> Vec<u32> {
    let mut scanner = Scanner::new(text);
    let mut starts = Vec::new();
    if !scanner.enter(&JsonStep::Key(key.to_string())) || scanner.peek() != b'[' {
        return starts;
    }
    scanner.at += 1;
    while scanner.has_more() {
        starts.push(scanner.at as u32);
        scanner.value();
    }
    starts
}

/// Members of the object that begins at a byte, in their order: the bytes of each key with its quotes, and of its value.
pub(crate) fn members(text: &str, at: usize) -> Vec<(Range<usize>, Range<usize>)> {
    let mut scanner = Scanner::new(text);
    scanner.at = at;
    let mut all = Vec::new();
    if scanner.peek() != b'{' {
        return all;
    }
    scanner.at += 1;
    while scanner.has_more() {
        let start = scanner.at;
        scanner.string();
        let key = start..scanner.at;
        scanner.space();
        scanner.at += 1;
        all.push((key, scanner.value()));
    }
    all
}

struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
}

impl Scanner<'_> {
    fn new(text: &str) -> Scanner<'_> {
        Scanner {
            text: text.as_bytes(),
            at: 0,
        }
    }

    fn peek(&self) -> u8 {
        self.text.get(self.at).copied().unwrap_or(0)
    }

    fn space(&mut self) {
        while self.peek().is_ascii_whitespace() {
            self.at += 1;
        }
    }

    /// Goes to the next item or member, if there is one.
    fn has_more(&mut self) -> bool {
        self.space();
        if self.peek() == b',' {
            self.at += 1;
            self.space();
        }
        !matches!(self.peek(), b']' | b'}' | 0)
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
        if self.at == start {
            // no value: what is not JSON is passed too
            self.at += 1;
        }
        let length = self.text.len();
        start.min(length)..self.at.min(length)
    }

    /// Passes a string and gives its bytes, quotes included.
    fn string(&mut self) -> &[u8] {
        let start = self.at;
        self.at += 1;
        while self.at < self.text.len() && self.peek() != b'"' {
            self.at += if self.peek() == b'\\' { 2 } else { 1 };
        }
        self.at = (self.at + 1).min(self.text.len());
        &self.text[start..self.at]
    }

    /// Goes to the beginning of a member of the value that begins here, if there is such a member.
    fn enter(&mut self, step: &JsonStep) -> bool {
        self.space();
        let open = match step {
            JsonStep::Key(_) => b'{',
            JsonStep::Index(_) => b'[',
        };
        if self.peek() != open {
            return false;
        }
        self.at += 1;
        let mut index = 0;
        while self.has_more() {
            let hit = match step {
                JsonStep::Key(wanted) => {
                    let name = self.string();
                    // most keys are plain, and need not be decoded to be told apart
                    let plain = name.len() == wanted.len() + 2
                        && &name[1..name.len() - 1] == wanted.as_bytes();
                    let hit = plain
                        || name.contains(&b'\\')
                            && serde_json::from_slice::<String>(name).is_ok_and(|n| n == *wanted);
                    self.space();
                    self.at += 1;
                    hit
                }
                JsonStep::Index(wanted) => index == *wanted,
            };
            self.space();
            if hit {
                return true;
            }
            self.value();
            index += 1;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(k: &str) -> JsonStep {
        JsonStep::Key(k.to_string())
    }

    #[test]
    fn finds_values() {
        let text = r#" {"a": [1, {"b\"": "x,]"}, 22], "c": -1.5e3 } "#;
        let at = |path: &[JsonStep]| &text[locate(text, path)];
        assert_eq!(at(&[key("c")]), "-1.5e3");
        assert_eq!(at(&[key("a"), JsonStep::Index(2)]), "22");
        assert_eq!(at(&[key("a"), JsonStep::Index(1), key("b\"")]), "\"x,]\"");
        assert_eq!(
            at(&[key("a"), JsonStep::Index(7)]),
            r#"[1, {"b\"": "x,]"}, 22]"#
        );
        assert_eq!(at(&[key("a"), JsonStep::Index(0), key("z")]), "1");
        assert_eq!(at(&[]), text.trim());
    }

    #[test]
    fn finds_items() {
        let text = r#" {"b": [7], "a" : [1, {"b": "x,]"},[[], 2] ,22 ], "c": 1} "#;
        let at = |key| {
            items(text, key)
                .iter()
                .map(|at| text.as_bytes()[*at as usize] as char)
                .collect::<String>()
        };
        assert_eq!(at("a"), "1{[2");
        assert_eq!((at("c"), at("d")), (String::new(), String::new()));
    }

    #[test]
    fn survives_what_is_not_json() {
        for text in [
            "",
            "{",
            "[1,",
            "\"",
            "{\"a\"",
            "{\"a\":",
            "]]]",
            "{\"\\",
            "{,,",
            "{\"a\":[,,",
        ] {
            let range = locate(text, &[JsonStep::Key("a".into()), JsonStep::Index(1)]);
            assert!(range.end <= text.len());
            items(text, "a");
        }
    }
}
