//! Reads a grid of OpenVDB, of single or half precision, packed by zlib, Blosc or not.

use super::{FileError, blosc, check_count, mask, vdb};
use crate::volume::Volume;
use zeroset_number::Grid;

pub(super) fn read(bytes: &[u8], most: u64) -> Result<Volume, FileError> {
    let mut from = From { bytes, at: 0 };
    if from.take(8, "its head")? != vdb::MAGIC {
        return Err(FileError::Byte {
            at: 0,
            reason: "this is no OpenVDB file".into(),
        });
    }
    let version = from.u32("its head")?;
    if version < vdb::OLDEST {
        return Err(FileError::Unsupported(format!(
            "it is of version {version} of the format: {} (OpenVDB 3, 2015) is the oldest that is read",
            vdb::OLDEST
        )));
    }
    from.take(8, "its head")?;
    let placed = from.take(1, "its head")?[0] != 0;
    from.take(36, "its head")?;
    from.metadata()?;
    let count = from.u32("the number of grids")?;
    let mut other = None;
    for _ in 0..count {
        let name = from.text()?;
        let kind = from.text()?;
        let parent = from.text()?;
        let (grid, blocks, end) = (from.u64()?, from.u64()?, from.u64()?);
        let half = kind == "Tree_float_5_4_3_HalfFloat";
        if (half || kind == "Tree_float_5_4_3") && parent.is_empty() {
            if placed {
                from.jump(grid)?;
            }
            return one(&mut from, &name, half, placed.then_some(blocks), most);
        }
        other = other.or(Some(kind));
        if !placed {
            break;
        }
        from.jump(end)?;
    }
    Err(FileError::Unsupported(match other {
        Some(kind) => format!(
            "it has no grid of single precision (`Tree_float_5_4_3`), but one of `{}`",
            kind.chars()
                .take(60)
                .filter(|c| !c.is_control())
                .collect::<String>()
        ),
        None => "it has no grids".into(),
    }))
}

fn one(
    from: &mut From<'_>,
    name: &str,
    half: bool,
    blocks: Option<u64>,
    most: u64,
) -> Result<Volume, FileError> {
    // what stands behind this sign numbers grids of one name
    let mut name = name.split('\u{1e}').next().unwrap_or_default().to_owned();
    let compression = from.u32("a grid's head")?;
    let mut fog = false;
    for (key, value) in from.metadata()? {
        match key.as_str() {
            "name" => name = String::from_utf8_lossy(value).into_owned(),
            "class" => fog = value == b"fog volume",
            _ => {}
        }
    }
    let (origin, step) = transform(from)?;
    from.u32("a tree's head")?;
    let mut tree = Tree {
        compression,
        half,
        background: from.f32()?,
        tiles: Vec::new(),
        leaves: Vec::new(),
    };
    tree.topology(from)?;
    if let Some(at) = blocks {
        from.jump(at)?;
    }
    // the box of what is active
    let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
    let mut hold = |first: [i64; 3], last: [i64; 3]| {
        for k in 0..3 {
            low[k] = low[k].min(first[k]);
            high[k] = high[k].max(last[k]);
        }
    };
    for leaf in &tree.leaves {
        for n in (0..512).filter(|n| mask::get(&leaf.active, *n)) {
            let at = place(leaf.origin, n, 3, 0);
            hold(at, at);
        }
    }
    for tile in tree.tiles.iter().filter(|t| t.active) {
        hold(tile.origin, tile.origin.map(|o| o + tile.side - 1));
    }
    if low[0] > high[0] {
        return Err(FileError::Bare { name });
    }
    // two nodes at least along each axis
    for k in 0..3 {
        high[k] = high[k].max(low[k] + 1);
    }
    let sides = [0, 1, 2].map(|k| (high[k] - low[k] + 1) as u64);
    if sides.iter().any(|s| *s > u64::from(Grid::MOST)) {
        return Err(FileError::Many { nodes: sides, most });
    }
    let count = check_count(sides, most)?;
    let mut box_of = Box3 {
        low,
        sides: sides.map(|s| s as usize),
        values: vec![tree.background; count],
    };
    // blocks do not overlap in a tree: what they fill is no more than there is
    let mut filled = 0;
    for tile in &tree.tiles {
        filled += box_of.fill(tile);
        if filled > count {
            return Err(FileError::Unsupported(
                "its blocks overlap: the file is damaged".into(),
            ));
        }
    }
    let (leaves, background) = (std::mem::take(&mut tree.leaves), tree.background);
    for leaf in &leaves {
        let active = from.take(64, "the samples")?.to_vec();
        let values = values(from, 512, &active, &tree)?;
        for (n, value) in values.into_iter().enumerate() {
            box_of.set(place(leaf.origin, n, 3, 0), value);
        }
    }
    let mut values = box_of.values;
    if fog {
        let apart = step.iter().fold(f64::INFINITY, |a, b| a.min(*b)) as f32;
        values.iter_mut().for_each(|v| *v = (0.5 - *v) * apart);
    }
    let first = [0, 1, 2].map(|k| origin[k] + step[k] * low[k] as f64);
    let volume = Volume::new(sides.map(|s| s as u32), first, step, values)?;
    Ok(volume
        .with_background((!fog && background > 0.0).then_some(background))
        .with_name(name))
}

