//! The attributes in the header of an OpenEXR file, in the order of their names.
//!
//! The encoder keeps them in a hash table, whose order differs from process to process. Equal pictures are to become equal
//! files, so the header is put in order on its way to the file. Its length stays, and so does what points behind it.

use std::io::{self, Seek, SeekFrom, Write};

/// Bytes before the first attribute: the magic number and the version.
const PREAMBLE: usize = 8;

/// Passes the file of one part on, its header in order.
pub(super) struct Sorted<W> {
    writer: W,
    /// What was written, as long as the header is not complete.
    header: Option<Vec<u8>>,
}

impl<W: Write> Sorted<W> {
    pub(super) fn new(writer: W) -> Sorted<W> {
        Sorted {
            writer,
            header: Some(Vec::new()),
        }
    }
}

impl<W: Write> Write for Sorted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(header) = &mut self.header else {
            return self.writer.write(bytes);
        };
        header.extend_from_slice(bytes);
        if let Some(sorted) = sorted(header) {
            self.header = None;
            self.writer.write_all(&sorted)?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl<W: Write + Seek> Seek for Sorted<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        // no header that this knows: it is passed on as it is
        if let Some(header) = self.header.take() {
            self.writer.write_all(&header)?;
        }
        self.writer.seek(to)
    }
}

/// What was written with the attributes in order, once all of them are there.
fn sorted(bytes: &[u8]) -> Option<Vec<u8>> {
    let (mut attributes, mut at) = (Vec::new(), PREAMBLE);
    while *bytes.get(at)? != 0 {
        let from = at;
        for _ in 0..2 {
            // the name, and the name of the type
            at += bytes[at..].iter().position(|b| *b == 0)? + 1;
            bytes.get(at)?;
        }
        let size = bytes.get(at..at + 4)?.try_into().ok()?;
        at = at
            .checked_add(4)?
            .checked_add(u32::from_le_bytes(size) as usize)?;
        attributes.push(bytes.get(from..at)?);
    }
    // no two have the same name
    attributes.sort_unstable();
    let mut out = Vec::with_capacity(bytes.len());
    out.extend_from_slice(&bytes[..PREAMBLE]);
    out.extend(attributes.into_iter().flatten());
    out.extend_from_slice(&bytes[at..]);
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_order_changes_however_it_is_written() {
        let attribute = |name: &str, value: &[u8]| {
            let mut out = [name.as_bytes(), b"\0string\0"].concat();
            out.extend((value.len() as u32).to_le_bytes());
            out.extend(value);
            out
        };
        let (a, b, c) = (
            attribute("a", b"\0\0b"),
            attribute("bb", b""),
            attribute("c", b"xyz"),
        );
        let file =
            |order: [&[u8]; 3]| [b"8 bytes.", order.concat().as_slice(), b"\0pixels"].concat();
        let right = file([&a, &b, &c]);
        for order in [[&a, &b, &c], [&c, &b, &a], [&b, &c, &a]] {
            let file = file(order.map(Vec::as_slice));
            for piece in [1, 2, 7, 1000] {
                let mut out = Sorted::new(Vec::new());
                for bytes in file.chunks(piece) {
                    out.write_all(bytes).unwrap();
                }
                assert!(out.writer == right, "{piece}");
            }
        }
    }

    #[test]
    fn what_is_no_header_is_passed_on() {
        let mut out = Sorted::new(io::Cursor::new(Vec::new()));
        out.write_all(b"8 bytes.name without an end").unwrap();
        out.seek(SeekFrom::Start(2)).unwrap();
        out.write_all(b"BYTES").unwrap();
        assert_eq!(out.writer.into_inner(), b"8 BYTES.name without an end");
    }
}
