//! Lines and columns of a text, without reading it again for each place.

/// Bytes between two counts of characters.
const BLOCK: usize = 1024;

/// Where lines begin in a text, and how many characters stand before each block of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Lines {
    starts: Vec<u32>,
    characters: Vec<u32>,
}

impl Lines {
    pub(crate) fn of(text: &str) -> Lines {
        let ends = text.bytes().zip(1..).filter(|(b, _)| *b == b'\n');
        let starts = std::iter::once(0).chain(ends.map(|(_, next)| next));
        let mut before = 0;
        let blocks = text.as_bytes().chunks(BLOCK).map(|block| {
            let so_far = before;
            before += begun(block) as u32;
            so_far
        });
        let mut characters: Vec<u32> = blocks.collect();
        // a place may be the end of a text that fills its blocks
        characters.push(before);
        Lines {
            starts: starts.collect(),
            characters,
        }
    }

    /// Line and column of a byte, 1-based; the column counts characters. The text is the one that this was made of.
    pub(crate) fn position(&self, text: &str, at: usize) -> (usize, usize) {
        let at = at.min(text.len());
        let line = self.starts.partition_point(|start| *start as usize <= at);
        let start = self
            .starts
            .get(line.wrapping_sub(1))
            .map_or(0, |s| *s as usize);
        (line, self.before(text, at) - self.before(text, start) + 1)
    }

    /// Characters that begin before a byte.
    fn before(&self, text: &str, at: usize) -> usize {
        let block = at / BLOCK;
        let known = self.characters.get(block).map_or(0, |n| *n as usize);
        known + begun(&text.as_bytes()[block * BLOCK..at])
    }
}

/// Characters that begin in a piece of UTF-8.
fn begun(bytes: &[u8]) -> usize {
    bytes.iter().filter(|b| **b & 0xc0 != 0x80).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the definition says it.
    fn slowly(text: &str, at: usize) -> (usize, usize) {
        let before = &text[..at];
        let start = before.rfind('\n').map_or(0, |i| i + 1);
        (
            before.matches('\n').count() + 1,
            before[start..].chars().count() + 1,
        )
    }

    #[test]
    fn every_place_of_every_text() {
        let long = "é".repeat(1500) + "\n" + &"ab\n".repeat(500) + &"𝄞x".repeat(700);
        let full = "a".repeat(2 * BLOCK);
        for text in [
            "",
            "\n",
            "a",
            "a\nbé\n\nc",
            "\n\n",
            "ü\u{feff}\r\nx",
            &long,
            &full,
        ] {
            let lines = Lines::of(text);
            for at in (0..=text.len()).filter(|at| text.is_char_boundary(*at)) {
                assert_eq!(
                    lines.position(text, at),
                    slowly(text, at),
                    "{at} of {} bytes",
                    text.len()
                );
            }
        }
    }
}