/// Where the n-th slot of a node is: of 2^bits slots a side, each 2^span samples wide.
fn place(origin: [i64; 3], n: usize, bits: usize, span: usize) -> [i64; 3] {
    let side = (1 << bits) - 1;
    let slot = |shift: usize| ((n >> shift & side) << span) as i64;
    [
        origin[0] + slot(2 * bits),
        origin[1] + slot(bits),
        origin[2] + slot(0),
    ]
}

/// Blocks of equal samples that are kept.
const MOST_TILES: usize = 1 << 20;

/// Samples that are all the same.
struct Tile {
    origin: [i64; 3],
    side: i64,
    value: f32,
    active: bool,
}

struct Leaf {
    origin: [i64; 3],
    active: [u8; 64],
}

struct Tree {
    compression: u32,
    half: bool,
    background: f32,
    tiles: Vec<Tile>,
    leaves: Vec<Leaf>,
}

impl Tree {
    fn topology(&mut self, from: &mut From<'_>) -> Result<(), FileError> {
        let (tiles, children) = (from.u32("a tree's root")?, from.u32("a tree's root")?);
        for _ in 0..tiles {
            let origin = from.place()?;
            let value = from.f32()?;
            let active = from.take(1, "a tree's root")?[0] != 0;
            let side = 1 << (vdb::UPPER.0 + vdb::UPPER.1);
            self.tiles.push(Tile {
                origin,
                side,
                value,
                active,
            });
        }
        for _ in 0..children {
            let origin = from.place()?;
            self.node(from, origin, &[vdb::UPPER, vdb::LOWER])?;
        }
        Ok(())
    }

    fn node(
        &mut self,
        from: &mut From<'_>,
        origin: [i64; 3],
        levels: &[(usize, usize)],
    ) -> Result<(), FileError> {
        const WHERE: &str = "a tree's nodes";
        let [(bits, span), below @ ..] = levels else {
            let mut active = [0; 64];
            active.copy_from_slice(from.take(64, WHERE)?);
            self.leaves.push(Leaf { origin, active });
            return Ok(());
        };
        let slots = 1 << (3 * bits);
        let children = from.take(slots / 8, WHERE)?.to_vec();
        let active = from.take(slots / 8, WHERE)?.to_vec();
        let values = values(from, slots, &active, self)?;
        for n in (0..slots).filter(|n| !mask::get(&children, *n)) {
            let active = mask::get(&active, n);
            // what is outside and inactive is what everything is without it
            if active || values[n] != self.background {
                if self.tiles.len() >= MOST_TILES {
                    return Err(FileError::Unsupported(format!(
                        "it has more than {MOST_TILES} blocks of equal samples"
                    )));
                }
                self.tiles.push(Tile {
                    origin: place(origin, n, *bits, *span),
                    side: 1 << span,
                    value: values[n],
                    active,
                });
            }
        }
        for n in (0..slots).filter(|n| mask::get(&children, *n)) {
            self.node(from, place(origin, n, *bits, *span), below)?;
        }
        Ok(())
    }
}

