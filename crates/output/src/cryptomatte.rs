//! Mattes of objects: how much of each pixel belongs to which object, as Cryptomatte (Friedman and Jones 2015).
//!
//! Programs that compose pictures select objects by name in it, with edges as smooth as those of the picture: the samples are those of the
//! picture, and count for the pixels around them as the picture's filter says.
//!
//! A pixel has [`RANKS`] pairs of an [`id`] and its share, the largest first, in layers of two pairs each: `CryptoObject00` to
//! `CryptoObject02`. Attributes of the file name them: see [`Mattes::attributes`].

use crate::display;
use std::collections::HashMap;
use zeroset_scene::accumulator::{Accumulator, Sum};
use zeroset_scene::film::Plane;
use zeroset_scene::render::{Observer, Prepared, RenderError};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter, Integrator, Occlusion};
use zeroset_scene::valid::SceneError;
use zeroset_shade::sampling::{point, radius, scramble, weight};

/// Objects that a pixel can belong to.
pub const RANKS: usize = 6;
/// The name of the layers, without their number.
pub const LAYER: &str = "CryptoObject";
/// Samples of a picture that has not several of each pixel, though its edges are smooth.
const USUAL: u32 = 16;
/// The most samples that are taken: shares are in 256ths then.
const MOST: u32 = 256;
/// Bytes a pixel that mattes take while they are made: the pairs, once more as they are written, and what belongs to a sample.
pub const BYTES: u64 = 8 * RANKS as u64 + 4 * 2 * RANKS as u64 + 12;

/// MurmurHash3 for 32 bits (Appleby 2011), of a seed of 0.
pub fn murmur3(text: &[u8]) -> u32 {
    let mixed = |k: u32| {
        let k = k.wrapping_mul(0xcc9e_2d51).rotate_left(15);
        k.wrapping_mul(0x1b87_3593)
    };
    let (words, rest) = text.as_chunks::<4>();
    let mut hash = words.iter().fold(0u32, |hash, word| {
        let hash = (hash ^ mixed(u32::from_le_bytes(*word))).rotate_left(13);
        hash.wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    let mut last = [0; 4];
    last[..rest.len()].copy_from_slice(rest);
    hash ^= mixed(u32::from_le_bytes(last));
    hash ^= text.len() as u32;
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

/// The number that stands for a name: its hash as a number of single precision, neither subnormal nor infinite nor none
/// (`uint32_to_float32` of the specification).
pub fn id(name: &str) -> f32 {
    let hash = murmur3(name.as_bytes());
    let exponent = ((hash >> 23) & 0xff).clamp(1, 254);
    f32::from_bits((hash & 0x807f_ffff) | (exponent << 23))
}

/// Makes a scene ready.
pub type Prepare<'a> = dyn Fn(&Scene) -> Result<Box<dyn Prepared>, RenderError> + 'a;

/// The mattes of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Mattes {
    size: [u32; 2],
    names: Vec<String>,
    /// Of each pixel, the pairs of an id and its share, one after the other.
    ranks: Vec<[[f32; 2]; RANKS]>,
}

/// Tells of one of many pictures as a part of them all.
struct OfMany<'a> {
    observer: &'a dyn Observer,
    count: u32,
}

impl Observer for OfMany<'_> {
    fn advance(&self, rays: u64, total: u64) {
        self.observer.advance(rays, total * u64::from(self.count));
    }

    fn is_cancelled(&self) -> bool {
        self.observer.is_cancelled()
    }
}

/// How much of a pixel belongs to an object: its number plus 1, and the sum of weights.
type Part = (u32, f32);

/// What belongs to which object, in the making.
struct Parts {
    size: [u32; 2],
    /// The first objects that are found in a pixel. Number 0 with weights is what is behind all, without any it is none.
    first: Vec<[Part; RANKS]>,
    /// Further ones, by pixel.
    more: HashMap<usize, Vec<Part>>,
}

impl Parts {
    fn new(size: [u32; 2]) -> Parts {
        Parts {
            size,
            first: vec![[(0, 0.0); RANKS]; size[0] as usize * size[1] as usize],
            more: HashMap::new(),
        }
    }

    /// A sample in a pixel counts for it as much as the weight says.
    fn add(&mut self, pixel: usize, object: u32, weight: f32) {
        for (held, sum) in &mut self.first[pixel] {
            if *held == object || *sum == 0.0 {
                (*held, *sum) = (object, *sum + weight);
                return;
            }
        }
        let more = self.more.entry(pixel).or_default();
        match more.iter_mut().find(|(held, _)| *held == object) {
            Some((_, sum)) => *sum += weight,
            None => more.push((object, weight)),
        }
    }

