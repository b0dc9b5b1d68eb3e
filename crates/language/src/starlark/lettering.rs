//! `text("...")`: letters as a field.

use super::fields;
use super::mistake::{Run, mistake};
use super::native::{Call, Native, slot};
use super::value::Value;
use crate::report::Report;
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_field::field::Field;
use zeroset_field::text::{Align, Font, Layout, default_font};

/// The functions.
pub(crate) const ALL: &[Native] = &[Native {
    name: "text",
    doc: "Letters, standing on y = 0 and facing z.",
    group: "Letters",
    params: &[
        slot("text", "", "What they say; may have several lines."),
        slot("size", "1", "Height of a line, scene units."),
        slot(
            "depth",
            "0.2",
            "How thick they are along z; 0 leaves them plane.",
        ),
        slot("align", "\"center\"", "\"left\", \"center\" or \"right\"."),
        slot(
            "spacing",
            "0",
            "Added between letters, as a part of the size, -1 to 10.",
        ),
        slot(
            "font",
            "DejaVu Sans Bold",
            "A TrueType or OpenType file in the scene's folder.",
        ),
    ],
    rest: false,
    run: text,
}];

/// That a font lacks characters.
fn lacking(missing: &[char]) -> Report {
    const MOST: usize = 8;
    let mut list: Vec<String> = (missing.iter().take(MOST))
        .map(|c| format!("{} (U+{:04X})", c.escape_debug(), u32::from(*c)))
        .collect();
    if missing.len() > MOST {
        list.push(format!("{} more", missing.len() - MOST));
    }
    let message = format!("the font has no glyph for {}", list.join(", "));
    Report::new(message)
        .with_help("its sign for a missing glyph stands there; another font may have it: text(..., font = \"file.ttf\")")
}

fn text(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("text")?;
    let words = c.text("text", given)?;
    let depth = c.number_or("depth", 0.2, 0.0, LARGE)?;
    let aligns = [
        ("left", Align::Left),
        ("center", Align::Centre),
        ("right", Align::Right),
    ];
    let layout = Layout {
        size: c.number_or("size", 1.0, SMALL, LARGE)?,
        align: c.word_or("align", Align::Centre, &aligns)?,
        letter_spacing: c.number_or("spacing", 0.0, -1.0, 10.0)?,
        ..Layout::default()
    };
    let bytes;
    let font = match c.get("font") {
        None => Font::new(default_font(), 0),
        Some(given) => {
            let name = c.text("font", given)?;
            let limit = c.machine.limits.image_bytes;
            let read = c.machine.draft.files.read(&name, limit, "image_bytes");
            bytes = read.map_err(|e| mistake(e.to_string()).at(given.place))?;
            c.machine.charge(bytes.len() as u64 / 256)?;
            Font::new(&bytes, 0)
        }
    };
    c.machine.charge(64 * words.len() as u64)?;
    let set = font
        .and_then(|f| f.set(&words, &layout))
        .map_err(|e| mistake(e.to_string()).at(given.place))?;
    if !set.missing.is_empty() {
        let place = given.place;
        c.machine.draft.warn(lacking(&set.missing), place);
    }
    let outline = catalogue()
        .primitive("outline")
        .ok_or_else(|| mistake("letters have no outlines here"))?;
    // one outline for all: its trees are shorter than a union of letters
    let mut pieces: Vec<f64> = Vec::new();
    for glyph in &set.glyphs {
        let [x, y] = glyph.position;
        for [ax, ay, bx, by] in glyph.outline[1..].as_chunks::<4>().0 {
            // as the evaluators will read them, so that contours stay closed
            let stored = [ax + x, ay + y, bx + x, by + y].map(|c| f64::from(c as f32));
            if stored[..2] != stored[2..] {
                pieces.extend(stored);
            }
        }
    }
    if pieces.is_empty() {
        return Err(mistake("the text has no letters to see").at(given.place));
    }
    c.machine.grow_field(pieces.len())?;
    let params = [&[(pieces.len() / 4) as f64], &pieces[..]].concat();
    let plane = Field::primitive(outline, params);
    match catalogue().modifier("extrude") {
        Some(extrude) if depth > 0.0 => {
            let plane = plane.map_err(|e| fields::unfit(&e))?;
            fields::value(c.machine, plane.modify(extrude, vec![depth]))
        }
        _ => fields::value(c.machine, plane),
    }
}
