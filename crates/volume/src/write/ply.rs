//! Stanford PLY (Turk 1994), binary, little-endian.

use super::{Painted, TooLarge, fits};

pub(super) fn write(mesh: &Painted<'_>) -> Result<Vec<u8>, TooLarge> {
    let (vertices, faces) = (
        fits("vertices", mesh.points.len())?,
        fits("faces", mesh.faces.len())?,
    );
    let colours = match mesh.colours.is_empty() {
        true => "",
        false => "property uchar red\nproperty uchar green\nproperty uchar blue\n",
    };
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Zeroset\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float \
         z\n{colours}element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut out = header.into_bytes();
    for (i, point) in mesh.points.iter().enumerate() {
        for x in point {
            out.extend(x.to_le_bytes());
        }
        if let Some(colour) = mesh.shown(i) {
            out.extend(colour);
        }
    }
    for face in mesh.faces {
        out.push(3);
        for v in face {
            out.extend((*v as i32).to_le_bytes());
        }
    }
    Ok(out)
}
