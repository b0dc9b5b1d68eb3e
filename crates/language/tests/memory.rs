//! What loading may take: every byte is charged before it is asked for, files are read and decoded once, and what is honest
//! fits. One process for itself, whose peak is measured.

use measure::{BYTES, SECONDS, alone, peak_memory, timed};
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;
use zeroset_language::json;
use zeroset_language::limits::Limits;
use zeroset_language::load::{Language, Loaded, Options, load, load_text};
use zeroset_scene::film::{self, Plane};
use zeroset_scene::material::{Image, Pattern};

mod measure;

fn folder(scene: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("main.star"), scene).unwrap();
    folder
}

/// Why a scene is refused, in time and memory.
fn error_of(folder: &Path, name: &str) -> String {
    let (loaded, seconds) = timed(|| load(&folder.join(name), &Options::default()));
    let failed = loaded.expect_err(name);
    // a debug build takes longer to parse, which nobody interrupts
    let most = if cfg!(debug_assertions) {
        2.0 * SECONDS
    } else {
        SECONDS
    };
    assert!(seconds < most, "{name}: {seconds:.2} s");
    if let Some(peak) = peak_memory() {
        assert!(peak < BYTES, "{name}: {} MiB", peak >> 20);
    }
    let message = failed.report.message().to_string();
    let shown = format!("{:?}", miette::Report::new(*failed.report));
    assert!(shown.len() < 6000, "{name}: {} bytes", shown.len());
    message
}

/// All limits but the clock, for what is honest on a machine of any speed.
fn patient() -> Options {
    Options {
        limits: Limits {
            seconds: 60.0,
            ..Limits::default()
        },
        bare: true,
        ..Options::default()
    }
}

fn good(result: Result<Loaded, zeroset_language::load::Failed>) -> Loaded {
    result.unwrap_or_else(|failed| panic!("{:?}", miette::Report::new(*failed.report)))
}

fn images(loaded: &Loaded) -> Vec<&Arc<Image>> {
    (loaded.scene.materials().iter())
        .filter_map(|m| match &m.pattern {
            Pattern::Triplanar { image, .. } => Some(image),
            _ => None,
        })
        .collect()
}

