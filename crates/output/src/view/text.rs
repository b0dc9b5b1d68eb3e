//! Text in pictures: an 8x8 bitmap font.

use crate::picture::Picture;
use font8x8::legacy::BASIC_LEGACY;

/// Side of a character at scale 1, pixels.
pub(crate) const CHARACTER: i64 = 8;

/// Width of a text, pixels.
pub(crate) fn width(text: &str, scale: i64) -> i64 {
    text.chars().count() as i64 * CHARACTER * scale
}

/// Draws a line of text with its top left corner at `at`, clipped to the picture. What is not ASCII becomes `?`.
pub(crate) fn draw(
    picture: &mut Picture,
    text: &str,
    [x, y]: [i64; 2],
    scale: i64,
    colour: [f32; 3],
) {
    for (i, character) in (0..).zip(text.chars()) {
        let glyph = BASIC_LEGACY
            .get(character as usize)
            .unwrap_or(&BASIC_LEGACY[usize::from(b'?')]);
        for (row, bits) in (0..).zip(glyph) {
            for column in (0..CHARACTER).filter(|c| bits >> c & 1 == 1) {
                let corner = [x + (i * CHARACTER + column) * scale, y + row * scale];
                picture.fill(corner, [scale; 2], colour);
            }
        }
    }
}
