//! glTF 2.0 and GLB: the triangles of a scene at the places of its nodes.
//!
//! The crate `gltf` reads and checks the JSON. Bytes of buffers are read here, since its own readers take the ranges that a file
//! states for granted.

use super::{Beside, Soup, shortened};
use crate::mesh::{MeshError, v};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Node, Primitive, Semantic};

/// Nodes inside each other.
const DEEP: usize = 256;

pub(super) fn read(bytes: &[u8], soup: &mut Soup, beside: Beside<'_>) -> Result<(), MeshError> {
    let (json, bin) = if bytes.starts_with(b"glTF") {
        chunks(bytes)?
    } else {
        (bytes, None)
    };
    let unreadable = |e: &dyn std::fmt::Display| {
        MeshError::Unsupported(format!(
            "it is no glTF that can be read: {}",
            clean(&e.to_string())
        ))
    };
    let root: gltf::json::Root =
        gltf::json::deserialize::from_slice(json).map_err(|e| unreadable(&e))?;
    // gltf-json looks an accessor up before it checks that there is one
    let count = root.accessors.len();
    let primitives = root.meshes.iter().flat_map(|m| &m.primitives);
    let mut used = primitives.flat_map(|p| p.attributes.values());
    if used.any(|accessor| accessor.value() >= count) {
        return Err(unreadable(
            &"an attribute has an accessor that is not there",
        ));
    }
    let document = Document::from_json(root).map_err(|e| unreadable(&e))?;
    let needed: Vec<&str> = (document.extensions_required())
        .filter(|name| name.contains("compression") || name.contains("quantization"))
        .collect();
    if !needed.is_empty() {
        return Err(MeshError::Unsupported(format!(
            "its vertices are packed by {}, which is not read: export it without",
            shortened(&needed.join(", "))
        )));
    }
    let mut reader = Reader {
        buffers: vec![None; document.buffers().len()],
        bin,
        beside,
        soup,
        seen: vec![false; document.nodes().len()],
    };
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    match scene {
        Some(scene) => {
            for node in scene.nodes() {
                reader.node(&node, IDENTITY, 0)?;
            }
        }
        None => {
            for primitive in document.meshes().flat_map(|m| m.primitives()) {
                reader.primitive(&primitive, IDENTITY)?;
            }
        }
    }
    Ok(())
}

/// The JSON and the bytes of a binary file.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), MeshError> {
    let word = |at: usize| {
        (bytes.get(at..at + 4))
            .and_then(|b| b.try_into().ok())
            .map(u32::from_le_bytes)
    };
    if word(4) != Some(2) {
        return Err(MeshError::Unsupported(
            "only version 2 of glTF is read".into(),
        ));
    }
    let (mut json, mut bin) = (None, None);
    let mut at = 12;
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let chunk = (at + 8)
            .checked_add(length as usize)
            .and_then(|end| bytes.get(at + 8..end));
        let chunk = chunk.ok_or_else(|| MeshError::Cut(format!("the chunk at byte {at}")))?;
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if bin.is_none() => bin = Some(chunk),
            _ => {}
        }
        at += 8 + length as usize;
    }
    let json = json.ok_or_else(|| MeshError::Cut("its first chunk, the JSON".into()))?;
    Ok((json, bin))
}

fn clean(text: &str) -> String {
    text.chars().take(200).map(super::shown).collect()
}

/// Columns of a motion.
type Motion = [[f64; 4]; 4];
const IDENTITY: Motion = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

fn after(a: &Motion, b: &Motion) -> Motion {
    std::array::from_fn(|c| std::array::from_fn(|r| (0..4).map(|k| a[k][r] * b[c][k]).sum()))
}

struct Reader<'a, 'b> {
    buffers: Vec<Option<Vec<u8>>>,
    bin: Option<&'a [u8]>,
    beside: Beside<'b>,
    soup: &'a mut Soup,
    seen: Vec<bool>,
}

