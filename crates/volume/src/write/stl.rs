//! Binary STL: of each face its normal and its corners.

use super::{Painted, TooLarge, fits};

pub(super) fn write(mesh: &Painted<'_>) -> Result<Vec<u8>, TooLarge> {
    let count = fits("faces", mesh.faces.len())?;
    let mut out = Vec::with_capacity(84 + 50 * mesh.faces.len());
    // a header that does not begin with "solid", which would say that this is a text
    let mut header = [b' '; 80];
    let words = b"Zeroset, binary STL";
    header[..words.len()].copy_from_slice(words);
    out.extend(header);
    out.extend(count.to_le_bytes());
    for face in mesh.faces {
        let [a, b, c] = face.map(|v| mesh.points[v as usize]);
        let (u, v) = (sub(b, a), sub(c, a));
        let n = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        let normal = n.map(|x| {
            if length > 0.0 {
                (x / length) as f32
            } else {
                0.0
            }
        });
        for x in [normal, a, b, c].as_flattened() {
            out.extend(x.to_le_bytes());
        }
        out.extend([0, 0]);
    }
    Ok(out)
}

fn sub(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    std::array::from_fn(|k| f64::from(a[k]) - f64::from(b[k]))
}
