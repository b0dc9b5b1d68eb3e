//! `zeroset mesh`.

use crate::run::Folder;
use zeroset::volume::check::mend;
use zeroset::volume::mesh::MeshLimits;
use zeroset::volume::read::{MeshFormat, nothing_beside, read};

const SCENE: &str = "size = slider(\"size\", 1.0, min = 0.5, max = 2.0)\n\
    show(box(size), material(color = \"red\"), name = \"cube\")\n\
    show(sphere(0.4).move(x = 2 + time()), material(color = \"blue\"))\n";

#[test]
fn a_scene_becomes_a_mesh_in_every_format() {
    let folder = Folder::with(SCENE);
    for (format, reader) in [
        ("glb", Some(MeshFormat::Glb)),
        ("stl", Some(MeshFormat::Stl)),
        ("obj", Some(MeshFormat::Obj)),
        ("ply", Some(MeshFormat::Ply)),
        ("3mf", None),
    ] {
        let ended = folder.good(&format!("mesh scene.star -o out/x.{format} --json"));
        assert!(ended.err.contains("watertight"), "{}", ended.err);
        let said = ended.json();
        assert_eq!(said["watertight"], true);
        assert_eq!((&said["parts"], &said["euler"]), (&2.into(), &4.into()));
        let (off, most) = (
            said["deviation"].as_f64().unwrap(),
            said["tolerance"].as_f64().unwrap(),
        );
        // 3.4 units long in all
        assert!(
            (most - 2.9e-3).abs() < 1e-4 && off <= most,
            "{off} of {most}"
        );
        let right = 1.0 + 4.0 / 3.0 * std::f64::consts::PI * 0.4_f64.powi(3);
        assert!(
            (said["volume"].as_f64().unwrap() - right).abs() < 5e-3,
            "{said}"
        );
        let bytes = folder.read(&format!("out/x.{format}"));
        if let Some(reader) = reader {
            let mut mesh =
                read(&bytes, reader, &MeshLimits::default(), &mut nothing_beside).unwrap();
            let check = mend(&mut mesh);
            let faces = said["faces"].as_u64().unwrap() as usize;
            assert!(check.watertight && check.flipped == 0 && check.crowded_edges == 0);
            assert_eq!((check.faces, check.parts, check.holes), (faces, 2, 0));
        }
    }
    // the cube's vertices are red, the ball's blue
    let text = String::from_utf8(folder.read("out/x.obj")).unwrap();
    let vertices: Vec<Vec<f32>> = (text.lines())
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect())
        .collect();
    for v in &vertices {
        let right = if v[0] > 1.0 {
            [0.0, 0.0, 1.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        assert_eq!(v[3..6], right, "{v:?}");
    }
}

#[test]
fn parameters_and_time_count() {
    let folder = Folder::with(SCENE);
    let of = |flags: &str| {
        folder
            .good(&format!("mesh scene.star -o x.stl --json {flags}"))
            .json()
    };
    let (small, large) = (of(""), of("--set size=2"));
    let grown = large["volume"].as_f64().unwrap() - small["volume"].as_f64().unwrap();
    assert!((grown - 7.0).abs() < 1e-2, "{grown}");
    // together they are one part
    assert_eq!(of("--time -2 --set size=0.5")["parts"], 1);
}

#[test]
fn what_has_no_end_is_cut_where_one_says() {
    let folder = Folder::with("show(sphere(0.5).move(y = 0.5))\nshow(plane(), name = \"floor\")\n");
    folder.bad(
        "mesh scene.star -o x.glb",
        3,
        &["floor", "line 2", "goes on for ever", "--bounds"],
    );
    let said = folder
        .good("mesh scene.star -o x.glb --bounds -1,-0.25,-1,1,2,1 --json")
        .json();
    // the slab, and most of the ball
    let right = 4.0 * 0.25 + 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    assert!(
        (said["volume"].as_f64().unwrap() - right).abs() < 1e-2,
        "{said}"
    );
    assert_eq!(said["watertight"], true);
}

#[test]
fn what_cannot_be_is_said() {
    let folder = Folder::with("show(sphere(1.0))\n");
    folder.write("kept.stl", "as it was");
    for (flags, code, words) in [
        ("-o x.png", 2, ["x.png", ".glb, .stl, .obj, .ply, .3mf"]),
        ("-o x.stl --tolerance 0", 2, ["0", "a number above 0"]),
        ("-o x.stl --resolution 2", 2, ["4..=8192", "2"]),
        ("-o x.stl --bounds 1,2,3", 2, ["1,2,3", "smallest corner"]),
        ("-o x.stl --bounds 1,1,1,0,0,0", 2, ["first corner", "less"]),
        (
            "-o x.stl --bounds 5,5,5,6,6,6",
            3,
            ["no surface", "positive"],
        ),
        (
            "-o kept.stl --resolution 8000",
            2,
            ["cells", "grid_samples"],
        ),
        (
            "-o kept.stl --limit mesh_faces=100",
            2,
            ["faces", "mesh_faces"],
        ),
    ] {
        folder.bad(&format!("mesh scene.star {flags}"), code, &words);
    }
    assert_eq!(folder.read("kept.stl"), b"as it was");
    folder.write("flat.star", "show(circle(1.0))\n");
    assert_ne!(folder.run("mesh flat.star -o x.stl").code, Some(0));
    assert_eq!(folder.names(), ["flat.star", "kept.stl", "scene.star"]);
}