impl Reader<'_, '_> {
    fn node(&mut self, node: &Node<'_>, above: Motion, depth: usize) -> Result<(), MeshError> {
        // nodes are trees: each has one parent
        if std::mem::replace(&mut self.seen[node.index()], true) || depth > DEEP {
            return Err(MeshError::Unsupported(format!(
                "its node {} stands in several places, or more than {DEEP} deep",
                node.index()
            )));
        }
        let own = node.transform().matrix().map(|c| c.map(f64::from));
        let motion = after(&above, &own);
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                self.primitive(&primitive, motion)?;
            }
        }
        for child in node.children() {
            self.node(&child, motion, depth + 1)?;
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive<'_>, m: Motion) -> Result<(), MeshError> {
        let mode = primitive.mode();
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            return Ok(());
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Ok(());
        };
        if (positions.data_type(), positions.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err(MeshError::Unsupported(
                "its positions are no three numbers of 32 bits".into(),
            ));
        }
        let first = self.soup.points.len() as i64;
        self.soup.check_points(positions.count() as u64)?;
        let mut points = Vec::new();
        self.values(&positions, |b| {
            let x = |k: usize| f64::from(f32::from_le_bytes([b[k], b[k + 1], b[k + 2], b[k + 3]]));
            let (x, y, z) = (x(0), x(4), x(8));
            points.push(std::array::from_fn(|r| {
                (m[0][r] * x + m[1][r] * y + m[2][r] * z + m[3][r]) as f32
            }));
        })?;
        for point in points {
            self.soup.point(point)?;
        }
        let corners: Vec<i64> = match primitive.indices() {
            None => (0..positions.count() as i64).collect(),
            Some(indices) => {
                self.soup.check_faces(indices.count() as u64 / 3)?;
                let mut corners = Vec::new();
                let kind = indices.data_type();
                if indices.dimensions() != Dimensions::Scalar {
                    return Err(MeshError::Unsupported(
                        "its indices are no whole numbers".into(),
                    ));
                }
                self.values(&indices, |b| {
                    corners.push(match kind {
                        DataType::U8 | DataType::I8 => b[0].into(),
                        DataType::U16 | DataType::I16 => u16::from_le_bytes([b[0], b[1]]).into(),
                        _ => u32::from_le_bytes([b[0], b[1], b[2], b[3]]).into(),
                    });
                })?;
                corners
            }
        };
        let axis = |c: usize| [m[c][0], m[c][1], m[c][2]];
        // a mirror turns faces around
        let mirrored = v::dot(axis(0), v::cross(axis(1), axis(2))) < 0.0;
        let mut face = |a: i64, b: i64, c: i64| {
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            self.soup.polygon(&[first + a, first + b, first + c])
        };
        match mode {
            Mode::TriangleStrip => {
                for (i, t) in corners.windows(3).enumerate() {
                    if i % 2 == 0 {
                        face(t[0], t[1], t[2])?;
                    } else {
                        face(t[1], t[0], t[2])?;
                    }
                }
            }
            Mode::TriangleFan => {
                for t in corners.get(1..).unwrap_or_default().windows(2) {
                    face(corners[0], t[0], t[1])?;
                }
            }
            _ => {
                for t in corners.chunks_exact(3) {
                    face(t[0], t[1], t[2])?;
                }
            }
        }
        Ok(())
    }

    /// Hands the bytes of each value of an accessor over.
    fn values(
        &mut self,
        accessor: &Accessor<'_>,
        mut take: impl FnMut(&[u8]),
    ) -> Result<(), MeshError> {
        let number = accessor.index();
        let bad = |reason: &str| MeshError::Unsupported(format!("its accessor {number} {reason}"));
        if accessor.sparse().is_some() {
            return Err(bad("is sparse, which is not read"));
        }
        let view = accessor.view().ok_or_else(|| bad("has no bytes"))?;
        let buffer = view.buffer();
        let at = buffer.index();
        if self.buffers[at].is_none() && !matches!(buffer.source(), gltf::buffer::Source::Bin) {
            self.buffers[at] = Some(self.fetch(&buffer)?);
        }
        let bytes = match &self.buffers[at] {
            Some(bytes) => bytes,
            None => (self.bin)
                .ok_or_else(|| MeshError::Cut("its binary chunk, which is missing".into()))?,
        };
        let bytes = (view.offset().checked_add(view.length()))
            .and_then(|end| bytes.get(view.offset()..end))
            .ok_or_else(|| bad("lies beyond its buffer"))?;
        let size = accessor.size();
        let stride = view.stride().unwrap_or(size).max(1);
        let count = accessor.count();
        let end = (count.saturating_sub(1))
            .checked_mul(stride)
            .and_then(|n| n.checked_add(accessor.offset()))
            .and_then(|n| n.checked_add(size));
        if end.is_none_or(|end| end > bytes.len()) {
            return Err(bad("lies beyond its buffer"));
        }
        for i in 0..count {
            let from = accessor.offset() + i * stride;
            take(&bytes[from..from + size]);
        }
        Ok(())
    }

    fn fetch(&mut self, buffer: &gltf::Buffer<'_>) -> Result<Vec<u8>, MeshError> {
        let gltf::buffer::Source::Uri(uri) = buffer.source() else {
            return Ok(Vec::new());
        };
        let refers = |reason: String| MeshError::Reference {
            name: shortened(uri),
            reason,
        };
        match uri.strip_prefix("data:") {
            Some(data) => {
                let (kind, data) = data.split_once(',').unwrap_or_default();
                if !kind.ends_with(";base64") {
                    return Err(refers("data within a file must be base64".into()));
                }
                base64(data).ok_or_else(|| refers("it is no base64".into()))
            }
            None => {
                let name = unescaped(uri).ok_or_else(|| refers("its name is no text".into()))?;
                (self.beside)(&name).map_err(refers)
            }
        }
    }
}

/// Bytes from base64 (RFC 4648), with or without `=` at its end.
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0_u32, 0);
    for c in text.trim_end_matches('=').bytes() {
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            out.push((bits >> held) as u8);
        }
    }
    Some(out)
}

/// A name with its `%20` and the like as what they stand for (RFC 3986).
fn unescaped(uri: &str) -> Option<String> {
    let mut out = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(b) = bytes.next() {
        if b == b'%' {
            let digits = [bytes.next()?, bytes.next()?];
            let digits = std::str::from_utf8(&digits).ok()?;
            out.push(u8::from_str_radix(digits, 16).ok()?);
        } else {
            out.push(b);
        }
    }
    String::from_utf8(out).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_standard() {
        assert_eq!(base64("Zm9vYmE=").unwrap(), b"fooba");
        assert_eq!(base64("Zm9vYmFy").unwrap(), b"foobar");
        assert_eq!(base64("Zg").unwrap(), b"f");
        assert_eq!(base64("Z!"), None);
        assert_eq!(unescaped("a%20b.bin").unwrap(), "a b.bin");
        assert_eq!(unescaped("a%2"), None);
    }
}