/// The values of a node: those that are active, and what the others are.
fn values(
    from: &mut From<'_>,
    count: usize,
    active: &[u8],
    tree: &Tree,
) -> Result<Vec<f32>, FileError> {
    const WHERE: &str = "the samples";
    let at = from.at;
    let kind = from.take(1, WHERE)?[0] as i8;
    if !(vdb::ALL_BACKGROUND..=vdb::EVERY).contains(&kind) {
        return Err(FileError::Byte {
            at,
            reason: format!("there are no nodes of kind {kind}"),
        });
    }
    let mut one = if kind == vdb::ALL_BACKGROUND {
        tree.background
    } else {
        -tree.background
    };
    let mut other = tree.background;
    if matches!(kind, vdb::ONE | vdb::EITHER_OF_ONE | vdb::EITHER_OF_TWO) {
        // of single precision even where the others are of half
        one = from.f32()?;
        if kind == vdb::EITHER_OF_TWO {
            other = from.f32()?;
        }
    }
    let chosen = match kind {
        vdb::EITHER | vdb::EITHER_OF_ONE | vdb::EITHER_OF_TWO => {
            from.take(count / 8, WHERE)?.to_vec()
        }
        _ => Vec::new(),
    };
    let masked = tree.compression & vdb::ACTIVE_MASK != 0 && kind != vdb::EVERY;
    let stored = if masked { mask::count(active) } else { count };
    let size = if tree.half { 2 } else { 4 };
    // of no numbers of half precision nothing is stored, not even how long it is
    let bytes = if tree.half && stored == 0 {
        Vec::new()
    } else {
        from.packed(stored * size, tree.compression)?
    };
    let mut numbers = bytes.chunks_exact(size).map(|b| match b {
        [a, b, c, d] => f32::from_le_bytes([*a, *b, *c, *d]),
        [a, b] => half(u16::from_le_bytes([*a, *b])),
        _ => 0.0,
    });
    let mut next = || numbers.next().unwrap_or(0.0);
    if !masked {
        return Ok((0..count).map(|_| next()).collect());
    }
    Ok((0..count)
        .map(|n| {
            if mask::get(active, n) {
                next()
            } else if !chosen.is_empty() && mask::get(&chosen, n) {
                other
            } else {
                one
            }
        })
        .collect())
}

/// A number of half precision (IEEE 754).
fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    sign * match exponent {
        0 => fraction * 2.0_f32.powi(-24),
        31 if fraction == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        e => (1.0 + fraction / 1024.0) * 2.0_f32.powi(e - 15),
    }
}

/// The samples within a box.
struct Box3 {
    low: [i64; 3],
    sides: [usize; 3],
    values: Vec<f32>,
}

impl Box3 {
    fn set(&mut self, at: [i64; 3], value: f32) {
        let mut i = [0; 3];
        for k in 0..3 {
            match usize::try_from(at[k] - self.low[k]) {
                Ok(n) if n < self.sides[k] => i[k] = n,
                _ => return,
            }
        }
        self.values[i[0] + self.sides[0] * (i[1] + self.sides[1] * i[2])] = value;
    }

    /// Fills what a tile has of the box. How many samples those are.
    fn fill(&mut self, tile: &Tile) -> usize {
        let mut ranges = [(0, 0); 3];
        for k in 0..3 {
            let first = (tile.origin[k] - self.low[k]).clamp(0, self.sides[k] as i64);
            let last = (tile.origin[k] + tile.side - self.low[k]).clamp(0, self.sides[k] as i64);
            if first >= last {
                return 0;
            }
            ranges[k] = (first as usize, last as usize);
        }
        for z in ranges[2].0..ranges[2].1 {
            for y in ranges[1].0..ranges[1].1 {
                let row = self.sides[0] * (y + self.sides[1] * z);
                self.values[row + ranges[0].0..row + ranges[0].1].fill(tile.value);
            }
        }
        ranges.iter().map(|r| r.1 - r.0).product()
    }
}

/// The first sample and the distances between samples.
fn transform(from: &mut From<'_>) -> Result<([f64; 3], [f64; 3]), FileError> {
    let kind = from.text()?;
    let (origin, step) = match kind.as_str() {
        "UniformScaleTranslateMap" | "ScaleTranslateMap" => {
            let (origin, step) = (from.three()?, from.three()?);
            from.take(4 * 24, "a transform")?;
            (origin, step)
        }
        "UniformScaleMap" | "ScaleMap" => {
            let step = from.three()?;
            from.take(4 * 24, "a transform")?;
            ([0.0; 3], step)
        }
        "TranslationMap" => (from.three()?, [1.0; 3]),
        "AffineMap" | "UnitaryMap" => {
            let mut m = [0.0; 16];
            for x in &mut m {
                *x = f64::from_bits(from.u64()?);
            }
            let straight = (0..16).all(|i| matches!(i, 0 | 5 | 10 | 12..) || m[i] == 0.0);
            if !straight {
                return Err(FileError::Unsupported(
                    "its grid is turned or sheared: bake it along the axes, and turn the field in the scene".into(),
                ));
            }
            ([m[12], m[13], m[14]], [m[0], m[5], m[10]])
        }
        _ => {
            return Err(FileError::Unsupported(format!(
                "its grid lies in space by a `{}`, which is not read",
                kind.chars()
                    .take(60)
                    .filter(|c| !c.is_control())
                    .collect::<String>()
            )));
        }
    };
    Ok((origin, step))
}

