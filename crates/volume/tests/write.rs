//! Mesh files that are written are read back by our own readers, and have what their formats ask for.

use zeroset_volume::check::mend;
use zeroset_volume::mesh::{Mesh, MeshLimits};
use zeroset_volume::read::{MeshFormat, nothing_beside, read};
use zeroset_volume::write::{Painted, Surfacing, Target, write};

const POINTS: [[f32; 3]; 4] = [
    [0.1, 0.2, 0.3],
    [1.5, 0.0, -0.25],
    [0.0, 1e-3, 0.0],
    [0.0, 0.0, 1e6],
];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
const COLOURS: [[f32; 3]; 4] = [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.25], [0.0; 3]];

fn surfacings() -> Vec<Surfacing> {
    let surfacing = |name: &str, metallic| Surfacing {
        name: name.into(),
        metallic,
        roughness: 0.25,
        emission: [0.0; 3],
    };
    vec![surfacing("a \"odd\" <name>", 0.0), surfacing("gold", 1.0)]
}

const NORMALS: [[[f32; 3]; 3]; 4] = [
    [[0.0, 0.0, -1.0]; 3],
    [[0.0, -1.0, 0.0]; 3],
    [[0.6, 0.8, 0.0]; 3],
    [[-1.0, 0.0, 0.0]; 3],
];

fn painted(surfacings: &[Surfacing]) -> Painted<'_> {
    Painted {
        name: "scene & <more>\n",
        points: &POINTS,
        faces: &FACES,
        colours: &COLOURS,
        normals: &NORMALS,
        surfacings,
        surfacing_of: &[0, 1, 1, 0],
    }
}

fn bare() -> Painted<'static> {
    Painted {
        name: "",
        colours: &[],
        normals: &[],
        surfacings: &[],
        surfacing_of: &[],
        ..painted(&[])
    }
}

/// Faces by where their corners are, whatever these are numbered.
fn places(points: &[[f32; 3]], faces: &[[u32; 3]]) -> Vec<[[u32; 3]; 3]> {
    let mut all: Vec<[[u32; 3]; 3]> = (faces.iter())
        .map(|f| {
            let mut corners = f.map(|v| points[v as usize].map(f32::to_bits));
            let first = (0..3).min_by_key(|k| corners[*k]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

#[test]
fn what_is_written_is_read_back_to_the_bit() {
    let pairs = [
        (Target::Stl, MeshFormat::Stl),
        (Target::Obj, MeshFormat::Obj),
        (Target::Ply, MeshFormat::Ply),
        (Target::Glb, MeshFormat::Glb),
    ];
    let surfacings = surfacings();
    for mesh in [painted(&surfacings), bare()] {
        for (target, format) in pairs {
            let bytes = write(&mesh, target).unwrap();
            let mut back: Mesh =
                read(&bytes, format, &MeshLimits::default(), &mut nothing_beside).unwrap();
            assert_eq!(
                places(back.points(), back.faces()),
                places(&POINTS, &FACES),
                "{target:?}"
            );
            let check = mend(&mut back);
            assert!(
                check.watertight && check.flipped.is_multiple_of(4) && check.holes == 0,
                "{target:?}"
            );
        }
    }
}

#[test]
fn colours_are_written_as_screens_show_them() {
    let surfacings = surfacings();
    let bytes = write(&painted(&surfacings), Target::Ply).unwrap();
    let body = bytes
        .windows(11)
        .position(|w| w == b"end_header\n")
        .unwrap()
        + 11;
    // 0.5 linear is 188 of 255, 0.25 is 137 (IEC 61966-2-1)
    assert_eq!(bytes[body + 12..body + 15], [255, 0, 0]);
    assert_eq!(bytes[body + 15 + 12..body + 30], [0, 188, 0]);
    assert_eq!(bytes[body + 30 + 12..body + 45], [0, 0, 137]);
    let text = String::from_utf8(write(&painted(&surfacings), Target::Obj).unwrap()).unwrap();
    assert!(
        text.contains("v 0.1 0.2 0.3 1.0000 0.0000 0.0000\n"),
        "{text}"
    );
}

#[test]
fn a_glb_has_a_primitive_for_each_material() {
    let surfacings = surfacings();
    let bytes = write(&painted(&surfacings), Target::Glb).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    assert_eq!(
        bytes.len(),
        u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize
    );
    let root: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let primitives = root["meshes"][0]["primitives"].as_array().unwrap();
    assert_eq!(primitives.len(), 2);
    assert_eq!(
        root["materials"][1]["pbrMetallicRoughness"]["metallicFactor"],
        1.0
    );
    assert_eq!(root["materials"][0]["name"], "a odd name");
    // three vertices a corner: each face has a normal of its own
    assert_eq!(root["accessors"][0]["count"], 12);
    for view in root["bufferViews"].as_array().unwrap() {
        assert_eq!(view["byteOffset"].as_u64().unwrap() % 4, 0);
    }
}

/// The files of an archive, by its central directory.
fn unzip(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let two = |at: usize| usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
    let four = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let end = bytes.len() - 22;
    assert_eq!(bytes[end..end + 4], *b"PK\x05\x06");
    let (count, mut at) = (two(end + 10), four(end + 16));
    assert_eq!(at + four(end + 12), end);
    (0..count)
        .map(|_| {
            assert_eq!(bytes[at..at + 4], *b"PK\x01\x02");
            let (crc, packed, whole) = (four(at + 16), four(at + 20), four(at + 24));
            let (name, local) = (two(at + 28), four(at + 42));
            let title = String::from_utf8(bytes[at + 46..at + 46 + name].to_vec()).unwrap();
            at += 46 + name;
            assert_eq!(bytes[local..local + 4], *b"PK\x03\x04");
            let body = local + 30 + two(local + 26) + two(local + 28);
            let inflated =
                miniz_oxide::inflate::decompress_to_vec(&bytes[body..body + packed]).unwrap();
            assert_eq!(
                (inflated.len(), crc32fast::hash(&inflated) as usize),
                (whole, crc)
            );
            (title, inflated)
        })
        .collect()
}

#[test]
fn a_3mf_is_an_archive_of_xml() {
    let surfacings = surfacings();
    let files = unzip(&write(&painted(&surfacings), Target::ThreeMf).unwrap());
    let names: Vec<&str> = files.iter().map(|f| f.0.as_str()).collect();
    assert_eq!(
        names,
        ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]
    );
    let model = String::from_utf8(files[2].1.clone()).unwrap();
    assert_eq!(model.matches("<vertex ").count(), 4);
    assert_eq!(model.matches("<triangle ").count(), 4);
    assert!(model.contains("#00BC00FF"), "{model}");
    assert!(model.contains("name=\"scene  more\""), "{model}");
    let bare = unzip(&write(&bare(), Target::ThreeMf).unwrap());
    assert!(
        !String::from_utf8(bare[2].1.clone())
            .unwrap()
            .contains("colorgroup")
    );
}

#[test]
fn names_say_what_is_written() {
    assert_eq!(Target::of_name("a/b.GLB"), Some(Target::Glb));
    assert_eq!(Target::of_name("b.3mf"), Some(Target::ThreeMf));
    assert_eq!(Target::of_name("glb"), None);
    assert_eq!(Target::of_name("a.gltf"), None);
}
