//! Mesh files: what is right is read, what is wrong is refused with its place.

use zeroset_volume::check::{Check, crossings, mend};
use zeroset_volume::mesh::{Mesh, MeshError, MeshLimits};
use zeroset_volume::read::{MeshFormat, nothing_beside, read};

fn mesh(bytes: &[u8], format: MeshFormat) -> Result<Mesh, MeshError> {
    read(bytes, format, &MeshLimits::default(), &mut nothing_beside)
}

const CUBE: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
const SIDES: [[u32; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [3, 7, 6, 2],
    [0, 4, 7, 3],
    [1, 2, 6, 5],
];

fn corners() -> impl Iterator<Item = [[f32; 3]; 3]> {
    SIDES
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .map(|t| t.map(|v| CUBE[v as usize]))
}

fn obj() -> String {
    let mut text = String::from("# a cube\nmtllib none.mtl\no cube\n");
    for [x, y, z] in CUBE {
        text += &format!("v {x} {y} {z}\n");
    }
    text += "vn 0 0 1\nusemtl caf\u{e9}\ns off\n";
    for (i, side) in SIDES.iter().enumerate() {
        // in the three ways that corners are written, and across two lines
        let word = |v: &u32| match i % 3 {
            0 => format!("{}", v + 1),
            1 => format!("{}//1", v + 1),
            _ => format!("{}", i64::from(*v) - 8),
        };
        let words: Vec<String> = side.iter().map(word).collect();
        let joint = if i == 4 { " \\\n " } else { " " };
        text += &format!(
            "f {}{joint}{}\n",
            words[..2].join(" "),
            words[2..].join(" ")
        );
    }
    text
}

fn ply(format: &str) -> Vec<u8> {
    let head = format!(
        "ply\nformat {format} 1.0\ncomment by hand\nelement vertex 8\nproperty uchar red\nproperty float x\nproperty double y\n\
         property float z\nelement odd 2\nproperty list uchar short stuff\nelement face 6\n\
         property list uchar int vertex_indices\nend_header\n"
    );
    let mut out = head.into_bytes();
    let big = format.ends_with("big_endian");
    let mut put = |bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        if big {
            bytes.reverse();
        }
        out.extend(bytes);
    };
    if format == "ascii" {
        let mut text = String::new();
        for [x, y, z] in CUBE {
            text += &format!("255 {x} {y} {z}\n");
        }
        text += "2 7 8\n0\n";
        for s in SIDES {
            text += &format!("4 {} {} {} {}\n", s[0], s[1], s[2], s[3]);
        }
        out.extend(text.into_bytes());
        return out;
    }
    for [x, y, z] in CUBE {
        put(&[255]);
        put(&x.to_le_bytes());
        put(&f64::from(y).to_le_bytes());
        put(&z.to_le_bytes());
    }
    put(&[2]);
    put(&7_i16.to_le_bytes());
    put(&8_i16.to_le_bytes());
    put(&[0]);
    for side in SIDES {
        put(&[4]);
        side.iter().for_each(|v| put(&v.to_le_bytes()));
    }
    out
}

fn stl_text() -> String {
    let mut text = String::from("solid cube\n");
    for t in corners() {
        text += "facet normal 0 0 0\n outer loop\n";
        for [x, y, z] in t {
            text += &format!("  vertex {x:e} {y} {z}\n");
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid cube\n"
}

fn stl() -> Vec<u8> {
    // a binary file that begins like a text, as some do
    let mut out = b"solid but binary".to_vec();
    out.resize(80, b' ');
    out.extend(12_u32.to_le_bytes());
    for t in corners() {
        out.extend([0; 12]);
        t.iter().flatten().for_each(|x| out.extend(x.to_le_bytes()));
        out.extend([0; 2]);
    }
    out
}

/// The bytes of a buffer, and the JSON that says what they are; the node turns the cube's axes around and makes it twice as large.
fn gltf(uri: &str) -> (Vec<u8>, String) {
    let mut bin = Vec::new();
    CUBE.iter()
        .flatten()
        .for_each(|x| bin.extend(x.to_le_bytes()));
    let indices = SIDES
        .iter()
        .flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]);
    indices.for_each(|i| bin.extend((i as u16).to_le_bytes()));
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[1]}}],
        "nodes":[{{"mesh":0,"scale":[2,2,-2]}},{{"children":[0],"translation":[5,0,0]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}},
        {{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],
        "buffers":[{{"byteLength":{}{uri}}}]}}"#,
        bin.len()
    );
    (bin, json)
}

