//! Colours as people write them.

/// An sRGB colour, 0 to 1, from `#rgb`, `#rrggbb`, a CSS name or a CSS function such as `hsl(200, 50%, 50%)`.
///
/// # Errors
/// What is wrong with it.
pub fn parse(text: &str) -> Result<[f64; 3], String> {
    let colour = csscolorparser::parse(text).map_err(|e| e.to_string())?;
    if colour.a != 1.0 {
        return Err("it is see-through, which a colour cannot be here".into());
    }
    let [r, g, b] = [colour.r, colour.g, colour.b].map(f64::from);
    if [r, g, b].iter().all(|x| x.is_finite()) {
        Ok([r, g, b])
    } else {
        Err("it has no finite numbers".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_digits() {
        assert_eq!(parse("#f00"), Ok([1.0, 0.0, 0.0]));
        assert_eq!(parse("#00ff00"), Ok([0.0, 1.0, 0.0]));
        assert_eq!(parse("white"), Ok([1.0; 3]));
        assert!(parse("#12").is_err());
        assert!(parse("#ff000080").is_err());
        assert!(parse("mauvish").is_err());
    }
}
