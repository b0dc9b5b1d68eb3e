//! Mesh files: OBJ, PLY, STL, glTF and GLB.
//!
//! # Untrusted input
//!
//! Whatever the bytes are, a reader gives a mesh or an error: it does not panic, it asks for no memory beyond a small multiple
//! of the file's length, and its time grows no faster than the file. Counts that a file announces are compared with its
//! length and the limits before anything is allocated for them.

mod gltf;
mod obj;
mod ply;
mod polygon;
mod stl;

use crate::mesh::{Mesh, MeshError, MeshLimits};

/// The format of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ: text. Vertices and polygons are read; normals, texture coordinates and materials are passed over.
    Obj,
    /// Stanford PLY (Turk 1994): text or binary of either byte order; polygons and triangle strips.
    Ply,
    /// STL: text or binary.
    Stl,
    /// glTF 2.0 with its buffers in other files or within: the triangles of the default scene, at the places of its nodes.
    Gltf,
    /// glTF 2.0 as one binary file.
    Glb,
}

impl MeshFormat {
    /// All, with the ends of their names.
    pub const ALL: [(MeshFormat, &'static str); 5] = [
        (MeshFormat::Obj, "obj"),
        (MeshFormat::Ply, "ply"),
        (MeshFormat::Stl, "stl"),
        (MeshFormat::Gltf, "gltf"),
        (MeshFormat::Glb, "glb"),
    ];

    /// The format of a file's name, by what stands behind its last dot, in capitals or not.
    ///
    /// # Errors
    /// Another end, or none.
    pub fn of_name(name: &str) -> Result<MeshFormat, MeshError> {
        let end = name.rsplit_once('.').map_or("", |(_, end)| end);
        (MeshFormat::ALL.iter())
            .find(|(_, e)| end.eq_ignore_ascii_case(e))
            .map(|(format, _)| *format)
            .ok_or(MeshError::Format)
    }
}

/// The bytes of files that a mesh refers to, by the names it calls them: buffers of a glTF. The message of an error is shown to
/// people.
pub type Beside<'a> = &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>;

/// For meshes that may refer to no other file.
///
/// # Errors
/// Always.
pub fn nothing_beside(_: &str) -> Result<Vec<u8>, String> {
    Err("no other file can be read here".into())
}

/// The mesh of a file.
///
/// ```
/// use zeroset_volume::mesh::MeshLimits;
/// use zeroset_volume::read::{MeshFormat, nothing_beside, read};
///
/// let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
/// let mesh = read(text, MeshFormat::Obj, &MeshLimits::default(), &mut nothing_beside)?;
/// assert_eq!((mesh.points().len(), mesh.faces().len()), (4, 4));
/// # Ok::<(), zeroset_volume::mesh::MeshError>(())
/// ```
///
/// # Errors
/// What is wrong with the file and where, or what is too much.
pub fn read(
    bytes: &[u8],
    format: MeshFormat,
    limits: &MeshLimits,
    beside: Beside<'_>,
) -> Result<Mesh, MeshError> {
    if bytes.is_empty() {
        return Err(MeshError::Empty);
    }
    let mut soup = Soup::new(limits);
    match format {
        MeshFormat::Obj => obj::read(bytes, &mut soup)?,
        MeshFormat::Ply => ply::read(bytes, &mut soup)?,
        MeshFormat::Stl => stl::read(bytes, &mut soup)?,
        MeshFormat::Gltf | MeshFormat::Glb => gltf::read(bytes, &mut soup, beside)?,
    }
    Mesh::new(soup.points, soup.faces)
}

/// What a reader fills: within the limits.
struct Soup {
    points: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    limits: MeshLimits,
    /// Polygons so far, for messages.
    polygons: usize,
    scratch: polygon::Scratch,
}

impl Soup {
    fn new(limits: &MeshLimits) -> Soup {
        // a vertex is a number of 32 bits
        let most = u64::from(u32::MAX) - 1;
        Soup {
            points: Vec::new(),
            faces: Vec::new(),
            limits: MeshLimits {
                vertices: limits.vertices.min(most),
                faces: limits.faces.min(most),
            },
            polygons: 0,
            scratch: polygon::Scratch::default(),
        }
    }

    /// Whether so many more vertices are allowed.
    fn check_points(&self, more: u64) -> Result<(), MeshError> {
        let (given, most) = (
            (self.points.len() as u64).saturating_add(more),
            self.limits.vertices,
        );
        if given <= most {
            return Ok(());
        }
        Err(MeshError::Many {
            what: "vertices",
            given,
            most,
        })
    }

    /// Whether so many more faces are allowed.
    fn check_faces(&self, more: u64) -> Result<(), MeshError> {
        let (given, most) = (
            (self.faces.len() as u64).saturating_add(more),
            self.limits.faces,
        );
        if given <= most {
            return Ok(());
        }
        Err(MeshError::Many {
            what: "faces",
            given,
            most,
        })
    }

    fn point(&mut self, point: [f32; 3]) -> Result<(), MeshError> {
        self.check_points(1)?;
        self.points.push(point);
        Ok(())
    }

    /// A polygon over vertices that were read before, cut into triangles. Fewer than three corners are no face.
    fn polygon(&mut self, corners: &[i64]) -> Result<(), MeshError> {
        self.polygons += 1;
        let vertices = self.points.len();
        let missing = |c: &&i64| !usize::try_from(**c).is_ok_and(|c| c < vertices);
        if let Some(&vertex) = corners.iter().find(missing) {
            return Err(MeshError::Corner {
                face: self.polygons,
                vertex,
                vertices,
            });
        }
        self.check_faces(corners.len().saturating_sub(2) as u64)?;
        match *corners {
            [a, b, c] => self.faces.push([a, b, c].map(|v| v as u32)),
            [_, _, _, _, ..] => {
                (self.scratch).cut(corners, &self.points, &mut self.faces);
            }
            _ => {}
        }
        Ok(())
    }
}

/// Parses a number of a text: finite.
fn number(word: Option<&str>, line: usize) -> Result<f32, MeshError> {
    let bad = |reason: String| MeshError::Line { line, reason };
    let word = word.ok_or_else(|| bad("a coordinate is missing".into()))?;
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x as f32),
        _ => Err(bad(format!("\"{}\" is no number", shortened(word)))),
    }
}

/// A word of a file for messages: not longer than a person reads, without what would control a terminal.
fn shortened(word: &str) -> String {
    const MOST: usize = 40;
    let mut out: String = word.chars().take(MOST).map(shown).collect();
    if word.chars().nth(MOST).is_some() {
        out.push('…');
    }
    out
}

fn shown(c: char) -> char {
    if c.is_control() { '?' } else { c }
}

/// The lines of a text with their numbers, counted from 1. What is no UTF-8 is a mistake of the line.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    bytes
        .split(|b| *b == b'\n')
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim_ascii()))
}

fn text(line: usize, bytes: &[u8]) -> Result<&str, MeshError> {
    std::str::from_utf8(bytes).map_err(|_| MeshError::Line {
        line,
        reason: "this is no text: the file is damaged, or of another format".into(),
    })
}
