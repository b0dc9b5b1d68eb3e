//! STL: triangles, as text or binary.

use super::{Soup, lines, number, text};
use crate::mesh::MeshError;

/// Bytes before the first triangle of a binary file: a comment of 80 and their number.
const HEAD: usize = 84;
/// Bytes of a triangle: a normal, three corners, two bytes of whatever.
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8], soup: &mut Soup) -> Result<(), MeshError> {
    let count = bytes
        .get(80..HEAD)
        .and_then(|b| b.try_into().ok())
        .map(|b| u64::from(u32::from_le_bytes(b)));
    let wanted = |n: u64| n * TRIANGLE as u64 + HEAD as u64;
    let length = bytes.len() as u64;
    // binary files may begin with "solid" too: what tells is the length
    match count {
        Some(n) if wanted(n) == length => binary(bytes, n, soup),
        _ if bytes.trim_ascii_start().starts_with(b"solid") => ascii(bytes, soup),
        Some(n) if wanted(n) < length => binary(bytes, n, soup),
        Some(n) => Err(MeshError::Cut(format!(
            "its {n} triangles of {TRIANGLE} bytes, {} bytes in all",
            length - HEAD as u64
        ))),
        None => Err(MeshError::Byte {
            at: 0,
            reason:
                "it begins neither like a text (`solid`) nor is it long enough for a binary STL"
                    .into(),
        }),
    }
}

fn binary(bytes: &[u8], count: u64, soup: &mut Soup) -> Result<(), MeshError> {
    soup.check_faces(count)?;
    soup.check_points(3 * count)?;
    for triangle in bytes[HEAD..].chunks_exact(TRIANGLE).take(count as usize) {
        let first = soup.points.len() as i64;
        for corner in triangle[12..48].chunks_exact(12) {
            let mut point = [0.0; 3];
            for (x, b) in point.iter_mut().zip(corner.chunks_exact(4)) {
                *x = f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            }
            soup.point(point)?;
        }
        soup.polygon(&[first, first + 1, first + 2])?;
    }
    Ok(())
}

fn ascii(bytes: &[u8], soup: &mut Soup) -> Result<(), MeshError> {
    let mut within = 0;
    let mut last = 0;
    for (at, line) in lines(bytes) {
        last = at;
        if line.starts_with(b"outer") {
            within = 0;
        }
        if !line.starts_with(b"vertex") {
            continue;
        }
        let mut words = text(at, line)?.split_ascii_whitespace().skip(1);
        let mut next = || number(words.next(), at);
        let point = [next()?, next()?, next()?];
        soup.point(point)?;
        within += 1;
        match within {
            1 | 2 => {}
            3 => {
                let end = soup.points.len() as i64;
                soup.polygon(&[end - 3, end - 2, end - 1])?;
            }
            _ => {
                return Err(MeshError::Line {
                    line: at,
                    reason: "a facet with more than three corners".into(),
                });
            }
        }
    }
    if !matches!(within, 0 | 3) {
        return Err(MeshError::Cut(format!("a facet, in line {last}")));
    }
    Ok(())
}
