//! `zeroset bake`, `zeroset edt`, and what is kept of a mesh from one run to the next.

use crate::run::{BALL, Folder};
use std::fs;

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
                    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

/// The program without the user's cache.
fn uncached(folder: &Folder, arguments: &str) -> (Option<i32>, String, String) {
    let output = (folder.command(arguments))
        .env("ZEROSET_CACHE", "off")
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn meshes_and_scenes_become_files_that_scenes_take() {
    let folder = Folder::with(BALL);
    folder.write("cube.obj", CUBE);
    let (code, out, err) = uncached(&folder, "bake cube.obj -o cube.vdb --voxels 24 --json");
    assert_eq!(code, Some(0), "{err}");
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&json["mesh"]["watertight"], &json["mesh"]["faces"]),
        (&true.into(), &12.into())
    );
    assert_eq!(json["mesh"]["volume"], 8.0);
    assert!(
        err.contains("12 faces over 8 vertices in 1 parts, 2 x 2 x 2, watertight"),
        "{err}"
    );
    let (code, _, err) = uncached(&folder, "bake scene.star -o ball.nrrd --voxels 20");
    assert_eq!(
        (code, err.contains("21x21x21 samples")),
        (Some(0), true),
        "{err}"
    );
    folder.write(
        "files.star",
        "show(grid(\"cube.vdb\") | grid(\"ball.nrrd\").move(x = 3))\n",
    );
    let (code, out, err) = uncached(&folder, "check files.star --json");
    assert_eq!(code, Some(0), "{err}{out}");
    // what was there stays whole when something is wrong
    for (arguments, exit, wanted) in [
        (
            "bake cube.obj -o cube.png",
            2,
            "neither in .vdb nor in .nrrd",
        ),
        ("bake none.obj -o cube.vdb", 4, "none.obj"),
        ("bake scene.txt -o cube.vdb", 2, "none of .obj, .ply"),
        ("bake cube.obj -o cube.vdb --voxels 5", 2, "8..=2047"),
        ("bake cube.obj -o cube.vdb --voxels 2000", 2, "grid_samples"),
        (
            "bake cube.obj -o cube.vdb --limit mesh_bytes=10",
            4,
            "mesh_bytes",
        ),
    ] {
        let before = folder.read("cube.vdb");
        let (code, _, err) = uncached(&folder, arguments);
        assert_eq!(code, Some(exit), "{arguments}: {err}");
        // messages are broken into lines
        let said = err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(wanted), "{arguments}: {err}");
        assert_eq!(folder.read("cube.vdb"), before);
    }
    folder.write("floor.star", "show(plane())\n");
    let (code, _, err) = uncached(&folder, "bake floor.star -o floor.vdb");
    assert_eq!((code, err.contains("no ends")), (Some(3), true), "{err}");
}

#[test]
fn a_mesh_is_sampled_once() {
    let folder = Folder::with("show(mesh(\"cube.obj\", voxels = 24))\n");
    folder.write("cube.obj", CUBE);
    let cache = folder.path("kept");
    let picture = |name: &str| {
        let run = format!("render scene.star --size 32x24 -o {name}.png");
        let output = folder
            .command(&run)
            .env("ZEROSET_CACHE", &cache)
            .output()
            .unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        folder.read(&format!("{name}.png"))
    };
    let kept = || {
        let names = fs::read_dir(&cache).unwrap().map(|e| e.unwrap().path());
        names.collect::<Vec<_>>()
    };
    let first = picture("first");
    assert_eq!(kept().len(), 1);
    assert_eq!(picture("second"), first);
    assert_eq!(kept().len(), 1);
    // damaged, it is made anew
    fs::write(&kept()[0], "NRRD0004\n").unwrap();
    assert_eq!(picture("third"), first);
    assert!(fs::metadata(&kept()[0]).unwrap().len() > 1000);
    // a cache that cannot be written is no error
    fs::remove_dir_all(&cache).unwrap();
    fs::write(&cache, "a file").unwrap();
    assert_eq!(picture("fourth"), first);
}

/// The picture of a transform: dark within, bright outside, red between.
#[test]
fn transforms_are_drawn() {
    let folder = Folder::with(
        "show(sphere(0.8), material(color = \"white\", emission = \"white\"))\nsky(top = \"black\", horizon = \"black\", bottom = \"black\")\n",
    );
    folder.good("render scene.star --size 40x40 -o ball.png");
    folder.good("edt ball.png -o distances.png --level 0.3");
    let decoder = png::Decoder::new(
        fs::File::open(folder.path("distances.png"))
            .map(std::io::BufReader::new)
            .unwrap(),
    );
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let pixel = |x: usize, y: usize| &pixels[3 * (x + 40 * y)..][..3];
    let (middle, corner) = (pixel(20, 20), pixel(0, 0));
    assert!(middle[0] < 60 && middle[0] == middle[2], "{middle:?}");
    assert!(corner[0] > 140 && corner[0] == corner[2], "{corner:?}");
    assert!((0..40).any(|x| pixel(x, 20) == [255, 0, 0]));
    for method in ["brute", "chamfer", "dead-reckoning"] {
        folder.good(&format!(
            "edt ball.png -o {method}.png --level 0.3 --method {method}"
        ));
    }
    let refused = folder.run("edt ball.png -o x.png --level 2");
    assert_eq!(
        (refused.code, refused.err.contains("no boundary")),
        (Some(1), true),
        "{}",
        refused.err
    );
}
