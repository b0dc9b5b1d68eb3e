//! Pictures survive their files, and views show what they say.

use proptest::prelude::*;
use std::io::Cursor;
use std::path::Path;
use zeroset_output::atomic::write_atomically;
use zeroset_output::format::png::Depth;
use zeroset_output::format::read::{ReadError, ReadFailure, read};
use zeroset_output::format::{Metadata, exr, png};
use zeroset_output::picture::Picture;
use zeroset_output::view::{NOTHING, PlaneView};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::settings::ViewTransform;

/// A film whose every number is known: hits in the left half.
fn film(width: u32, height: u32) -> Film {
    let mut film = Film::new(width, height);
    for plane in Plane::ALL {
        let channels = plane.channels();
        for (i, number) in film.plane_mut(plane).iter_mut().enumerate() {
            let x = (i / channels) as u32 % width;
            let hit = x < width / 2;
            *number = match plane {
                Plane::Depth if !hit => f32::INFINITY,
                Plane::Depth => 2.0 + x as f32,
                Plane::Steps => x as f32,
                Plane::Residual if hit => 1e-6 * (x + 1) as f32,
                Plane::Object if hit => (x % 3 + 1) as f32,
                Plane::Residual | Plane::Object => 0.0,
                Plane::Normal if !hit => 0.0,
                Plane::Normal => [0.0, 0.6, -0.8][i % 3],
                _ => (i % 97) as f32 / 96.0,
            };
        }
    }
    film
}

fn saved(
    name: &str,
    fill: impl FnOnce(&mut std::io::BufWriter<&std::fs::File>) -> std::io::Result<()>,
) -> Result<Picture, ReadError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_atomically(&path, fill).unwrap();
    read(&path)
}

fn refused(bytes: &[u8]) -> ReadFailure {
    saved("x", |w| std::io::Write::write_all(w, bytes))
        .unwrap_err()
        .failure
}

