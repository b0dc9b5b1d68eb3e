//! How much nearer than their widths say two letters stand.

use skrifa::raw::TableProvider;
use skrifa::raw::tables::gpos::{PairPos, PairPosFormat1, PairPosFormat2, PositionSubtables};
use skrifa::raw::tables::kern::SubtableKind;
use skrifa::raw::types::Tag;
use skrifa::{FontRef, GlyphId};

/// Most tables of pairs that are looked through; real fonts have a few.
const TABLES: usize = 64;

/// A font's kerning: of `GPOS` where it is there, else of `kern`.
pub(super) struct Kerning<'a> {
    pairs: Vec<PairPos<'a>>,
    old: Vec<SubtableKind<'a>>,
}

impl<'a> Kerning<'a> {
    pub(super) fn new(font: &FontRef<'a>) -> Self {
        let pairs = positioning(font).unwrap_or_default();
        let mut old = Vec::new();
        if let (true, Ok(kern)) = (pairs.is_empty(), font.kern()) {
            let level = kern.subtables().take(TABLES).flatten().filter(|t| {
                t.is_horizontal()
                    && !t.is_cross_stream()
                    && !t.is_variable()
                    && !t.is_state_machine()
            });
            old.extend(level.filter_map(|t| t.kind().ok()));
        }
        Kerning { pairs, old }
    }

    /// What to add to the width of `left` when `right` follows, in font units.
    pub(super) fn between(&self, left: GlyphId, right: GlyphId) -> i32 {
        if let Some(by) = self.pairs.iter().find_map(|t| adjustment(t, left, right)) {
            return i32::from(by);
        }
        let of = |t: &SubtableKind<'_>| match t {
            SubtableKind::Format0(t) => t.kerning(left, right),
            SubtableKind::Format2(t) => t.kerning(left, right),
            SubtableKind::Format3(t) => t.kerning(left, right),
            SubtableKind::Format1(_) => None,
        };
        (self.old.iter().filter_map(of)).fold(0, i32::saturating_add)
    }
}

/// The tables of pairs behind the feature `kern`, of any script.
fn positioning<'a>(font: &FontRef<'a>) -> Option<Vec<PairPos<'a>>> {
    let gpos = font.gpos().ok()?;
    let (features, lookups) = (gpos.feature_list().ok()?, gpos.lookup_list().ok()?);
    let mut indices = Vec::new();
    for record in features.feature_records() {
        if record.feature_tag() == Tag::new(b"kern") {
            let feature = record.feature(features.offset_data()).ok()?;
            let wanted = feature.lookup_list_indices().iter().take(TABLES);
            indices.extend(wanted.map(|i| i.get()));
        }
        if indices.len() > TABLES * TABLES {
            break;
        }
    }
    indices.sort_unstable();
    indices.dedup();
    let mut pairs = Vec::new();
    for i in indices.into_iter().take(TABLES) {
        let Ok(lookup) = lookups.lookups().get(usize::from(i)) else {
            continue;
        };
        if let Ok(PositionSubtables::Pair(tables)) = lookup.subtables() {
            pairs.extend(tables.iter().take(TABLES).flatten());
        }
        pairs.truncate(TABLES);
    }
    Some(pairs)
}

fn adjustment(table: &PairPos<'_>, left: GlyphId, right: GlyphId) -> Option<i16> {
    match table {
        PairPos::Format1(t) => of_glyphs(t, left, right),
        PairPos::Format2(t) => of_classes(t, left, right),
        _ => None,
    }
}

fn of_glyphs(t: &PairPosFormat1<'_>, left: GlyphId, right: GlyphId) -> Option<i16> {
    let covered = t.coverage().ok()?.get(left)?;
    let records = t
        .pair_sets()
        .get(covered as usize)
        .ok()?
        .pair_value_records();
    // sorted by the second glyph
    let (mut lo, mut hi) = (0, records.len());
    while lo < hi {
        let middle = lo + (hi - lo) / 2;
        let record = records.get(middle).ok()?;
        match GlyphId::from(record.second_glyph()).cmp(&right) {
            std::cmp::Ordering::Less => lo = middle + 1,
            std::cmp::Ordering::Greater => hi = middle,
            std::cmp::Ordering::Equal => return record.value_record1().x_advance(),
        }
    }
    None
}

fn of_classes(t: &PairPosFormat2<'_>, left: GlyphId, right: GlyphId) -> Option<i16> {
    t.coverage().ok()?.get(left)?;
    let first = t.class_def1().ok()?.get(left);
    let second = t.class_def2().ok()?.get(right);
    let row = t.class1_records().get(first as usize).ok()?;
    let cell = row.class2_records().get(second as usize).ok()?;
    cell.value_record1().x_advance()
}
