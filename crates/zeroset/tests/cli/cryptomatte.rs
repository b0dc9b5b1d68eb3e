//! Mattes, read back from the file as its specification says.

use crate::run::Folder;
use exr::prelude::*;
use std::collections::BTreeMap;

/// Two things that hide each other in part, one that stands alone, and the sky.
const SCENE: &str = "show(sphere(0.7).move(x = -0.3), name = \"ball\")
show(box(0.9).turn(y = 30 + 90 * time()).move(x = 0.5, z = 0.6), name = \"Würfel \\\"1\\\"\")
show(sphere(0.3).move(x = -1.7, y = 0.6))
camera(eye = (0, 0.6, 5), target = (-0.3, 0, 0), fov = 40CAMERA)
";

/// Channels by name, and the text attributes of a file.
struct Read {
    channels: BTreeMap<String, Vec<f32>>,
    texts: BTreeMap<String, String>,
}

fn read(folder: &Folder, name: &str) -> Read {
    let image = read_first_flat_layer_from_file(folder.path(name)).unwrap();
    let layer = image.layer_data;
    let channels = layer.channel_data.list.into_iter().map(|channel| {
        let numbers = channel.sample_data.values_as_f32().collect();
        (channel.name.to_string(), numbers)
    });
    let others = (layer.attributes.other.into_iter()).chain(image.attributes.other);
    Read {
        channels: channels.collect(),
        texts: others
            .filter_map(|(name, value)| match value {
                AttributeValue::Text(text) => {
                    let text = String::from_utf8(text.bytes().to_vec()).unwrap();
                    Some((name.to_string(), text))
                }
                _ => None,
            })
            .collect(),
    }
}

impl Read {
    /// The matte of a name of the manifest: what all ranks that have its id have.
    fn matte(&self, name: &str) -> Vec<f32> {
        let manifest: BTreeMap<String, String> =
            serde_json::from_str(&self.texts["cryptomatte/3ae39a5/manifest"]).unwrap();
        let id = u32::from_str_radix(&manifest[name], 16).unwrap();
        let mut out = vec![0.0; self.channels["CryptoObject00.R"].len()];
        for (ids, shares) in self.ranks() {
            for (i, (found, share)) in ids.iter().zip(shares).enumerate() {
                if found.to_bits() == id {
                    out[i] += share;
                }
            }
        }
        out
    }

    fn ranks(&self) -> impl Iterator<Item = (&[f32], &[f32])> {
        let layers = ["CryptoObject00", "CryptoObject01", "CryptoObject02"];
        let pairs = layers
            .into_iter()
            .flat_map(|l| [(l, "R", "G"), (l, "B", "A")]);
        pairs.map(|(layer, id, share)| {
            let channel = |letter| self.channels[&format!("{layer}.{letter}")].as_slice();
            (channel(id), channel(share))
        })
    }
}

#[track_caller]
fn assert_near(a: &[f32], b: &[f32], most: f32) {
    assert_eq!(a.len(), b.len());
    let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    let worst = off.fold(0.0, f32::max);
    assert!(worst < most, "{worst}");
}

/// All shares together are how much of a pixel is covered, which the renderer finds by sums of its own; and the matte of a thing that
/// stands alone is the coverage of a picture that shows nothing else.
#[test]
fn shares_are_what_is_covered() {
    for (camera, flags) in [
        ("", "--spp 16"),
        ("", "--aa supersample=5,filter=box --seed 9"),
        ("", "--aa none"),
        (", shutter = 0.2", "--spp 16"),
        (", aperture = 0.2, focus = 4", "--spp 16"),
    ] {
        let scene = SCENE.replace("CAMERA", camera);
        let folder = Folder::with(&scene);
        let flags = format!("--size 70x40 --backend cpu {flags}");
        folder.good(&format!("render scene.star {flags} --cryptomatte -o a.exr"));
        let a = read(&folder, "a.exr");
        let mut sum = vec![0.0; 70 * 40];
        let mut smooth = 0;
        let mut before = vec![f32::INFINITY; 70 * 40];
        for (ids, shares) in a.ranks() {
            for (i, (id, share)) in ids.iter().zip(shares).enumerate() {
                assert!(*share <= before[i] && *share >= 0.0);
                assert_eq!(*id == 0.0, *share == 0.0);
                (sum[i], before[i]) = (sum[i] + share, *share);
                smooth += usize::from(*share > 0.01 && *share < 0.99);
            }
        }
        assert_near(&sum, &a.channels["coverage.Y"], 1e-5);
        assert_eq!(smooth > 50, !flags.contains("--aa none"), "{smooth}");
        let named: Vec<Vec<f32>> = ["ball", "Würfel \"1\"", "3"].map(|n| a.matte(n)).into();
        for matte in &named {
            assert!(matte.iter().sum::<f32>() > 20.0);
        }
        let all: Vec<f32> = (0..70 * 40)
            .map(|i| named.iter().map(|m| m[i]).sum())
            .collect();
        assert_near(&all, &sum, 1e-5);
        let alone: Vec<&str> = scene.lines().skip(2).collect();
        folder.write("alone.star", alone.join("\n"));
        folder.good(&format!("render alone.star {flags} -o alone.exr"));
        let alone = read(&folder, "alone.exr");
        assert_near(&named[2], &alone.channels["coverage.Y"], 1e-5);
        // nothing else of the file is another one
        folder.good(&format!("render scene.star {flags} -o plain.exr"));
        let mut plain = read(&folder, "plain.exr");
        for (name, numbers) in &a.channels {
            match plain.channels.remove(name) {
                Some(same) => assert!(same == *numbers, "{name}"),
                None => assert!(name.starts_with("CryptoObject"), "{name}"),
            }
        }
        assert_eq!(plain.channels.len(), 0);
    }
}

#[test]
fn attributes_are_those_of_the_specification() {
    let folder = Folder::with(&SCENE.replace("CAMERA", ""));
    folder.good(
        "render scene.star --size 20x10 --aa coverage --cryptomatte --transparent -o scene.exr",
    );
    let found = read(&folder, "scene.exr");
    assert!(found.channels.contains_key("A"));
    let text = |name: &str| found.texts[&format!("cryptomatte/3ae39a5/{name}")].as_str();
    assert_eq!(text("name"), "CryptoObject");
    assert_eq!(text("hash"), "MurmurHash3_32");
    assert_eq!(text("conversion"), "uint32_to_float32");
    assert_eq!(
        text("manifest"),
        // the ids are from another implementation of the hash
        format!(
            "{{\"ball\":\"{}\",\"Würfel \\\"1\\\"\":\"{}\",\"3\":\"{}\"}}",
            "645d3bc4", "fb1a3c40", "0fc7a1b4"
        )
    );
    // it is made again with its mattes
    folder.good("render scene.exr -o again.exr");
    assert!(folder.read("scene.exr") == folder.read("again.exr"));
    folder.bad("render scene.star --cryptomatte", 2, &["only an .exr"]);
    folder.bad(
        "render scene.star --cryptomatte -o a.png",
        2,
        &["only an .exr"],
    );
}
