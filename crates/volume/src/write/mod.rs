//! Mesh files: STL, OBJ, PLY, glTF in one binary file, and 3MF. From a mesh to bytes; who writes them to a disk does so whole or not at all.

mod glb;
mod obj;
mod ply;
mod stl;
mod three_mf;
mod zip;

/// The format of a mesh file that is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Binary STL: corners alone.
    Stl,
    /// Wavefront OBJ: text, with colours behind the coordinates of vertices, as Blender, MeshLab and others read them.
    Obj,
    /// Stanford PLY, binary, with colours.
    Ply,
    /// glTF 2.0 as one binary file: materials, colours and normals.
    Glb,
    /// 3D Manufacturing Format: colours, and a unit.
    ThreeMf,
}

impl Target {
    /// All, with the ends of their names.
    pub const ALL: [(Target, &'static str); 5] = [
        (Target::Glb, "glb"),
        (Target::Stl, "stl"),
        (Target::Obj, "obj"),
        (Target::Ply, "ply"),
        (Target::ThreeMf, "3mf"),
    ];

    /// The format of a file's name, by what stands behind its last dot, in capitals or not.
    pub fn of_name(name: &str) -> Option<Target> {
        let end = name.rsplit_once('.').map_or("", |(_, end)| end);
        (Target::ALL.iter())
            .find(|(_, e)| end.eq_ignore_ascii_case(e))
            .map(|(target, _)| *target)
    }
}

/// What a part of a surface is made of, as far as files say so.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfacing {
    /// Its name.
    pub name: String,
    /// 0 plastic or stone, 1 metal.
    pub metallic: f32,
    /// 0 mirror, 1 chalk.
    pub roughness: f32,
    /// Light of its own, linear, 0 to 1.
    pub emission: [f32; 3],
}

/// A mesh as it is written: triangles over shared vertices, counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug)]
pub struct Painted<'a> {
    /// The name of what it shows.
    pub name: &'a str,
    /// The vertices.
    pub points: &'a [[f32; 3]],
    /// Three vertices a face.
    pub faces: &'a [[u32; 3]],
    /// The linear colour of each vertex; none, or one a vertex.
    pub colours: &'a [[f32; 3]],
    /// The normal of each corner of each face; none, or three a face.
    pub normals: &'a [[[f32; 3]; 3]],
    /// What faces are made of.
    pub surfacings: &'a [Surfacing],
    /// Which of these each face is made of; none, or one a face.
    pub surfacing_of: &'a [u16],
}

impl Painted<'_> {
    /// The colour of a vertex as screens show it, 0 to 255.
    fn shown(&self, vertex: usize) -> Option<[u8; 3]> {
        let colour = self.colours.get(vertex)?;
        Some(colour.map(|x| (255.0 * encoded(x)).round() as u8))
    }
}

/// The sRGB transfer function (IEC 61966-2-1).
fn encoded(x: f32) -> f32 {
    let x = if x.is_finite() {
        x.clamp(0.0, 1.0)
    } else {
        0.0
    };
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    }
}

/// A mesh that a format has no room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{given} {what} are more than a file of this kind holds, which is {most}")]
pub struct TooLarge {
    /// Faces or bytes.
    pub what: &'static str,
    /// How many there are.
    pub given: u64,
    /// How many there may be.
    pub most: u64,
}

/// The bytes of a file of this format.
///
/// ```
/// use zeroset_volume::mesh::MeshLimits;
/// use zeroset_volume::read::{MeshFormat, nothing_beside, read};
/// use zeroset_volume::write::{Painted, Target, write};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let tetrahedron = Painted {
///     name: "tetrahedron",
///     points: &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     faces: &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
///     colours: &[],
///     normals: &[],
///     surfacings: &[],
///     surfacing_of: &[],
/// };
/// let bytes = write(&tetrahedron, Target::Ply)?;
/// let mesh = read(&bytes, MeshFormat::Ply, &MeshLimits::default(), &mut nothing_beside)?;
/// assert_eq!(mesh.faces().len(), 4);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// More than the format has room for: counts and sizes are numbers of 32 bits.
pub fn write(mesh: &Painted<'_>, target: Target) -> Result<Vec<u8>, TooLarge> {
    match target {
        Target::Stl => stl::write(mesh),
        Target::Obj => Ok(obj::write(mesh)),
        Target::Ply => ply::write(mesh),
        Target::Glb => glb::write(mesh),
        Target::ThreeMf => three_mf::write(mesh),
    }
}

/// Whether a count fits the numbers of a format.
fn fits(what: &'static str, given: usize) -> Result<u32, TooLarge> {
    u32::try_from(given).map_err(|_| TooLarge {
        what,
        given: given as u64,
        most: u32::MAX.into(),
    })
}

/// A name within quotes of XML or JSON, or in a line of text: what is a control or stands for something else there is left out.
fn plain(name: &str) -> String {
    let odd = |c: &char| c.is_control() || "<>&\"'\\".contains(*c);
    name.chars().filter(|c| !odd(c)).take(200).collect()
}
