//! Files of samples: what was written is read again, what is wrong is refused.

use zeroset_volume::bake::{Alone, Bake};
use zeroset_volume::check::mend;
use zeroset_volume::file::{FileError, VolumeFormat, read, write};
use zeroset_volume::mesh::Mesh;
use zeroset_volume::volume::Volume;

const MOST: u64 = 1 << 20;

/// A box of 2 x 1 x 0.5 about (3, 0, 0).
fn baked(band: Option<f64>) -> Volume {
    let points = (0..8)
        .map(|i| {
            [
                3.0 + (i & 1) as f32 * 2.0,
                (i >> 1 & 1) as f32,
                (i >> 2) as f32 * 0.5,
            ]
        })
        .collect();
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = sides
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .collect();
    let mut mesh = Mesh::new(points, faces).unwrap();
    let check = mend(&mut mesh);
    let bake = Bake {
        voxels: 70,
        band,
        ..Bake::default()
    };
    bake.bake(&mesh, &check, &Alone).unwrap().with_name("a box")
}

#[test]
fn dense_volumes_come_back_to_the_bit() {
    let volume = baked(None);
    for (format, _) in VolumeFormat::ALL {
        let again = read(&write(&volume, format), format, MOST).unwrap();
        assert_eq!(again.values(), volume.values(), "{format:?}");
        assert_eq!(
            (again.nodes(), again.origin(), again.step()),
            (volume.nodes(), volume.origin(), volume.step())
        );
        assert_eq!(again.name(), "a box");
    }
}

/// What is beyond the band is left out: the box is that of what is left, and within it nothing is lost.
#[test]
fn narrow_bands_are_small_and_come_back() {
    let volume = baked(Some(2.0));
    let bytes = write(&volume, VolumeFormat::Vdb);
    assert!(
        bytes.len() < volume.values().len() * 4,
        "{} bytes",
        bytes.len()
    );
    let again = read(&bytes, VolumeFormat::Vdb, MOST).unwrap();
    assert_eq!(again.background(), volume.background());
    let [nx, ny, nz] = again.nodes();
    let first = [0, 1, 2]
        .map(|k| ((again.origin()[k] - volume.origin()[k]) / volume.step()[k]).round() as u32);
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let here = again.values()[(i + nx * (j + ny * k)) as usize];
                let [mx, my, _] = volume.nodes();
                let at = (i + first[0]) + mx * ((j + first[1]) + my * (k + first[2]));
                assert_eq!(here, volume.values()[at as usize], "{i} {j} {k}");
            }
        }
    }
    // a NRRD has them all
    let nrrd = write(&volume, VolumeFormat::Nrrd);
    assert_eq!(read(&nrrd, VolumeFormat::Nrrd, MOST).unwrap(), volume);
}

#[test]
fn damaged_files_are_errors() {
    for band in [None, Some(2.0)] {
        for (format, _) in VolumeFormat::ALL {
            let bytes = write(&baked(band), format);
            let step = (bytes.len() / 400).max(1);
            for end in (0..bytes.len()).step_by(step).chain(0..500) {
                assert!(read(&bytes[..end], format, MOST).is_err());
            }
            for at in (0..bytes.len()).step_by(step).chain(0..800) {
                let mut bytes = bytes.clone();
                bytes[at] ^= 0xff;
                let _ = read(&bytes, format, MOST);
            }
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    let volume = baked(None);
    for (format, _) in VolumeFormat::ALL {
        let refused = read(&write(&volume, format), format, 1000);
        assert!(matches!(refused, Err(FileError::Many { most: 1000, .. })));
    }
    let say = |text: &str| {
        read(text.as_bytes(), VolumeFormat::Nrrd, MOST)
            .unwrap_err()
            .to_string()
    };
    for (text, wanted) in [
        ("", "it is empty"),
        ("hello\n", "line 1: an NRRD file begins"),
        ("NRRD0004\ntype: block\n", "line 2: samples of this type"),
        ("NRRD0004\ndimension: 2\n", "line 2: only what has 3"),
        ("NRRD0004\ntype: float\n\n", "no `sizes`"),
        (
            "NRRD0004\ntype: float\nsizes: 2 2 2\nencoding: gzip\n\n",
            "`raw` only",
        ),
        (
            "NRRD0004\ntype: float\nsizes: 2 2 2\nencoding: raw\n\n12",
            "the file is not whole",
        ),
        (
            "NRRD0004\ntype: uint8\nsizes: 1 1 2\nencoding: raw\n\n12",
            "every axis takes 2 to 2048",
        ),
        (
            "NRRD0004\ntype: uint8\nsizes: 2 2 2\nspacings: 0 1 1\nencoding: raw\n\n12345678",
            "distances must be above 0",
        ),
    ] {
        assert!(say(text).contains(wanted), "{text:?}: {}", say(text));
    }
    let said = read(b"hello, this is no grid", VolumeFormat::Vdb, MOST).unwrap_err();
    assert!(said.to_string().contains("no OpenVDB file"));
}

#[test]
fn samples_of_other_types() {
    let text = "NRRD0005\n# by hand\ntype: short\ndimension: 3\nsizes: 2 2 2\nspacings: 1 2 3\nencoding: raw\nendian: big\n\n";
    let mut bytes = text.as_bytes().to_vec();
    (0..8_i16).for_each(|i| bytes.extend((i - 4).to_be_bytes()));
    let volume = read(&bytes, VolumeFormat::Nrrd, MOST).unwrap();
    assert_eq!(
        volume.values(),
        [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
    );
    assert_eq!(volume.step(), [1.0, 2.0, 3.0]);
}
