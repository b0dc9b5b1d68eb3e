//! Wavefront OBJ. Colours stand behind the coordinates of vertices, which is no part of the format and widely read.

use super::{Painted, plain};
use std::collections::HashMap;
use std::fmt::Write;

pub(super) fn write(mesh: &Painted<'_>) -> Vec<u8> {
    let mut out = format!("# Zeroset\no {}\n", plain(mesh.name).replace(' ', "_"));
    // writing to a string never fails
    for (i, [x, y, z]) in mesh.points.iter().enumerate() {
        let _ = match mesh.shown(i).map(|c| c.map(|x| f32::from(x) / 255.0)) {
            Some([r, g, b]) => writeln!(out, "v {x} {y} {z} {r:.4} {g:.4} {b:.4}"),
            None => writeln!(out, "v {x} {y} {z}"),
        };
    }
    let mut known: HashMap<String, usize> = HashMap::new();
    let numbers: Vec<usize> = (mesh.normals.as_flattened().iter())
        .map(|[x, y, z]| {
            let next = known.len() + 1;
            *known
                .entry(format!("vn {x:.3} {y:.3} {z:.3}\n"))
                .or_insert_with_key(|line| {
                    out.push_str(line);
                    next
                })
        })
        .collect();
    for (i, face) in mesh.faces.iter().enumerate() {
        let [a, b, c] = face.map(|v| v + 1);
        let _ = match numbers.get(3 * i..3 * i + 3) {
            Some([p, q, r]) => writeln!(out, "f {a}//{p} {b}//{q} {c}//{r}"),
            _ => writeln!(out, "f {a} {b} {c}"),
        };
    }
    out.into_bytes()
}
