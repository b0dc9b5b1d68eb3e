//! Checkpoints go on to the bit, and whatever is not the file that is wanted is refused with its reason.

use std::ops::Range;
use std::sync::Arc;
use zeroset_output::format::checkpoint::{CheckpointFailure, Identity, read, write};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::film::Plane;
use zeroset_scene::progressive::Progressive;
use zeroset_scene::render::{Observer, Prepared, RenderError, Silent, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Filter;

/// Gives numbers that follow from the seed.
struct Numbers(u32);

impl Prepared for Numbers {
    fn update(&mut self, _: Arc<Scene>) -> Result<(), RenderError> {
        Ok(())
    }

    fn sample(
        &mut self,
        _: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        _: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let mut state = self.0 | 1;
        for (_, numbers) in into.sums_mut() {
            for x in numbers {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                *x = 1.0 + (state >> 8) as f32 / 1e7;
            }
        }
        into.count(samples.end);
        Ok(Statistics::default())
    }

    fn reseed(&mut self, seed: u32) -> Result<(), RenderError> {
        self.0 = seed;
        Ok(())
    }
}

fn empty() -> Progressive {
    let planes = [Plane::Colour, Plane::Depth];
    Progressive::new([7, 5], Filter::Tent, &planes, 3, 0.0)
}

fn advance(picture: &mut Progressive, rounds: u32) {
    let camera = Camera {
        eye: glam::Vec3::ZERO,
        axes: glam::Mat3::IDENTITY,
        lens: Lens::Pinhole { fov: 1.0 },
        near: 0.0,
        far: 1.0,
        aperture: 0.0,
        focus: 0.0,
    };
    for _ in 0..rounds {
        (picture.advance(&mut Numbers(0), &camera, None, &Silent)).unwrap();
    }
}

fn identity() -> Identity {
    Identity::default()
        .with("size", "7x5")
        .with("scene", "abc")
        .with("camera", "{\"eye\": 1}")
}

fn kept() -> Vec<u8> {
    let (mut picture, mut bytes) = (empty(), Vec::new());
    advance(&mut picture, 9);
    write(&mut bytes, &identity(), &picture).unwrap();
    bytes
}

#[test]
fn what_is_kept_goes_on_to_the_bit() {
    let (mut whole, mut later) = (empty(), empty());
    advance(&mut whole, 12);
    read(&kept()[..], &identity(), &mut later).unwrap();
    assert_eq!(later.rounds(), 9);
    advance(&mut later, 3);
    assert_eq!((later.rays(), later.noise()), (whole.rays(), whole.noise()));
    let bits = |picture: &Progressive| {
        let mut bytes = Vec::new();
        write(&mut bytes, &identity(), picture).unwrap();
        bytes
    };
    assert!(bits(&later) == bits(&whole));
    assert!(later.film() == whole.film());
}

/// Every byte counts: with another one, or without those that follow, a file is refused, and nothing of it is left.
#[test]
fn what_is_damaged_is_refused() {
    let bytes = kept();
    let refused = |bytes: &[u8], what: &dyn Fn() -> String| {
        let mut picture = empty();
        let error = read(bytes, &identity(), &mut picture).expect_err(&what());
        assert!(
            !matches!(
                error,
                CheckpointFailure::System(_) | CheckpointFailure::Foreign(_)
            ),
            "{}: {error}",
            what()
        );
        assert_eq!((picture.rounds(), picture.rays()), (0, 0));
        assert!(picture.film() == empty().film());
    };
    for i in 0..bytes.len() {
        let mut other = bytes.clone();
        other[i] ^= 1 << (i % 8);
        refused(&other, &|| format!("another byte {i}"));
    }
    for length in 0..bytes.len() {
        refused(&bytes[..length], &|| format!("{length} bytes"));
    }
    let longer = [&bytes[..], &[0]].concat();
    refused(&longer, &|| "a byte more".to_owned());
}

#[test]
fn what_is_of_another_picture_is_refused_by_name() {
    let bytes = kept();
    for (what, wanted) in [
        ("size", Identity::default().with("size", "7x6")),
        (
            "scene",
            Identity::default().with("size", "7x5").with("scene", "abd"),
        ),
        ("camera", Identity::default().with("camera", "{}")),
        ("renderer", Identity::default().with("renderer", "CPU")),
    ] {
        match read(&bytes[..], &wanted, &mut empty()) {
            Err(CheckpointFailure::Foreign(difference)) => assert_eq!(difference.what, what),
            other => panic!("{what}: {other:?}"),
        }
    }
    // the same in another order, and with line breaks in a text
    let broken = Identity::default()
        .with("a", "b\nsize 1x1")
        .with("size", "7x5");
    let (mut picture, mut bytes) = (empty(), Vec::new());
    advance(&mut picture, 1);
    write(&mut bytes, &broken, &picture).unwrap();
    read(&bytes[..], &broken, &mut empty()).unwrap();
}

#[test]
fn other_files_are_told_apart() {
    let format = read(&b"\x89PNG\r\n\x1a\n...."[..], &identity(), &mut empty());
    assert!(matches!(format, Err(CheckpointFailure::Format)));
    let mut newer = kept();
    newer[8] = 2;
    let version = read(&newer[..], &identity(), &mut empty());
    assert!(matches!(version, Err(CheckpointFailure::Version(2))));
}
