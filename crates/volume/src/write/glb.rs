//! glTF 2.0 as one binary file: a primitive for each kind of surface, over shared vertices.
//!
//! Where normals or colours differ at a vertex, as along a sharp edge, glTF has a vertex for each: what reads it welds them by their place.

use super::{Painted, Surfacing, TooLarge, fits, plain};
use serde_json::{Value, json};
use std::collections::HashMap;

const FLOAT: u32 = 5126;
const SHORT: u32 = 5123;
const INT: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Normals that are equal after this many steps between 0 and 1 are one.
const STEPS: f32 = 4096.0;

/// Vertices with normals: the number of each, and the indices of each kind of surface.
struct Split {
    /// Vertices of the mesh.
    from: Vec<u32>,
    normals: Vec<[f32; 3]>,
    indices: Vec<(u16, Vec<u32>)>,
}

fn split(mesh: &Painted<'_>) -> Split {
    let mut known: HashMap<(u32, [i16; 3]), u32> = HashMap::new();
    let mut out = Split {
        from: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
    };
    let mut place: HashMap<u16, usize> = HashMap::new();
    for (i, face) in mesh.faces.iter().enumerate() {
        let surfacing = mesh.surfacing_of.get(i).copied().unwrap_or_default();
        let at = *place.entry(surfacing).or_insert_with(|| {
            out.indices.push((surfacing, Vec::new()));
            out.indices.len() - 1
        });
        for (k, vertex) in face.iter().enumerate() {
            let normal = mesh.normals.get(i).map(|n| n[k]).unwrap_or_default();
            let key = (*vertex, normal.map(|x| (x * STEPS) as i16));
            let number = *known.entry(key).or_insert_with(|| {
                out.from.push(*vertex);
                out.normals.push(normal);
                out.from.len() as u32 - 1
            });
            out.indices[at].1.push(number);
        }
    }
    out
}

/// A file's second part, and what is said of it.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Puts bytes behind the others, and says what they are.
    fn put(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        target: u32,
        mut accessor: Value,
    ) -> Result<usize, TooLarge> {
        let begin = self.bytes.len();
        self.bytes.extend(bytes);
        fits("bytes", self.bytes.len())?;
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": begin,
            "byteLength": self.bytes.len() - begin,
            "target": target,
        }));
        accessor["bufferView"] = (self.views.len() - 1).into();
        self.accessors.push(accessor);
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        Ok(self.accessors.len() - 1)
    }
}

pub(super) fn write(mesh: &Painted<'_>) -> Result<Vec<u8>, TooLarge> {
    let split = split(mesh);
    let count = fits("vertices", split.from.len())?;
    let at = |v: &u32| mesh.points[*v as usize];
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in split.from.iter().map(at) {
        for k in 0..3 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let mut buffer = Buffer::default();
    let floats = |v: [f32; 3]| v.into_iter().flat_map(f32::to_le_bytes);
    let mut attributes = json!({});
    let places =
        json!({"componentType": FLOAT, "count": count, "type": "VEC3", "min": low, "max": high});
    let bytes = split.from.iter().map(at).flat_map(floats);
    attributes["POSITION"] = buffer.put(bytes, VERTICES, places)?.into();
    if !mesh.normals.is_empty() {
        let about = json!({"componentType": FLOAT, "count": count, "type": "VEC3"});
        let bytes = split.normals.iter().copied().flat_map(floats);
        attributes["NORMAL"] = buffer.put(bytes, VERTICES, about)?.into();
    }
    if !mesh.colours.is_empty() {
        // linear, as glTF wants them
        let about =
            json!({"componentType": SHORT, "normalized": true, "count": count, "type": "VEC4"});
        let whole = |x: f32| (65535.0 * x.clamp(0.0, 1.0)).round() as u16;
        let bytes = (split.from.iter())
            .map(|v| mesh.colours.get(*v as usize).copied().unwrap_or_default())
            .map(|[r, g, b]| [whole(r), whole(g), whole(b), u16::MAX])
            .flat_map(|c| c.into_iter().flat_map(u16::to_le_bytes));
        attributes["COLOR_0"] = buffer.put(bytes, VERTICES, about)?.into();
    }
    let mut primitives = Vec::new();
    for (surfacing, indices) in &split.indices {
        let about = json!({"componentType": INT, "count": indices.len(), "type": "SCALAR"});
        let bytes = indices.iter().flat_map(|i| i.to_le_bytes());
        let number = buffer.put(bytes, INDICES, about)?;
        let mut primitive = json!({"attributes": attributes, "indices": number});
        if usize::from(*surfacing) < mesh.surfacings.len() {
            primitive["material"] = (*surfacing).into();
        }
        primitives.push(primitive);
    }
    let name = plain(mesh.name);
    let mut root = json!({
        "asset": {"version": "2.0", "generator": "Zeroset"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": name}],
        "meshes": [{"primitives": primitives, "name": name}],
        "buffers": [{"byteLength": buffer.bytes.len()}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    });
    if !mesh.surfacings.is_empty() {
        root["materials"] = mesh.surfacings.iter().map(material).collect();
    }
    let mut text = root.to_string().into_bytes();
    while !text.len().is_multiple_of(4) {
        text.push(b' ');
    }
    let all = 12 + 8 + text.len() + 8 + buffer.bytes.len();
    let mut out = Vec::with_capacity(all);
    out.extend(b"glTF");
    out.extend(2_u32.to_le_bytes());
    out.extend(fits("bytes", all)?.to_le_bytes());
    for (kind, bytes) in [(b"JSON", &text), (b"BIN\0", &buffer.bytes)] {
        out.extend(fits("bytes", bytes.len())?.to_le_bytes());
        out.extend(kind);
        out.extend(bytes);
    }
    Ok(out)
}

fn material(surfacing: &Surfacing) -> Value {
    let unit = |x: f32| {
        if x.is_finite() {
            x.clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    json!({
        "name": plain(&surfacing.name),
        "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 1.0, 1.0, 1.0],
            "metallicFactor": unit(surfacing.metallic),
            "roughnessFactor": unit(surfacing.roughness),
        },
        "emissiveFactor": surfacing.emission.map(unit),
    })
}
