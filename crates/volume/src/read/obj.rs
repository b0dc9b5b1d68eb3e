//! Wavefront OBJ: vertices and polygons.

use super::{Soup, lines, number, shortened, text};
use crate::mesh::MeshError;

pub(super) fn read(bytes: &[u8], soup: &mut Soup) -> Result<(), MeshError> {
    let mut corners = Vec::new();
    // a line that ends in a backslash goes on in the next one
    let mut longer: Vec<u8> = Vec::new();
    for (at, line) in lines(bytes) {
        if let Some(part) = line.strip_suffix(b"\\") {
            longer.extend_from_slice(part);
            longer.push(b' ');
            continue;
        }
        if longer.is_empty() {
            statement(line, at, soup, &mut corners)?;
        } else {
            longer.extend_from_slice(line);
            let whole = std::mem::take(&mut longer);
            statement(&whole, at, soup, &mut corners)?;
        }
    }
    statement(&longer, bytes.len(), soup, &mut corners)
}

fn statement(
    line: &[u8],
    at: usize,
    soup: &mut Soup,
    corners: &mut Vec<i64>,
) -> Result<(), MeshError> {
    // what is not read may be anything: names of materials are not always UTF-8
    let is =
        |word: &[u8]| line.starts_with(word) && line.get(1).is_some_and(u8::is_ascii_whitespace);
    if is(b"v") {
        let mut words = text(at, line)?.split_ascii_whitespace().skip(1);
        let mut next = || number(words.next(), at);
        let point = [next()?, next()?, next()?];
        return soup.point(point);
    }
    if !is(b"f") {
        return Ok(());
    }
    corners.clear();
    for word in text(at, line)?.split_ascii_whitespace().skip(1) {
        // only comments may follow
        if word.starts_with('#') {
            break;
        }
        let first = word.split('/').next().unwrap_or_default();
        let vertex = match first.parse::<i64>() {
            Ok(n) if n > 0 => n - 1,
            // counted back from the last one
            Ok(n) if n < 0 => (soup.points.len() as i64).saturating_add(n),
            _ => {
                return Err(MeshError::Line {
                    line: at,
                    reason: format!("\"{}\" is no corner of a face", shortened(word)),
                });
            }
        };
        corners.push(vertex);
    }
    soup.polygon(corners)
}