    /// Adds a sample of every pixel, which found these objects.
    fn add_sample(&mut self, objects: &[f32], index: u32, filter: Option<Filter>, seed: u32) {
        let [width, height] = self.size;
        for y in 0..height {
            for x in 0..width {
                let object = objects[(y * width + x) as usize] as u32;
                let Some(filter) = filter else {
                    self.add((y * width + x) as usize, object, 1.0);
                    continue;
                };
                let [u, v] = point(index, scramble(x, y, seed)).map(|place| place - 0.5);
                let reach = radius(filter) as i64;
                for dy in -reach..=reach {
                    for dx in -reach..=reach {
                        let (to_x, to_y) = (i64::from(x) + dx, i64::from(y) + dy);
                        let inside = (0..i64::from(width)).contains(&to_x)
                            && (0..i64::from(height)).contains(&to_y);
                        let share = weight(filter, u - dx as f32) * weight(filter, v - dy as f32);
                        if inside && share != 0.0 {
                            let pixel = to_y as usize * width as usize + to_x as usize;
                            self.add(pixel, object, share);
                        }
                    }
                }
            }
        }
    }

    /// The shares of a pixel by the ids of objects, the largest first. Objects of one name are one.
    fn ranked(&self, pixel: usize, ids: &[f32]) -> [[f32; 2]; RANKS] {
        let more = self.more.get(&pixel).map_or(&[][..], Vec::as_slice);
        let (mut all, mut shares) = (0.0, Vec::<[f32; 2]>::new());
        for (object, weight) in self.first[pixel].iter().chain(more) {
            // the lobes of a filter can make less than nothing of what is hardly seen
            let weight = weight.max(0.0);
            all += weight;
            let Some(id) = (*object as usize).checked_sub(1).and_then(|at| ids.get(at)) else {
                continue;
            };
            match shares.iter_mut().find(|[held, _]| held == id) {
                Some([_, sum]) => *sum += weight,
                None => shares.push([*id, weight]),
            }
        }
        shares.retain(|[_, share]| *share > 0.0);
        shares.sort_by(|a, b| b[1].total_cmp(&a[1]).then(a[0].total_cmp(&b[0])));
        let mut ranks = [[0.0; 2]; RANKS];
        for (rank, [id, share]) in ranks.iter_mut().zip(shares) {
            *rank = [id, share / all];
        }
        ranks
    }
}

