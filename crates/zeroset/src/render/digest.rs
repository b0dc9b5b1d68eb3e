//! Digests, which tell scenes apart.

use std::fs::File;
use std::io::{self, Read};
use std::path::PathBuf;

/// The 64-bit hash of Fowler, Noll and Vo (1991, FNV-1a): it tells scenes apart, not enemies.
pub(super) struct Digest(u64);

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

impl Digest {
    pub(super) fn new() -> Digest {
        Digest(0xcbf2_9ce4_8422_2325)
    }

    pub(super) fn add(&mut self, bytes: &[u8]) {
        // lengths too, so that parts cannot flow into each other
        self.take(&(bytes.len() as u64).to_le_bytes());
        self.take(bytes);
    }

    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// In hexadecimal digits.
    pub(super) fn written(&self) -> String {
        format!("{:016x}", self.0)
    }
}

/// A digest of the contents of files, in their order; their names and places have no part in it.
pub(crate) fn of_files(files: &[PathBuf]) -> String {
    let mut digest = Digest::new();
    for file in files {
        let mut length = 0;
        let mut read = || -> io::Result<()> {
            let (mut file, mut bytes) = (File::open(file)?, vec![0; PIECE]);
            loop {
                match file.read(&mut bytes)? {
                    0 => return Ok(()),
                    count => {
                        length += count as u64;
                        digest.take(&bytes[..count]);
                    }
                }
            }
        };
        // what a scene asked for and cannot be read is no part of it
        let _ = read();
        digest.take(&length.to_le_bytes());
    }
    digest.written()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published hash of "foobar".
    #[test]
    fn digests_are_those_of_the_paper() {
        let mut plain = Digest::new();
        plain.take(b"foobar");
        assert_eq!(plain.written(), "85944171f73967e8");
        let of = |parts: &[&str]| {
            let mut digest = Digest::new();
            parts.iter().for_each(|part| digest.add(part.as_bytes()));
            digest.0
        };
        assert_ne!(of(&["ab", "c"]), of(&["a", "bc"]));
    }

    #[test]
    fn files_count_by_what_is_in_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for (name, text) in [
            ("a", "ab"),
            ("b", "c"),
            ("c", "a"),
            ("d", "bc"),
            ("e", "ab"),
        ] {
            std::fs::write(path(name), text).unwrap();
        }
        let of = |names: &[&str]| of_files(&names.iter().map(|n| path(n)).collect::<Vec<_>>());
        assert_eq!(of(&["a", "b"]), of(&["e", "b"]));
        let others: [&[&str]; 4] = [&["c", "d"], &["b", "a"], &["a"], &["a", "b", "none"]];
        for other in others {
            assert_ne!(of(&["a", "b"]), of(other), "{other:?}");
        }
    }
}