fn largest_difference(a: &Picture, b: &Picture) -> f32 {
    assert_eq!([a.width(), a.height()], [b.width(), b.height()]);
    let pairs = a
        .pixels()
        .as_flattened()
        .iter()
        .zip(b.pixels().as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn png_keeps_the_picture_to_its_depth() {
    let picture = Picture::develop(&film(37, 23), ViewTransform::standard(0.5));
    for (depth, error) in [
        (Depth::Eight, 1.0 / 255.0),
        (Depth::Sixteen, 0.51 / 65535.0),
    ] {
        let back = saved("a.png", |w| {
            png::write(w, &picture, depth, &Metadata::default())
        })
        .unwrap();
        assert!(largest_difference(&picture, &back) <= error, "{depth:?}");
    }
}

#[test]
fn exr_keeps_every_number_of_every_plane() {
    use ::exr::prelude::{ReadChannels, ReadLayers};
    let film = film(37, 23);
    let notes = Metadata::new("größe").with("Settings", "{}");
    let mut bytes = Cursor::new(Vec::new());
    exr::write(&mut bytes, &film, &notes).unwrap();
    bytes.set_position(0);
    let back = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer();
    let layer = back
        .all_attributes()
        .from_buffered(bytes)
        .unwrap()
        .layer_data;
    let channel = |name: &str| -> Vec<f32> {
        let channel = layer.channel_data.list.iter().find(|c| c.name == *name);
        channel
            .unwrap_or_else(|| panic!("no channel {name}"))
            .sample_data
            .values_as_f32()
            .collect()
    };
    assert_eq!(
        layer.channel_data.list.len(),
        Plane::ALL.iter().map(|p| p.channels()).sum::<usize>()
    );
    assert_eq!(channel("depth.Z"), film.plane(Plane::Depth));
    assert_eq!(channel("steps.Y"), film.plane(Plane::Steps));
    for (k, name) in ["normal.X", "normal.Y", "normal.Z"].into_iter().enumerate() {
        let wanted: Vec<f32> = film
            .plane(Plane::Normal)
            .iter()
            .copied()
            .skip(k)
            .step_by(3)
            .collect();
        assert_eq!(channel(name), wanted);
    }
    let colour: Vec<f32> = film
        .plane(Plane::Colour)
        .iter()
        .copied()
        .skip(1)
        .step_by(3)
        .collect();
    assert_eq!(channel("G"), colour);
    let attributes = format!("{:?}", layer.attributes);
    assert!(
        attributes.contains("title") && attributes.contains("Settings"),
        "{attributes}"
    );
    let read_back = saved("a.exr", |w| exr::write(w, &film, &notes)).unwrap();
    assert!(
        largest_difference(
            &read_back,
            &Picture::develop(&film, ViewTransform::standard(0.0))
        ) < 1e-6
    );
}

#[test]
fn notes_are_in_the_file_and_name_no_place() {
    let notes = Metadata::new("/home/me/secret/Größe.star")
        .with("Settings", "{\"a\":1}")
        .with("Parameters", "naïve=1");
    let mut bytes = Vec::new();
    png::write(
        &mut bytes,
        &Picture::filled(4, 4, [0.5; 3]),
        Depth::Eight,
        &notes,
    )
    .unwrap();
    let reader = ::png::Decoder::new(Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let info = reader.info();
    let mut found: Vec<(String, String)> = info
        .uncompressed_latin1_text
        .iter()
        .map(|t| (t.keyword.clone(), t.text.clone()))
        .collect();
    found.extend(
        info.utf8_text
            .iter()
            .map(|t| (t.keyword.clone(), t.get_text().unwrap())),
    );
    let has = |key: &str, text: &str| {
        assert!(
            found.contains(&(key.to_owned(), text.to_owned())),
            "{found:?}"
        )
    };
    has("Title", "Größe.star");
    has("Settings", "{\"a\":1}");
    has("Parameters", "naïve=1");
    assert!(info.srgb.is_some());
    assert!(!bytes.windows(6).any(|w| w == b"secret"));
}

#[test]
fn equal_pictures_are_equal_files() {
    let write = || {
        let mut bytes = Vec::new();
        png::write(
            &mut bytes,
            &Picture::develop(&film(50, 20), ViewTransform::standard(0.0)),
            Depth::Eight,
            &Metadata::new("a"),
        )
        .unwrap();
        bytes
    };
    assert_eq!(write(), write());
}

#[test]
fn slow_gradients_show_no_bands() {
    // a sky that grows by 2 levels over 400 rows: without dithering, every row would be of one value
    let sky = Picture::from_fn(64, 400, |_, y| [0.5 + y as f32 / 400.0 * 2.0 / 255.0; 3]);
    let back = saved("a.png", |w| {
        png::write(w, &sky, Depth::Eight, &Metadata::default())
    })
    .unwrap();
    for y in 0..384 {
        let block = (y..y + 16).flat_map(|y| (0..64).map(move |x| (x, y)));
        let (mut sum, mut wanted) = (0.0, 0.0);
        for (x, y) in block {
            sum += back.pixel(x, y).unwrap()[0];
            wanted += sky.pixel(x, y).unwrap()[0];
        }
        assert!((sum - wanted).abs() / 1024.0 < 0.05 / 255.0, "row {y}");
    }
}

#[test]
fn what_is_no_picture_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(
        read(folder.path()).unwrap_err().failure,
        ReadFailure::Special
    ));
    assert!(matches!(
        read(Path::new("/dev/zero")).unwrap_err().failure,
        ReadFailure::Special
    ));
    assert!(matches!(
        read(&folder.path().join("none")).unwrap_err().failure,
        ReadFailure::System(_)
    ));
    assert!(matches!(refused(b""), ReadFailure::Format));
    assert!(matches!(refused(b"GIF89a"), ReadFailure::Format));
    assert!(matches!(
        refused(b"\x89PNG\r\n\x1a\n"),
        ReadFailure::Damaged(_)
    ));
    let mut bytes = Vec::new();
    png::write(
        &mut bytes,
        &Picture::filled(40, 40, [0.3; 3]),
        Depth::Eight,
        &Metadata::default(),
    )
    .unwrap();
    assert!(matches!(
        refused(&bytes[..bytes.len() - 30]),
        ReadFailure::Damaged(_)
    ));
    let mut bytes = Cursor::new(Vec::new());
    exr::write(&mut bytes, &film(40, 40), &Metadata::default()).unwrap();
    let bytes = bytes.into_inner();
    assert!(matches!(
        refused(&bytes[..bytes.len() / 2]),
        ReadFailure::Damaged(_) | ReadFailure::System(_)
    ));
}

#[test]
fn a_huge_size_is_refused_before_it_is_allocated() {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, 1_000_000_000, 1_000_000_000);
    encoder.set_color(::png::ColorType::Rgb);
    drop(encoder.write_header().unwrap());
    assert!(matches!(
        refused(&bytes),
        ReadFailure::Large {
            width: 1_000_000_000,
            height: 1_000_000_000
        }
    ));
}

