//! ZIP archives, as far as 3MF needs them: files that are packed by DEFLATE, all below 4 GiB (PKWARE, APPNOTE 6.3).

use super::{TooLarge, fits};
use miniz_oxide::deflate::compress_to_vec;

/// How hard is tried, 0 to 10.
const LEVEL: u8 = 6;
/// Packed by DEFLATE.
const METHOD: u16 = 8;
/// The version of ZIP that reads this.
const VERSION: u16 = 20;
/// The first of January 1980, the first day that there is: the same mesh gives the same bytes.
const DAY: u16 = 1 << 5 | 1;

/// An archive of named files.
pub(super) fn archive(files: &[(&str, Vec<u8>)]) -> Result<Vec<u8>, TooLarge> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let packed = compress_to_vec(bytes, LEVEL);
        let mut about = Vec::new();
        for word in [VERSION, 0, METHOD, 0, DAY] {
            about.extend(word.to_le_bytes());
        }
        about.extend(crc32fast::hash(bytes).to_le_bytes());
        about.extend(fits("bytes", packed.len())?.to_le_bytes());
        about.extend(fits("bytes", bytes.len())?.to_le_bytes());
        about.extend((name.len() as u16).to_le_bytes());
        about.extend([0, 0]);
        directory.extend(b"PK\x01\x02");
        directory.extend(VERSION.to_le_bytes());
        directory.extend(&about);
        // no comment, the first disk, no attributes
        directory.extend([0; 10]);
        directory.extend(fits("bytes", out.len())?.to_le_bytes());
        directory.extend(name.as_bytes());
        out.extend(b"PK\x03\x04");
        out.extend(&about);
        out.extend(name.as_bytes());
        out.extend(packed);
    }
    let (begin, length, count) = (out.len(), directory.len(), files.len() as u16);
    out.extend(directory);
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend(count.to_le_bytes());
    out.extend(count.to_le_bytes());
    out.extend(fits("bytes", length)?.to_le_bytes());
    out.extend(fits("bytes", begin)?.to_le_bytes());
    out.extend([0, 0]);
    Ok(out)
}
