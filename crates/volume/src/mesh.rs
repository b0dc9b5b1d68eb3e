//! Meshes of triangles: valid by construction, their corners welded.

use std::collections::HashMap;
use zeroset_catalogue::LARGE;

/// What a mesh may cost: checked before what it guards is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLimits {
    /// Vertices of a file.
    pub vertices: u64,
    /// Triangles, after polygons were cut into triangles.
    pub faces: u64,
}

impl Default for MeshLimits {
    fn default() -> Self {
        MeshLimits {
            vertices: 16 << 20,
            faces: 16 << 20,
        }
    }
}

/// Why a file gives no mesh. Every message says where, what was given and what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// The file has no bytes.
    #[error("it is empty")]
    Empty,
    /// The name ends in no format that is read.
    #[error("its name ends in none of .obj, .ply, .stl, .gltf and .glb, the formats that are read")]
    Format,
    /// A text that says what cannot be.
    #[error("line {line}: {reason}")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// Bytes that are not what they must be.
    #[error("byte {at}: {reason}")]
    Byte {
        /// Counted from 0.
        at: usize,
        /// What is wrong.
        reason: String,
    },
    /// The file ends before all that it announced.
    #[error("it ends within {0}: the file is not whole")]
    Cut(String),
    /// Something the format allows and this reader does not.
    #[error("{0}")]
    Unsupported(String),
    /// A file that this one refers to.
    #[error("\"{name}\", which it refers to: {reason}")]
    Reference {
        /// Its name there.
        name: String,
        /// Why it cannot be had.
        reason: String,
    },
    /// Too many of something.
    #[error("it has {given} {what}, at most {most} are allowed")]
    Many {
        /// Vertices or faces.
        what: &'static str,
        /// How many.
        given: u64,
        /// Allowed.
        most: u64,
    },
    /// A face with a corner that is not there.
    #[error("face {face} has the vertex {vertex}, but there are {vertices} vertices")]
    Corner {
        /// Counted from 1.
        face: usize,
        /// Counted from 0.
        vertex: i64,
        /// How many there are.
        vertices: usize,
    },
    /// A coordinate that is no place of a scene.
    #[error("vertex {vertex} is ({}, {}, {}): coordinates go from -1e9 to 1e9", .place[0], .place[1], .place[2])]
    Place {
        /// Counted from 1.
        vertex: usize,
        /// Where it would be.
        place: [f32; 3],
    },
    /// Points or lines only.
    #[error("it has {vertices} vertices and no face with an area: a surface needs triangles")]
    NoFaces {
        /// Vertices.
        vertices: usize,
    },
}

/// What was left out or put together when a mesh was made of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Welding {
    /// Vertices at the place of another, which became one.
    pub welded: usize,
    /// Vertices that no face uses.
    pub unused: usize,
    /// Faces with two corners at one place, left out: without them the edges beside still meet.
    pub collapsed: usize,
}

/// Triangles over shared vertices. Every corner exists, every coordinate is finite, no face has the same vertex twice, every
/// vertex is used, and no two are at one place.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    points: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    welding: Welding,
}

impl Mesh {
    /// A mesh of these triangles, counter-clockwise seen from outside. Vertices at exactly the same place become one: files
    /// split them where texture coordinates or normals change, and STL has three for each face.
    ///
    /// # Errors
    /// A corner that is not there, a coordinate beyond ±1e9, no faces.
    pub fn new(points: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Result<Mesh, MeshError> {
        let most = LARGE as f32;
        let lost = |p: &[f32; 3]| !p.iter().all(|x| x.abs() <= most);
        if let Some(at) = points.iter().position(lost) {
            return Err(MeshError::Place {
                vertex: at + 1,
                place: points[at],
            });
        }
        let count = points.len();
        for (i, face) in faces.iter().enumerate() {
            if let Some(v) = face.iter().find(|v| **v as usize >= count) {
                return Err(MeshError::Corner {
                    face: i + 1,
                    vertex: i64::from(*v),
                    vertices: count,
                });
            }
        }
        let mut mesh = Mesh {
            points,
            faces,
            welding: Welding::default(),
        };
        mesh.weld();
        if mesh.faces.is_empty() {
            return Err(MeshError::NoFaces { vertices: count });
        }
        Ok(mesh)
    }

    fn weld(&mut self) {
        const NONE: u32 = u32::MAX;
        // the vertices that faces use, in the order of the faces
        let mut places: HashMap<[u32; 3], u32> = HashMap::with_capacity(self.points.len());
        let mut number = vec![NONE; self.points.len()];
        let mut points: Vec<[f32; 3]> = Vec::with_capacity(self.points.len());
        let mut used = 0;
        let mut collapsed = 0;
        self.faces.retain_mut(|face| {
            for corner in face.iter_mut() {
                let known = &mut number[*corner as usize];
                if *known == NONE {
                    used += 1;
                    // -0 is 0
                    let place = self.points[*corner as usize].map(|x| x + 0.0);
                    *known = *places.entry(place.map(f32::to_bits)).or_insert_with(|| {
                        points.push(place);
                        points.len() as u32 - 1
                    });
                }
                *corner = *known;
            }
            let [a, b, c] = *face;
            let whole = a != b && b != c && c != a;
            collapsed += usize::from(!whole);
            whole
        });
        // a vertex of collapsed faces alone is used by none
        let mut kept = vec![NONE; points.len()];
        let mut last = Vec::with_capacity(points.len());
        for corner in self.faces.iter_mut().flatten() {
            let to = &mut kept[*corner as usize];
            if *to == NONE {
                *to = last.len() as u32;
                last.push(points[*corner as usize]);
            }
            *corner = *to;
        }
        self.welding = Welding {
            welded: used - points.len(),
            unused: self.points.len() - used + points.len() - last.len(),
            collapsed,
        };
        self.points = last;
    }

    /// The vertices.
    pub fn points(&self) -> &[[f32; 3]] {
        &self.points
    }

    /// Three vertices a face, counter-clockwise seen from outside.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// What became of the file's vertices and faces.
    pub fn welding(&self) -> Welding {
        self.welding
    }

    /// The corners of a face.
    pub fn corners(&self, face: usize) -> [[f32; 3]; 3] {
        self.faces[face].map(|v| self.points[v as usize])
    }

    /// The corners of a face in double precision.
    pub(crate) fn corners64(&self, face: usize) -> [[f64; 3]; 3] {
        self.corners(face).map(|p| p.map(f64::from))
    }

    /// The smallest box around it: two corners.
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for p in &self.points {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        [low, high]
    }

    /// With some faces turned around.
    pub(crate) fn turn(&mut self, turned: &[bool]) {
        for (face, _) in (self.faces.iter_mut().zip(turned)).filter(|(_, t)| **t) {
            face.swap(1, 2);
        }
    }
}

/// Vectors of three numbers.
pub(crate) mod v {
    #[inline(always)]
    pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }
    #[inline(always)]
    pub(crate) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
    }
    #[inline(always)]
    pub(crate) fn scale(a: [f64; 3], s: f64) -> [f64; 3] {
        [a[0] * s, a[1] * s, a[2] * s]
    }
    #[inline(always)]
    pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }
    #[inline(always)]
    pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    }
    #[inline(always)]
    pub(crate) fn length(a: [f64; 3]) -> f64 {
        dot(a, a).sqrt()
    }
    /// Length 1, or zero where there is no direction.
    pub(crate) fn unit(a: [f64; 3]) -> [f64; 3] {
        let l = length(a);
        if l > 0.0 { scale(a, 1.0 / l) } else { [0.0; 3] }
    }
}