#[test]
fn grey_palettes_and_opaque_alpha_are_read() {
    let encode = |colour, depth, data: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == ::png::ColorType::Indexed {
            encoder.set_palette(vec![255, 0, 0, 0, 0, 255]);
        }
        encoder
            .write_header()
            .unwrap()
            .write_image_data(data)
            .unwrap();
        saved("x", |w| std::io::Write::write_all(w, &bytes))
    };
    use ::png::{BitDepth, ColorType};
    let pixels = |p: Picture| p.pixels().to_vec();
    assert_eq!(
        pixels(encode(ColorType::Grayscale, BitDepth::Eight, &[0, 255]).unwrap()),
        [[0.0; 3], [1.0; 3]]
    );
    assert_eq!(
        pixels(encode(ColorType::Grayscale, BitDepth::One, &[0x40]).unwrap()),
        [[0.0; 3], [1.0; 3]]
    );
    let colours = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(
        pixels(encode(ColorType::Indexed, BitDepth::Eight, &[0, 1]).unwrap()),
        colours
    );
    let rgba = [255, 0, 0, 255, 0, 0, 255, 255];
    assert_eq!(
        pixels(encode(ColorType::Rgba, BitDepth::Eight, &rgba).unwrap()),
        colours
    );
    let glass = encode(
        ColorType::Rgba,
        BitDepth::Eight,
        &[255, 0, 0, 255, 0, 0, 255, 254],
    )
    .unwrap_err();
    assert!(matches!(glass.failure, ReadFailure::Transparent));
}