fn glb() -> Vec<u8> {
    let (bin, mut json) = gltf("");
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let mut out = b"glTF".to_vec();
    let length = 12 + 8 + json.len() + 8 + bin.len();
    out.extend(2_u32.to_le_bytes());
    out.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &bin)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

fn all() -> Vec<(MeshFormat, Vec<u8>)> {
    vec![
        (MeshFormat::Obj, obj().into_bytes()),
        (MeshFormat::Ply, ply("ascii")),
        (MeshFormat::Ply, ply("binary_little_endian")),
        (MeshFormat::Ply, ply("binary_big_endian")),
        (MeshFormat::Stl, stl_text().into_bytes()),
        (MeshFormat::Stl, stl()),
        (MeshFormat::Glb, glb()),
    ]
}

fn is_cube(name: &str, mut mesh: Mesh) -> Check {
    let check = mend(&mut mesh);
    assert_eq!(
        (check.vertices, check.faces, check.parts),
        (8, 12, 1),
        "{name}"
    );
    assert!(
        check.watertight && check.holes == 0 && check.flipped == 0,
        "{name}: {check:?}"
    );
    assert_eq!(
        (check.flat, check.duplicates, crossings(&mesh)),
        (0, 0, 0),
        "{name}"
    );
    check
}

#[test]
fn a_cube_in_every_format() {
    for (format, bytes) in all() {
        let name = format!("{format:?}");
        let mesh = mesh(&bytes, format).unwrap_or_else(|e| panic!("{name}: {e}"));
        let bounds = mesh.bounds();
        let check = is_cube(&name, mesh);
        let (side, low) = if format == MeshFormat::Glb {
            (2.0_f64, [5.0_f32, 0.0, -2.0])
        } else {
            (1.0, [0.0; 3])
        };
        assert_eq!(bounds, [low, low.map(|x| x + side as f32)], "{name}");
        assert!(
            (check.volume - side.powi(3)).abs() < 1e-9
                && (check.area - 6.0 * side * side).abs() < 1e-9
        );
    }
}