struct From<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> From<'a> {
    fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], FileError> {
        let end = self.at.checked_add(count);
        let bytes = end.and_then(|end| self.bytes.get(self.at..end));
        self.at += bytes.map_or(0, <[u8]>::len);
        bytes.ok_or(FileError::Cut(what))
    }

    /// Goes on at another byte, never at an earlier one: a grid that ends where it began would be read for ever.
    fn jump(&mut self, to: u64) -> Result<(), FileError> {
        match usize::try_from(to) {
            Ok(to) if to < self.at => Err(FileError::Byte {
                at: self.at,
                reason: format!("what follows stands before it, at byte {to}: the file is damaged"),
            }),
            Ok(to) if to <= self.bytes.len() => {
                self.at = to;
                Ok(())
            }
            _ => Err(FileError::Cut("its grids")),
        }
    }

    fn array<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], FileError> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N, what)?);
        Ok(out)
    }

    fn u32(&mut self, what: &'static str) -> Result<u32, FileError> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    fn u64(&mut self) -> Result<u64, FileError> {
        Ok(u64::from_le_bytes(self.array("its grids")?))
    }

    fn f32(&mut self) -> Result<f32, FileError> {
        Ok(f32::from_le_bytes(self.array("its values")?))
    }

    fn three(&mut self) -> Result<[f64; 3], FileError> {
        let mut out = [0.0; 3];
        for x in &mut out {
            *x = f64::from_bits(self.u64()?);
        }
        Ok(out)
    }

    fn place(&mut self) -> Result<[i64; 3], FileError> {
        let mut out = [0; 3];
        for x in &mut out {
            *x = i32::from_le_bytes(self.array("a tree's root")?).into();
        }
        Ok(out)
    }

    fn text(&mut self) -> Result<String, FileError> {
        let length = self.u32("a name")? as usize;
        Ok(String::from_utf8_lossy(self.take(length, "a name")?).into_owned())
    }

    fn metadata(&mut self) -> Result<Vec<(String, &'a [u8])>, FileError> {
        let count = self.u32("its metadata")?;
        let mut out = Vec::new();
        for _ in 0..count {
            let name = self.text()?;
            self.text()?;
            let length = self.u32("its metadata")? as usize;
            out.push((name, self.take(length, "its metadata")?));
        }
        Ok(out)
    }

    /// `length` bytes as they were before they were packed.
    fn packed(&mut self, length: usize, compression: u32) -> Result<Vec<u8>, FileError> {
        const WHERE: &str = "the samples";
        if compression & (vdb::BLOSC | vdb::ZIP) == 0 {
            return Ok(self.take(length, WHERE)?.to_vec());
        }
        let at = self.at;
        let stored = i64::from_le_bytes(self.array(WHERE)?);
        let bad = |reason: &str| FileError::Byte {
            at,
            reason: reason.into(),
        };
        let count = usize::try_from(stored.unsigned_abs()).map_err(|_| FileError::Cut(WHERE))?;
        let bytes = self.take(count, WHERE)?;
        let out = if stored <= 0 {
            bytes.to_vec()
        } else if compression & vdb::BLOSC != 0 {
            blosc::unpack(bytes, length).ok_or_else(|| {
                bad("these samples are damaged, or packed by another method of Blosc than LZ4")
            })?
        } else {
            miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(bytes, length)
                .map_err(|_| bad("these samples are damaged"))?
        };
        if out.len() == length {
            Ok(out)
        } else {
            Err(bad("there are not as many samples here as there must be"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{FileError, half, read, vdb};

    /// Found by fuzzing: a descriptor whose grid ends where the descriptor begins, four thousand million times.
    #[test]
    fn a_grid_that_ends_before_it_begins() {
        let mut file = vdb::MAGIC.to_vec();
        file.extend(vdb::VERSION.to_le_bytes());
        file.extend([0; 8]);
        file.push(1);
        file.extend([0; 36]);
        file.extend(0_u32.to_le_bytes());
        file.extend(u32::MAX.to_le_bytes());
        let first = file.len() as u64;
        // three empty texts: a name, a kind, a parent
        file.extend([0; 12]);
        for place in [first, first, first] {
            file.extend(place.to_le_bytes());
        }
        let end = file.len();
        match read(&file, 1000) {
            Err(FileError::Byte { at, reason }) => {
                assert_eq!(at, end);
                assert!(reason.contains(&format!("at byte {first}")), "{reason}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn half_precision() {
        assert_eq!(half(0x3c00), 1.0);
        assert_eq!(half(0xc000), -2.0);
        assert_eq!(half(0x3555), 0.333_251_95);
        assert_eq!(half(0x0001), 2.0_f32.powi(-24));
        assert_eq!(half(0x7bff), 65_504.0);
        assert!(half(0x7c01).is_nan() && half(0x7c00).is_infinite());
    }
}