impl Mattes {
    /// The mattes of a scene, at its size, from the samples that its picture has, or the first 256 of them. `prepare` makes a scene
    /// ready, on whatever renders the picture.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub fn rendered(
        prepare: &Prepare<'_>,
        scene: &Scene,
        observer: &dyn Observer,
    ) -> Result<Mattes, RenderError> {
        let mut scene = scene.clone();
        scene.edit_moments(|parts| {
            // what is hit, and nothing else that takes time
            parts.lights.clear();
            parts.environment = None;
            parts.objects.iter_mut().for_each(|o| o.occlusion = None);
            parts.settings.occlusion = Occlusion::None;
            parts.settings.integrator = Integrator::Direct;
            if let Antialias::Coverage { .. } = parts.settings.antialias {
                let (samples, filter) = (USUAL, Filter::Box);
                parts.settings.antialias = Antialias::Supersample { samples, filter };
            }
            Ok::<(), SceneError>(())
        })?;
        let settings = *scene.settings();
        let mut prepared = prepare(&scene)?;
        let mut sums = Accumulator::new(settings.size, settings.antialias, &[Plane::Object]);
        let mut parts = Parts::new(settings.size);
        let count = sums.wanted().min(MOST);
        let observer = OfMany { observer, count };
        for index in 0..count {
            // of one sample the nearest object is the one that it found
            sums.clear();
            prepared.sample(scene.camera(), index..index + 1, &mut sums, &observer)?;
            parts.add_sample(sums.sum(Sum::Object), index, sums.filter(), settings.seed);
        }
        let names: Vec<String> = scene.objects().iter().map(|o| o.name.clone()).collect();
        Ok(Mattes::of(&parts, names))
    }

    fn of(parts: &Parts, names: Vec<String>) -> Mattes {
        let ids: Vec<f32> = names.iter().map(|name| id(name)).collect();
        let pixels = 0..parts.first.len();
        Mattes {
            size: parts.size,
            names,
            ranks: pixels.map(|pixel| parts.ranked(pixel, &ids)).collect(),
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The pairs of an id and a share of a pixel, the largest share first; `[0, 0]` where there are no more. Together the shares are what
    /// the objects cover of the pixel, if not more of them than [`RANKS`] do.
    pub fn pixel(&self, x: u32, y: u32) -> &[[f32; 2]; RANKS] {
        &self.ranks[y as usize * self.size[0] as usize + x as usize]
    }

    /// The channels by name, `CryptoObject00.R` and so on.
    pub fn channels(&self) -> impl Iterator<Item = (String, Vec<f32>)> {
        (0..2 * RANKS).map(|channel| {
            let (layer, letter) = (channel / 4, ["R", "G", "B", "A"][channel % 4]);
            let numbers = self.ranks.iter().map(|r| r.as_flattened()[channel]);
            (format!("{LAYER}{layer:02}.{letter}"), numbers.collect())
        })
    }

    /// The attributes that say what the channels are, and which id stands for which name.
    pub fn attributes(&self) -> [(String, String); 4] {
        let key = format!("{:08x}", murmur3(LAYER.as_bytes()));
        let manifest: serde_json::Map<String, serde_json::Value> = (self.names.iter())
            .map(|name| (name.clone(), format!("{:08x}", id(name).to_bits()).into()))
            .collect();
        let manifest = serde_json::Value::Object(manifest).to_string();
        let manifest = display::json(&manifest).into_owned();
        [
            ("name", LAYER.to_owned()),
            ("hash", "MurmurHash3_32".to_owned()),
            ("conversion", "uint32_to_float32".to_owned()),
            ("manifest", manifest),
        ]
        .map(|(name, text)| (format!("cryptomatte/{}/{name}", &key[..7]), text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the specification: what it names its attributes after, and the hash's own vectors (Appleby's SMHasher).
    #[test]
    fn hashes_are_the_published_ones() {
        for (text, hash) in [
            ("", 0),
            ("test", 0xba6b_d213),
            ("Hello, world!", 0xc036_3e43),
            ("The quick brown fox jumps over the lazy dog", 0x2e4f_f723),
            ("crypto_object", 0xf834_d0a6),
            ("crypto_material", 0xbda5_30a2),
        ] {
            assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
        }
    }

    #[test]
    fn ids_are_plain_numbers() {
        for name in (0..20_000)
            .map(|i| format!("object {i}"))
            .chain([String::new()])
        {
            let (id, hash) = (id(&name), murmur3(name.as_bytes()));
            assert!(id.is_normal(), "{name}: {id}");
            let (kept, exponent) = (0x807f_ffff, (hash >> 23) & 0xff);
            assert_eq!(id.to_bits() & kept, hash & kept);
            if (1..=254).contains(&exponent) {
                assert_eq!(id.to_bits(), hash);
            }
        }
    }

    /// More objects than there are ranks, two of one name, and the sky, against sums by hand.
    #[test]
    fn shares_are_ranked() {
        let mut parts = Parts::new([1, 1]);
        let names: Vec<String> = (0..10).map(|i| format!("{}", i.min(8))).collect();
        for (object, weight) in (0..=10)
            .map(|i| (i, 1.0 + i as f32))
            .chain([(3, 0.5), (0, 1.0)])
        {
            parts.add(0, object, weight);
        }
        parts.add(0, 1, -2.5);
        let mattes = Mattes::of(&parts, names);
        // 1 and 1 of the sky, -0.5 of the first counts as nothing
        let all = 2.0 + (3.0 + 4.5 + 5.0 + 6.0 + 7.0 + 8.0 + 9.0 + 10.0 + 11.0);
        let right = [
            ("8", 21.0),
            ("7", 9.0),
            ("6", 8.0),
            ("5", 7.0),
            ("4", 6.0),
            ("3", 5.0),
        ];
        for ([found, share], (name, weight)) in mattes.pixel(0, 0).iter().zip(right) {
            assert_eq!(*found, id(name));
            assert!((share - weight / all).abs() < 1e-6, "{name}: {share}");
        }
    }

    #[test]
    fn names_are_in_the_manifest() {
        let names = ["ball", "\u{1b}[31m \"ö\""].map(str::to_owned);
        let mattes = Mattes::of(&Parts::new([2, 1]), names.to_vec());
        let attributes = mattes.attributes();
        assert_eq!(
            attributes[0],
            ("cryptomatte/3ae39a5/name".to_owned(), LAYER.to_owned())
        );
        let manifest = &attributes[3].1;
        assert!(!manifest.contains('\u{1b}'), "{manifest}");
        let read: HashMap<String, String> = serde_json::from_str(manifest).unwrap();
        for name in names {
            let bits = u32::from_str_radix(&read[&name], 16).unwrap();
            assert_eq!(f32::from_bits(bits), id(&name));
        }
        let channels: Vec<String> = mattes.channels().map(|(name, _)| name).collect();
        assert_eq!(channels.len(), 12);
        assert_eq!(
            (&*channels[0], &*channels[11]),
            ("CryptoObject00.R", "CryptoObject02.A")
        );
    }
}