#[test]
fn a_gltf_with_its_buffer_elsewhere() {
    let (bin, json) = gltf(r#","uri":"a%20cube.bin""#);
    let mut beside = |name: &str| {
        assert_eq!(name, "a cube.bin");
        Ok(bin.clone())
    };
    let limits = MeshLimits::default();
    is_cube(
        "gltf",
        read(json.as_bytes(), MeshFormat::Gltf, &limits, &mut beside).unwrap(),
    );
    let refused = mesh(json.as_bytes(), MeshFormat::Gltf).unwrap_err();
    assert!(
        refused.to_string().contains("no other file can be read"),
        "{refused}"
    );
}

/// A file that ends anywhere is refused or is less of a mesh, and so is one with any byte changed: neither takes the process down.
#[test]
fn damaged_files_are_errors() {
    for (format, bytes) in all() {
        for end in 0..bytes.len() {
            let _ = mesh(&bytes[..end], format);
        }
        for at in 0..bytes.len() {
            for change in [1, 0x80, 0xff] {
                let mut bytes = bytes.clone();
                bytes[at] ^= change;
                if let Ok(mut mesh) = mesh(&bytes, format) {
                    mend(&mut mesh);
                }
            }
        }
    }
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let say = |text: &str, format| mesh(text.as_bytes(), format).unwrap_err().to_string();
    use MeshFormat::{Glb, Gltf, Obj, Ply, Stl};
    for (text, format, wanted) in [
        ("", Obj, "it is empty"),
        ("# nothing\n", Obj, "0 vertices and no face"),
        ("v 0 0\n", Obj, "line 1: a coordinate is missing"),
        ("v 0 0 x\n", Obj, "line 1: \"x\" is no number"),
        ("v 0 0 nan\n", Obj, "line 1: \"nan\" is no number"),
        (
            "v 1e30 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3\n",
            Obj,
            "coordinates go from -1e9 to 1e9",
        ),
        (
            "v 0 0 0\nf 1 2 3\n",
            Obj,
            "face 1 has the vertex 1, but there are 1 vertices",
        ),
        (
            "v 0 0 0\nf 0 1 2\n",
            Obj,
            "line 2: \"0\" is no corner of a face",
        ),
        ("v 0 0 0\nf 1 1 1\n", Obj, "no face with an area"),
        ("obj\n", Ply, "line 1: a PLY file begins with `ply`"),
        (
            "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n",
            Ply,
            "at most 16777216 are allowed",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 9000000\nproperty float x\nend_header\n",
            Ply,
            "the file is not whole",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
            Ply,
            "no property \"y\"",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty fluff x\nend_header\n1\n",
            Ply,
            "line 4: \"fluff\" is no type",
        ),
        (
            "ply\nformat odd 1.0\n",
            Ply,
            "line 2: there is no format \"odd\"",
        ),
        ("ply\nformat ascii 1.0\n", Ply, "it ends within its header"),
        ("hello", Stl, "neither like a text"),
        (
            "solid x\nvertex 0 0 0\nvertex 0 1 0\n",
            Stl,
            "it ends within a facet",
        ),
        ("{}", Gltf, "it is no glTF"),
        ("glTF\x01\0\0\0", Glb, "only version 2"),
        ("glTF\x02\0\0\0\0\0\0\0", Glb, "the JSON"),
    ] {
        let said = say(text, format);
        assert!(said.contains(wanted), "{text:?}: {said}");
    }
    let mut many = vec![0; 84];
    many[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(
        mesh(&many, Stl)
            .unwrap_err()
            .to_string()
            .contains("the file is not whole")
    );
    assert_eq!(MeshFormat::of_name("a.b/c.PLY"), Ok(Ply));
    assert_eq!(MeshFormat::of_name("ply"), Err(MeshError::Format));
}

#[test]
fn limits_hold() {
    let limits = MeshLimits {
        vertices: 8,
        faces: 11,
    };
    for (format, bytes) in all() {
        let refused = read(&bytes, format, &limits, &mut nothing_beside).unwrap_err();
        assert!(
            matches!(refused, MeshError::Many { .. }),
            "{format:?}: {refused}"
        );
    }
}

/// A part of a header that no program should write does not matter where it is not needed.
#[test]
fn elements_that_are_not_needed_may_be_odd() {
    let text = String::from_utf8(ply("ascii")).unwrap().replace(
        "property list uchar short stuff",
        "property ambient_red uchar { ambient color }",
    );
    is_cube("odd", mesh(text.as_bytes(), MeshFormat::Ply).unwrap());
}

/// Polygons that are not convex are cut along their diagonals, not fanned across their outside.
#[test]
fn polygons_that_are_not_convex() {
    // an L of area 3 in a plane that is along no axis
    let corners = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)];
    for turn in 0..6 {
        let mut text = String::new();
        for i in 0..6 {
            let (x, y) = corners[(i + turn) % 6];
            text += &format!("v {x} {y} {x}\n");
        }
        let mut mesh = mesh((text + "f 1 2 3 4 5 6\n").as_bytes(), MeshFormat::Obj).unwrap();
        let check = mend(&mut mesh);
        assert_eq!((check.faces, check.flipped), (4, 0));
        assert!(
            (check.area - 3.0 * 2.0_f64.sqrt()).abs() < 1e-6,
            "{}",
            check.area
        );
    }
}

#[test]
fn strips_of_triangles() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 0 1 2 3 -1 2 1 0 -1\n";
    let mesh = mesh(text.as_bytes(), MeshFormat::Ply).unwrap();
    assert_eq!(mesh.faces(), [[0, 1, 2], [2, 1, 3], [2, 1, 0]]);
}

#[test]
fn faces_that_cross_are_counted() {
    let two = |by: f32| {
        let mut points = CUBE.to_vec();
        points.extend(
            CUBE.iter()
                .map(|p| [p[0] * 0.5 + by, p[1] * 0.5 + 0.25, p[2] * 0.5 + 0.25]),
        );
        let faces = (0..2).flat_map(|n| {
            SIDES
                .iter()
                .flat_map(move |s| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]])
                .map(move |f| f.map(|v| v + 8 * n))
        });
        let mut mesh = Mesh::new(points, faces.collect()).unwrap();
        mend(&mut mesh);
        crossings(&mesh)
    };
    // within, through a side, touching a side, apart
    assert_eq!(two(0.25), 0);
    assert!(two(0.75) > 0 && two(1.0) > 0);
    assert_eq!(two(1.01), 0);
}