/// An image that is asked for ten thousand times, under several names, is decoded once and held once.
#[test]
fn an_image_is_decoded_once() {
    let _alone = alone();
    let script = "for i in range(2500):\n    for n in [\"tile.png\", \"./tile.png\", \"sub/../tile.png\"][:2] + [\"link.png\"]:\n        \
                  m = material(color = triplanar(n, size = 1 + i))\nshow(sphere(), material(color = triplanar(\"tile.png\", size = 7)))\n\
                  show(sphere(), material(color = triplanar(\"link.png\", size = 8)))";
    let folder = folder(script);
    let tile = image::RgbImage::from_fn(2048, 2048, |x, y| image::Rgb([x as u8, y as u8, 7]));
    tile.save(folder.path().join("tile.png")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("tile.png", folder.path().join("link.png")).unwrap();
    #[cfg(not(unix))]
    std::fs::copy(
        folder.path().join("tile.png"),
        folder.path().join("link.png"),
    )
    .unwrap();
    let loaded = good(load(&folder.path().join("main.star"), &patient()));
    let images = images(&loaded);
    assert_eq!(images.len(), 2);
    #[cfg(unix)]
    assert!(Arc::ptr_eq(images[0], images[1]));
    // IEC 61966-2-1 at 7 of 255, and at the pixel's own coordinates
    let right = |c: u8| {
        (
            f32::from(c) / 255.0 / 12.92,
            ((f32::from(c) / 255.0 + 0.055) / 1.055).powf(2.4),
        )
    };
    let pixel = images[0].pixels[5 * 2048 + 200];
    assert!((pixel.x - right(200).1).abs() < 1e-5, "{pixel}");
    assert!((pixel.y - right(5).0).abs() < 1e-6, "{pixel}");
    assert!((pixel.z - right(7).0).abs() < 1e-6, "{pixel}");
    if let Some(peak) = peak_memory() {
        assert!(peak < BYTES, "{} MiB", peak >> 20);
    }
}

/// Images of all kinds, against `image`'s own conversion.
#[test]
fn kinds_of_images() {
    let _alone = alone();
    let folder = folder("show(sphere(), material(color = triplanar(\"tile.png\")))");
    let at = folder.path().join("tile.png");
    let value = |x: u32, y: u32| (x * 17 + y * 31) as u8;
    let wide = |x: u32, y: u32| (x * 4099 + y * 17) as u16;
    let kinds: Vec<image::DynamicImage> = vec![
        image::GrayImage::from_fn(16, 16, |x, y| image::Luma([value(x, y)])).into(),
        image::GrayAlphaImage::from_fn(16, 16, |x, y| image::LumaA([value(x, y), 9])).into(),
        image::RgbImage::from_fn(16, 16, |x, y| image::Rgb([value(x, y), value(y, x), 3])).into(),
        image::RgbaImage::from_fn(16, 16, |x, y| {
            image::Rgba([value(x, y), value(y, x), 3, 40])
        })
        .into(),
        image::DynamicImage::ImageRgb16(image::ImageBuffer::from_fn(16, 16, |x, y| {
            image::Rgb([wide(x, y), 1, 65535])
        })),
        image::DynamicImage::ImageLuma16(image::ImageBuffer::from_fn(16, 16, |x, y| {
            image::Luma([wide(x, y)])
        })),
    ];
    for kind in kinds {
        kind.save(&at).unwrap();
        let loaded = good(load(&folder.path().join("main.star"), &patient()));
        let right = kind.to_rgb32f();
        for (pixel, srgb) in images(&loaded)[0].pixels.iter().zip(right.pixels()) {
            for (x, srgb) in pixel.to_array().into_iter().zip(srgb.0) {
                let linear = zeroset_scene::colour::linear_channel(f64::from(srgb)) as f32;
                assert!(
                    (x - linear).abs() < 1e-6,
                    "{x} and {linear} of {:?}",
                    kind.color()
                );
            }
        }
    }
}

/// A JPEG, against what it was made from; and what is left of one is no image.
#[test]
fn photographs() {
    let _alone = alone();
    let folder = folder("show(sphere(), material(color = triplanar(\"tile.jpg\")))");
    let at = folder.path().join("tile.jpg");
    // smooth, so that little is lost
    let made = image::RgbImage::from_fn(48, 40, |x, y| {
        image::Rgb([(x * 5) as u8, (y * 6) as u8, 128])
    });
    made.save(&at).unwrap();
    let loaded = good(load(&folder.path().join("main.star"), &patient()));
    let found = images(&loaded)[0];
    assert_eq!((found.width, found.height), (48, 40));
    for (pixel, srgb) in found.pixels.iter().zip(made.pixels()) {
        for (x, srgb) in pixel.to_array().into_iter().zip(srgb.0) {
            let near = |off: f64| {
                zeroset_scene::colour::linear_channel(f64::from(srgb) / 255.0 + off) as f32
            };
            assert!((near(-0.05)..near(0.05)).contains(&x), "{x} for {srgb}");
        }
    }
    let bytes = std::fs::read(&at).unwrap();
    std::fs::write(&at, &bytes[..20]).unwrap();
    let error = error_of(folder.path(), "main.star");
    assert!(error.contains("no image"), "{error}");
}

/// Images whose header promises more than there is, more of them than fit, and more than time allows.
#[test]
fn images_that_are_too_much() {
    let _alone = alone();
    let folder = folder("show(sphere(), material(color = triplanar(\"tile.png\")))");
    // a PNG that says it has 65,535 x 65,535 pixels of 8 bytes
    let mut png =
        b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\xff\xff\0\0\xff\xff\x10\x06\0\0\0\x8d\xb9\xee\xbc"
            .to_vec();
    png.extend([0; 64]);
    std::fs::write(folder.path().join("tile.png"), &png).unwrap();
    let error = error_of(folder.path(), "main.star");
    assert!(error.contains("tile.png"), "{error}");
    let mut script = String::new();
    let tile = image::RgbImage::from_fn(2000, 2000, |x, y| image::Rgb([x as u8, y as u8, 7]));
    tile.save(folder.path().join("0.png")).unwrap();
    for i in 0..40 {
        if i > 0 {
            std::fs::copy(
                folder.path().join("0.png"),
                folder.path().join(format!("{i}.png")),
            )
            .unwrap();
        }
        writeln!(
            script,
            "show(sphere(), material(color = triplanar(\"{i}.png\")))"
        )
        .unwrap();
    }
    std::fs::write(folder.path().join("many.star"), &script).unwrap();
    let error = error_of(folder.path(), "many.star");
    // a machine that is slow enough is stopped by the clock
    assert!(
        error.contains("limit `memory`")
            || error.contains("limit `seconds`")
            || error.contains("longer"),
        "{error}"
    );
    // three textures of four million pixels are honest
    std::fs::write(
        folder.path().join("few.star"),
        script.lines().take(3).collect::<Vec<_>>().join("\n"),
    )
    .unwrap();
    good(load(&folder.path().join("few.star"), &patient()));
    // the same by JSON
    let materials: Vec<String> = (0..40)
        .map(|i| format!(r#"{{"pattern": {{"kind": "triplanar", "image": {{"path": "{i}.png"}}, "size": 1, "sharpness": 4}}, "specular": 0, "shininess": 10, "metallic": 0, "roughness": 1, "emission": [0, 0, 0]}}"#))
        .collect();
    let json = format!(
        r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{}}}}}}], "materials": [{}]}}"#,
        materials.join(",")
    );
    std::fs::write(folder.path().join("many.json"), json).unwrap();
    let error = error_of(folder.path(), "many.json");
    assert!(
        error.contains("memory") || error.contains("longer"),
        "{error}"
    );
}

