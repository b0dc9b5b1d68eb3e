//! Meshes, volumes and pictures as fields of a scene: in both languages, within limits, made once.

use std::sync::{Arc, Mutex};
use zeroset_catalogue::Dimension;
use zeroset_field::field::{Field, Node};
use zeroset_field::sampled::Sampled;
use zeroset_language::assets::{Assets, Shelf};
use zeroset_language::document::Document;
use zeroset_language::files::InMemory;
use zeroset_language::json::{expand, to_text};
use zeroset_language::limits::Limits;
use zeroset_language::load::{Failed, Language, Loaded, Options};
use zeroset_number::{F64, v3};

/// A cube of side 2 about the origin.
const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
                    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

/// Distances to a plane: x - 1 over a box of 2.
fn nrrd() -> Vec<u8> {
    let mut bytes =
        b"NRRD0004\ntype: float\ndimension: 3\nsizes: 3 3 3\nencoding: raw\nendian: little\n\n"
            .to_vec();
    (0..27).for_each(|i| bytes.extend((((i % 3) - 1) as f32).to_le_bytes()));
    bytes
}

/// A dark disc of radius 12 in a white picture of 40 pixels; outside it is clear black, which is white too.
fn disc() -> Vec<u8> {
    let mut pixels = Vec::new();
    for i in 0..40 * 40 {
        let r = f64::hypot(f64::from(i % 40) - 19.5, f64::from(i / 40) - 19.5);
        // as a drawing program smooths its edge
        let opacity = (12.5 - r).clamp(0.0, 1.0);
        pixels.extend([0, 0, 0, (255.0 * opacity).round() as u8]);
    }
    let mut out = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_raw(40, 40, pixels).unwrap();
    image.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

fn files() -> InMemory {
    InMemory::new([
        ("cube.obj", CUBE.as_bytes().to_vec()),
        ("plane.nrrd", nrrd()),
        ("disc.png", disc()),
        (
            "broken.ply",
            b"ply\nformat ascii 1.0\nelement vertex 3\n".to_vec(),
        ),
        ("cube.vdb", CUBE.as_bytes().to_vec()),
        (
            "disc.vm",
            b"# a disc\nx var-x\ny var-y\na square x\nb square y\nc add a b\nd sqrt c\nr const 0.8\nout sub d r\n".to_vec(),
        ),
        ("ball.vm", b"x var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\nd add a b\ne add c d\nf sqrt e\nr const 0.8\nout sub f r\n".to_vec()),
        ("broken.vm", b"x var-x\ny cbrt x\n".to_vec()),
    ])
}

fn load_as(
    text: &str,
    language: Language,
    limits: Limits,
    assets: &Assets,
) -> Result<Loaded, Failed> {
    let options = Options {
        limits,
        bare: true,
        ..Options::default()
    };
    let files = Some(Arc::new(files()) as _);
    let name = if language == Language::Json {
        "scene.json"
    } else {
        "scene.star"
    };
    Document::of_text(name, text, language, files, &limits, assets)?.scene(&options)
}

fn load(text: &str) -> Loaded {
    load_as(
        text,
        Language::Starlark,
        Limits::default(),
        &Assets::default(),
    )
    .unwrap_or_else(|e| panic!("{}", e.report))
}

fn said(text: &str, limits: Limits) -> String {
    let failed = load_as(text, Language::Starlark, limits, &Assets::default()).unwrap_err();
    assert!(
        failed.report.position().is_some() || text.is_empty(),
        "{}",
        failed.report
    );
    failed.report.message().to_owned()
}

fn samples(field: &Field) -> Arc<Sampled> {
    match field.node() {
        Node::Sampled(sampled) => sampled.clone(),
        _ => samples(field.children()[0]),
    }
}

#[test]
fn every_kind_of_file_is_a_field() {
    let loaded = load(
        "show(mesh(\"cube.obj\", voxels = 20).round(0.1).move(y = 1))\nshow(grid(\"plane.nrrd\") & box(1.5))\n\
         show(image_shape(\"disc.png\", width = 40).extrude(2))",
    );
    let fields: Vec<_> = loaded
        .scene
        .objects()
        .iter()
        .map(|o| o.field.clone())
        .collect();
    let cube = samples(&fields[0]);
    // 16 cells for a side of 2, and two of air around it
    assert_eq!(
        (cube.grid().nodes(), cube.bounds().max),
        ([21; 3], [1.25; 3])
    );
    assert_eq!(cube.grid().at([10; 3]), -1.0);
    assert_eq!(samples(&fields[1]).slope(), 1.0);
    let disc = samples(&fields[2]);
    assert_eq!(disc.dimension(), Dimension::Two);
    let node = |x: usize, y: usize| f64::from(disc.grid().at([x, y, 0]));
    // nodes are the middles of pixels, and two around them
    for (x, y) in [(21, 21), (30, 21), (35, 40), (2, 2)] {
        let r = f64::hypot(x as f64 - 21.5, y as f64 - 21.5) - 12.0;
        assert!((node(x, y) - r).abs() < 0.2, "{} for {r}", node(x, y));
    }
    assert_eq!(fields[2].facts().dimension, Dimension::Three);
}

/// Lists of operations are formulas: of the plane and of space, alone and in others, and what their distance is, is proven.
#[test]
fn lists_of_operations_are_formulas() {
    let loaded = load(
        "disc = load_vm(\"disc.vm\")\nball = load_vm(\"ball.vm\")\n\
         show(field2d(disc, size = 2).extrude(0.5))\nshow(field(ball, size = 2))\n\
         show(field(lambda p: max(ball(p), disc(p.zy) - 0.1), size = 2))\nshow(field(disc, bounds = ((-1, -1, 0), (1, 1, 1))))",
    );
    for (object, p, expected) in [
        (1, [0.0, 0.6, 0.0], -0.2),
        (1, [0.5, 0.5, 0.5], 0.75f64.sqrt() - 0.8),
        (2, [0.6, 0.0, 0.0], -0.2),
        (2, [0.0, 0.6, 0.75], f64::hypot(0.6, 0.75) - 0.8),
        (3, [0.5, 0.0, 0.7], -0.3),
    ] {
        let field = &loaded.scene.objects()[object].field;
        let Node::Formula(formula) = field.node() else {
            panic!("{:?}", field.node());
        };
        let value = formula.eval(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0;
        let off = (value - expected).abs();
        assert!(
            off < 1e-9,
            "object {object} at {p:?}: {value} for {expected}"
        );
        assert!(formula.is_proven() && formula.slope() < 1.5);
    }
    let disc = &loaded.scene.objects()[0].field;
    assert_eq!(disc.facts().dimension, Dimension::Three);
    assert!(disc.facts().bounds.is_finite());
    let limits = Limits::default();
    for (text, wanted) in [
        ("load_vm(\"none.vm\")", "there is no file \"none.vm\""),
        (
            "load_vm(\"broken.vm\")",
            "\"broken.vm\": line 2: `cbrt` is no operation",
        ),
        ("load_vm(\"disc.png\")", "is not text in UTF-8"),
        (
            "field2d(load_vm(\"ball.vm\"))",
            "at a point of 3 numbers, since it uses z",
        ),
        (
            "field(lambda p: load_vm(\"ball.vm\")(p.x))",
            "at a point of 3 numbers",
        ),
        ("field(lambda p: load_vm(\"ball.vm\")())", "takes one point"),
        ("load_vm(\"ball.vm\")(3)", "at a point of 3 numbers"),
        ("show(load_vm(\"ball.vm\"))", "a formula from a file"),
    ] {
        let said = said(text, limits);
        assert!(said.contains(wanted), "{text}: {said}");
    }
}

#[test]
fn what_loads_is_written_and_read_again() {
    let text = "m = mesh(\"cube.obj\", voxels = 16, sign = \"winding\")\nshow(m | m.move(x = 3), name = \"two\")\n\
                show(grid(\"./plane.nrrd\"))\nshow(image_shape(\"disc.png\", width = 3, level = 0.25).extrude(1))";
    let first = load(text);
    let json = to_text(&expand(&first.scene).unwrap());
    let again = load_as(&json, Language::Json, Limits::default(), &Assets::default())
        .unwrap_or_else(|e| panic!("{}", e.report));
    assert_eq!(to_text(&expand(&again.scene).unwrap()), json);
    for (a, b) in first.scene.objects().iter().zip(again.scene.objects()) {
        assert_eq!(samples(&a.field), samples(&b.field));
    }
    assert!(
        json.contains(r#""mesh": {"file": "cube.obj", "voxels": 16, "sign": "winding"}"#),
        "{json}"
    );
    assert_eq!(again.files.len(), 3);
}

#[test]
fn what_is_wrong_is_said_where_it_stands() {
    let limits = Limits::default();
    for (text, wanted) in [
        ("show(mesh(\"none.obj\"))", "there is no file \"none.obj\""),
        (
            "show(mesh(\"../cube.obj\"))",
            "outside of the scene's folder",
        ),
        ("show(mesh(\"disc.png\"))", "ends in none of .obj, .ply"),
        ("show(mesh(\"broken.ply\"))", "it ends within its header"),
        (
            "show(mesh(\"cube.obj\", voxels = 4))",
            "allowed is 8 to 2047",
        ),
        (
            "show(mesh(\"cube.obj\", voxels = 20.5))",
            "must be a whole number",
        ),
        (
            "show(mesh(\"cube.obj\", sign = \"both\"))",
            "cannot be \"both\"",
        ),
        ("show(grid(\"cube.obj\"))", "neither in .vdb nor in .nrrd"),
        ("show(grid(\"cube.vdb\"))", "no OpenVDB file"),
        (
            "show(image_shape(\"disc.png\", level = 1))",
            "allowed is 0.001 to 0.999",
        ),
        ("show(image_shape(\"cube.obj\"))", "neither like a PNG"),
    ] {
        let said = said(text, limits);
        assert!(said.contains(wanted), "{text}: {said}");
    }
    for (text, limits, wanted) in [
        (
            "show(mesh(\"cube.obj\"))",
            Limits {
                mesh_bytes: 10,
                ..limits
            },
            "`mesh_bytes`",
        ),
        (
            "show(mesh(\"cube.obj\"))",
            Limits {
                mesh_faces: 10,
                ..limits
            },
            "at most 10 are allowed",
        ),
        (
            "show(mesh(\"cube.obj\"))",
            Limits {
                grid_samples: 1000,
                ..limits
            },
            "`grid_samples`",
        ),
        (
            "show(mesh(\"cube.obj\", voxels = 200))",
            Limits {
                memory: 1 << 20,
                ..limits
            },
            "`memory`",
        ),
        (
            "show(mesh(\"cube.obj\", voxels = 200))",
            Limits {
                sampling_seconds: 1e-9,
                ..limits
            },
            "`sampling_seconds`",
        ),
    ] {
        let said = said(text, limits);
        assert!(said.contains(wanted), "{text}: {said}");
    }
    let json =
        r#"{"zeroset": 1, "objects": [{"field": {"mesh": {"file": "cube.obj", "sign": "x"}}}]}"#;
    let failed = load_as(json, Language::Json, limits, &Assets::default()).unwrap_err();
    assert!(
        failed.report.message().contains("\"parity\""),
        "{}",
        failed.report
    );
}

/// Samples are made once, however often and from wherever a scene asks for them.
#[test]
fn samples_are_shared() {
    let loaded = load(
        "show(mesh(\"cube.obj\"))\nshow(mesh(\"./cube.obj\").move(x = 3))\nshow(mesh(\"cube.obj\", voxels = 32))",
    );
    let all: Vec<_> = loaded
        .scene
        .objects()
        .iter()
        .map(|o| samples(&o.field))
        .collect();
    assert!(!Arc::ptr_eq(&all[0], &all[2]));
    assert!(Arc::ptr_eq(all[0].grid(), all[1].grid()));
}

#[derive(Debug, Default)]
struct Memory(Mutex<Vec<(String, Vec<u8>)>>);

impl Shelf for Memory {
    fn get(&self, name: &str) -> Option<Vec<u8>> {
        let kept = self.0.lock().unwrap();
        kept.iter().rfind(|k| k.0 == name).map(|k| k.1.clone())
    }
    fn put(&self, name: &str, bytes: &[u8]) {
        self.0
            .lock()
            .unwrap()
            .push((name.to_owned(), bytes.to_vec()));
    }
}

/// What was sampled in one run is there in the next; what is damaged is made anew, and is the same.
#[test]
fn what_took_long_is_kept() {
    let shelf = Arc::new(Memory::default());
    let text = "show(mesh(\"cube.obj\", voxels = 24))";
    let run = || {
        let assets = Assets::on(shelf.clone());
        let loaded = load_as(text, Language::Starlark, Limits::default(), &assets).unwrap();
        samples(&loaded.scene.objects()[0].field)
    };
    let first = run();
    assert_eq!(shelf.0.lock().unwrap().len(), 1);
    assert_eq!(run(), first);
    assert_eq!(shelf.0.lock().unwrap().len(), 1);
    shelf.0.lock().unwrap()[0].1.truncate(500);
    assert_eq!(run(), first);
    assert_eq!(shelf.0.lock().unwrap().len(), 2);
    // another way of sampling is another thing
    let other = "show(mesh(\"cube.obj\", voxels = 25))";
    load_as(
        other,
        Language::Starlark,
        Limits::default(),
        &Assets::on(shelf.clone()),
    )
    .unwrap();
    assert_eq!(shelf.0.lock().unwrap().len(), 3);
}

/// The scenes that come with the project.
#[test]
fn the_scenes_with_a_mesh_load() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/meshes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "star") {
            let loaded = zeroset_language::load::load(&path, &Options::default());
            let loaded = loaded.unwrap_or_else(|e| panic!("{}", e.report));
            let hare = samples(&loaded.scene.objects()[0].field);
            // it stands on the floor, two cells of 124 above the grid's
            assert!(hare.slope() < 1.74 && hare.bounds().half()[0] > 0.5);
            count += 1;
        }
    }
    assert_eq!(count, 4);
}