#[test]
fn views_show_their_plane() {
    let film = film(80, 70);
    let names: Vec<String> = ["ball", "floor", "a name that is much too long for a legend"]
        .map(String::from)
        .to_vec();
    for plane in Plane::ALL {
        let mut view = PlaneView {
            plane,
            transform: ViewTransform::standard(0.0),
            legend: false,
            objects: &names,
        };
        let plain = view.of(&film);
        assert_eq!([plain.width(), plain.height()], [80, 70], "{plane:?}");
        view.legend = true;
        let explained = view.of(&film);
        let has_legend = matches!(
            plane,
            Plane::Depth | Plane::Steps | Plane::Residual | Plane::Object
        );
        assert_eq!(explained.width() > 80, has_legend, "{plane:?}");
        for y in 0..70 {
            assert!(
                (0..80).all(|x| plain.pixel(x, y) == explained.pixel(x, y)),
                "{plane:?}"
            );
        }
        let miss = plain.pixel(79, 0).unwrap();
        let marked = matches!(
            plane,
            Plane::Depth | Plane::Residual | Plane::Object | Plane::Normal
        );
        assert_eq!(miss == NOTHING, marked, "{plane:?}");
        assert!(
            plain
                .pixels()
                .as_flattened()
                .iter()
                .all(|c| (0.0..=1.0).contains(c)),
            "{plane:?}"
        );
    }
    let objects = PlaneView {
        plane: Plane::Object,
        transform: ViewTransform::standard(0.0),
        legend: false,
        objects: &[],
    }
    .of(&film);
    let colour = |x| objects.pixel(x, 0).unwrap();
    assert!(colour(0) != colour(1) && colour(1) != colour(2) && colour(0) == colour(3));
    let normal = PlaneView {
        plane: Plane::Normal,
        transform: ViewTransform::standard(0.0),
        legend: false,
        objects: &[],
    }
    .of(&film);
    let shown = normal.pixel(0, 0).unwrap().map(|c| (c * 1000.0).round());
    assert_eq!(shown, [500.0, 800.0, 100.0]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_bytes_make_the_reader_panic(exr in any::<bool>(), at in 0usize..400, with in any::<u8>(), cut in 0usize..2000) {
        let mut bytes = Cursor::new(Vec::new());
        if exr {
            exr::write(&mut bytes, &film(8, 8), &Metadata::default()).unwrap();
        } else {
            png::write(&mut bytes, &Picture::filled(8, 8, [0.3; 3]), Depth::Eight, &Metadata::default()).unwrap();
        }
        let mut bytes = bytes.into_inner();
        let at = at % bytes.len();
        bytes[at] = with;
        bytes.truncate(cut);
        let _ = saved("x", |w| std::io::Write::write_all(w, &bytes));
    }

    #[test]
    fn views_survive_any_number(numbers in prop::collection::vec(any::<f32>(), 64), plane in 0usize..10) {
        let mut film = Film::new(8, 66);
        for (i, x) in film.plane_mut(Plane::ALL[plane]).iter_mut().enumerate() {
            *x = numbers[i % 64];
        }
        let view = PlaneView { plane: Plane::ALL[plane], transform: ViewTransform::standard(1.0), legend: true, objects: &["a".to_owned()] };
        let picture = view.of(&film);
        prop_assert!(picture.pixels().as_flattened().iter().all(|c| (0.0..=1.0).contains(c)));
    }
}

/// Counts pixels, and wants no more after so many of them.
struct Watcher {
    done: std::sync::atomic::AtomicU64,
    most: u64,
}

impl zeroset_scene::render::Observer for Watcher {
    fn advance(&self, done: u64, total: u64) {
        let before = self
            .done
            .fetch_add(done, std::sync::atomic::Ordering::Relaxed);
        assert!(before + done <= total);
    }
    fn is_cancelled(&self) -> bool {
        self.done.load(std::sync::atomic::Ordering::Relaxed) >= self.most
    }
}

#[test]
fn files_tell_how_far_they_are_and_end_when_they_are_not_wanted() {
    use std::sync::atomic::AtomicU64;
    use zeroset_output::atomic::{WriteFailure, write_atomically};
    let film = film(300, 200);
    let picture = Picture::develop(&film, ViewTransform::standard(0.0));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    let total = 300 * 200;
    for most in [0, 1, 20_000, 59_000, u64::MAX] {
        for name in ["png", "exr"] {
            std::fs::write(&path, "old").unwrap();
            let watcher = Watcher {
                done: AtomicU64::new(0),
                most,
            };
            let notes = Metadata::default();
            let written = write_atomically(&path, |writer| match name {
                "png" => png::write_watched(writer, &picture, Depth::Sixteen, &notes, &watcher),
                _ => exr::write_watched(writer, &film, &notes, &watcher),
            });
            let done = watcher.done.into_inner();
            if most > total {
                written.unwrap();
                assert_eq!(done, total, "{name}");
            } else {
                let failure = written.unwrap_err().failure;
                assert!(
                    matches!(failure, WriteFailure::Cancelled),
                    "{name}: {failure}"
                );
                assert_eq!(std::fs::read(&path).unwrap(), b"old", "{name}");
            }
            assert_eq!(
                std::fs::read_dir(folder.path()).unwrap().count(),
                1,
                "{name}"
            );
        }
    }
}