/// Sixty-two files of four megabytes, each full of words and signs.
#[test]
fn sources_that_are_too_much() {
    let _alone = alone();
    for (what, line) in [
        ("lists", format!("x = [{}]\n", vec!["0"; 500].join(","))),
        ("names", "a\n".to_string()),
        ("calls", "f()\n".to_string()),
        ("sums", "a+a\n".to_string()),
        ("functions", "def f(): pass\n".to_string()),
        ("texts", format!("{}\n", vec!["\"\""; 300].join(","))),
        ("dicts", format!("x = {{{}}}\n", vec!["0:0"; 300].join(","))),
        ("comments", "#\n".to_string()),
    ] {
        let text = line.repeat((4 << 20) / line.len());
        let mut script = String::new();
        let folder = folder("");
        for i in 0..62 {
            std::fs::write(folder.path().join(format!("{i}.star")), &text).unwrap();
            writeln!(script, "load(\"{i}.star\", x{i} = \"x\")").unwrap();
        }
        script += "show(sphere())";
        std::fs::write(folder.path().join("main.star"), &script).unwrap();
        let error = error_of(folder.path(), "main.star");
        assert!(
            error.contains("memory")
                || error.contains("longer")
                || error.contains("steps")
                || error.contains('x'),
            "{what}: {error}"
        );
    }
    // one file under many names is one file
    let folder = folder("");
    let text = "x = 1\n".repeat(50_000);
    std::fs::write(folder.path().join("0.star"), text).unwrap();
    let mut script = "load(\"0.star\", x0 = \"x\")\n".to_string();
    #[cfg(unix)]
    for i in 1..60 {
        std::os::unix::fs::symlink("0.star", folder.path().join(format!("{i}.star"))).unwrap();
        writeln!(script, "load(\"{i}.star\", x{i} = \"x\")").unwrap();
    }
    script += "show(sphere(x0))";
    std::fs::write(folder.path().join("main.star"), script).unwrap();
    good(load(&folder.path().join("main.star"), &patient()));
}

/// Files whose syntax trees are nearly as large as they may be: what was charged for them is what they take.
#[test]
fn sources_that_just_fit() {
    let _alone = alone();
    for (what, line, tokens) in [
        (
            "lists",
            format!("x = [{}]\n", vec!["0"; 500].join(",")),
            1004,
        ),
        ("sums", "a+a\n".to_string(), 4),
        ("calls", "f()\n".to_string(), 4),
        ("texts", format!("{}\n", vec!["\"\""; 300].join(",")), 600),
        ("statements", "a\n".to_string(), 2),
    ] {
        let text = format!(
            "a = 1\ndef f(): pass\n{}show(sphere())\n",
            line.repeat(950_000 / tokens)
        );
        match load_text("full.star", &text, Language::Starlark, None, &patient()) {
            Ok(_) => {}
            // the passes over the tree have limits of their own
            Err(failed) => println!("{what}: {}", failed.report),
        }
        if let Some(peak) = peak_memory() {
            println!("{what}: {} MiB", peak >> 20);
            assert!(peak < BYTES, "{what}: {} MiB", peak >> 20);
        }
    }
}

/// As many objects as the limit allows, written by hand or by a program, on one line or on many.
#[test]
fn ten_thousand_objects() {
    let _alone = alone();
    let n = Limits::default().objects;
    let star: String = (0..n)
        .map(|i| {
            format!(
                "show(sphere(0.4).move(x = {}, z = {}), \"{}\", name = \"ball {i}\")\n",
                i % 100,
                i / 100,
                ["red", "#123456"][i as usize % 2]
            )
        })
        .collect();
    let ball = |i: u64| {
        format!(
            r#"{{"name": "ball {i}", "field": {{"place": {{"offset": [{}, 0, {}], "of": {{"sphere": {{"radius": 0.4}}}}}}}}, "material": {}}}"#,
            i % 100,
            i / 100,
            i % 2
        )
    };
    let material = r##"{"pattern": {"kind": "solid", "colour": "#123"}, "specular": 0, "shininess": 10, "metallic": 0, "roughness": 1, "emission": [0, 0, 0]}"##;
    let json = |between: &str| {
        let balls: Vec<String> = (0..n).map(ball).collect();
        format!(
            r#"{{"zeroset": 1, "materials": [{material}, {material}], "objects": [{}]}}"#,
            balls.join(between)
        )
    };
    let mut seconds: Vec<f64> = Vec::new();
    for (language, text) in [
        (Language::Starlark, star),
        (Language::Json, json(",\n  ")),
        (Language::Json, json(",")),
    ] {
        let (loaded, reading) =
            timed(|| good(load_text("many", &text, language, None, &patient())));
        assert_eq!(loaded.scene.objects().len() as u64, n);
        let last = loaded
            .scene
            .objects()
            .last()
            .unwrap()
            .place
            .clone()
            .unwrap();
        let lines = text.matches('\n').count() as u32;
        if lines == 0 {
            let column = text.rfind("{\"name\"").unwrap() as u32 + 1;
            assert_eq!((last.1, last.2), (1, column));
        } else {
            assert_eq!(
                last.1,
                if language == Language::Json {
                    lines + 1
                } else {
                    lines
                }
            );
        }
        // and what it is written as can be read
        let (written, writing) = timed(|| json::to_text(&json::expand(&loaded.scene).unwrap()));
        let again = || load_text("again.json", &written, Language::Json, None, &patient());
        let (_, reading_again) = timed(|| good(again()));
        seconds.extend([reading, writing, reading_again]);
    }
    // places that were searched from the beginning of the text took minutes
    assert!(seconds.iter().all(|s| *s < 120.0), "{seconds:.2?}");
    println!("seconds to load, write and read {n} objects: {seconds:.2?}");
}

/// A picture's size is refused before anything of that size is allocated, with an estimate.
#[test]
fn pictures_that_are_too_large() {
    let _alone = alone();
    for [width, height] in [[1_000_000, 67], [67, 1_000_000], [8192, 8192]] {
        let star = format!("render(size = ({width}, {height}))\nshow(sphere())");
        let json = format!(
            r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{}}}}}}], "settings": {{"size": [{width}, {height}]}}}}"#
        );
        for (text, language) in [(star, Language::Starlark), (json, Language::Json)] {
            let result = load_text("large", &text, language, None, &patient());
            let refused = result.err().map(|f| f.report.message().to_string());
            // columns are tiles too, of which only the first column is used
            let estimate =
                film::bytes([width, height], &[Plane::Colour]) + film::scratch([width, height]);
            assert_eq!(
                refused.is_some(),
                estimate > Limits::default().memory,
                "{width}x{height}: {refused:?}"
            );
            if let Some(message) = refused {
                assert!(
                    message.contains("limit `memory`") && message.contains("iB of memory"),
                    "{message}"
                );
            }
        }
    }
    let options = Options {
        size: Some([67_108_864, 1]),
        ..Options::default()
    };
    let failed = load_text(
        "a.star",
        "show(sphere())",
        Language::Starlark,
        None,
        &options,
    )
    .unwrap_err();
    assert!(
        failed.report.message().contains("memory"),
        "{}",
        failed.report
    );
    let limits = Limits::default();
    // what people ask for
    assert_eq!(
        limits.check_picture([8192, 8192], &[Plane::Colour], 12),
        Ok(())
    );
    assert_eq!(limits.check_picture([3840, 2160], &Plane::ALL, 128), Ok(()));
    assert_eq!(limits.check_picture([1, 1], &Plane::ALL, 128), Ok(()));
    let error = limits
        .check_picture([8192, 8192], &Plane::ALL, 128)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("8192x8192") && error.contains("12 GiB") && error.contains("2048 MiB"),
        "{error}"
    );
    // no overflow, whatever is asked for
    assert!(
        limits
            .check_picture([u32::MAX; 2], &Plane::ALL, u64::MAX)
            .is_err()
    );
    assert_eq!(
        Limits::NONE.check_picture([u32::MAX; 2], &[Plane::Colour], 0),
        Ok(())
    );
}
