//! Names: of the files that are made from a scene, and how much of a stranger's text a message repeats.

use std::path::Path;

/// What a picture is called where the scene's file has no name that could be one.
const FALLBACK: &str = "scene";
/// Bytes of a stem. File systems allow 255 for a name, and the plane, the frame's number and the ending are still to come.
const STEM: usize = 120;

/// The stem of the names of files that are made from a scene file, such as pictures that were given no name.
///
/// It comes from the scene file's own name and from nothing inside of it, so that a scene never chooses what is written
/// where. It is one component of a path on every system: without separators, control and invisible characters, not empty,
/// neither hidden nor relative, no Windows device, of limited length. An ordinary name is kept as it is.
pub fn default_stem(scene: &Path) -> String {
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let clean: String = stem
        .chars()
        .map(|c| if fits(c) { c } else { '_' })
        .collect();
    let mut stem = trimmed(&clean[..floor_char(&clean, STEM)]).to_string();
    if stem.chars().all(|c| c == '_' || c.is_whitespace()) {
        return FALLBACK.to_string();
    }
    if is_device(&stem) {
        stem.insert(0, '_');
    }
    stem
}

/// Whether a character may stand in the name of a file on every system, and is seen there.
fn fits(c: char) -> bool {
    let reserved = matches!(c, '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|');
    !(reserved || c == char::REPLACEMENT_CHARACTER || is_unseen(c))
}

/// Whether a character has no shape of its own but changes the text around it: controls (Unicode's Cc), separators of lines,
/// directions, joiners and other formats (Cf), tags.
fn is_unseen(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}')
}

/// Without what hides a file, leads out of a folder, or is dropped by Windows.
fn trimmed(stem: &str) -> &str {
    let hides = |c: char| c == '.' || c.is_whitespace();
    stem.trim_matches(hides)
}

/// Whether Windows takes a name for a device, whatever its ending.
fn is_device(stem: &str) -> bool {
    let base = stem.split('.').next().unwrap_or_default();
    let base = base.trim_end().to_uppercase();
    let port = base
        .strip_prefix("COM")
        .or_else(|| base.strip_prefix("LPT"));
    let one = |rest: &str| {
        let mut rest = rest.chars();
        let digit = rest.next();
        digit.is_some_and(|c| c.is_ascii_digit() || matches!(c, '¹' | '²' | '³'))
            && rest.next().is_none()
    };
    port.is_some_and(one) || matches!(&*base, "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$")
}

/// The largest boundary between characters that is not beyond `at`.
pub(crate) fn floor_char(text: &str, at: usize) -> usize {
    (0..=at.min(text.len()))
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}

/// At most about `most` characters of a text: its beginning and its end, and how many are left out between them.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    let length = text.chars().count();
    if length <= most {
        return text.to_string();
    }
    let (head, tail) = (most * 3 / 4, most / 4);
    let at = |n: usize| text.char_indices().nth(n).map_or(text.len(), |(at, _)| at);
    format!(
        "{} [... {} characters ...] {}",
        &text[..at(head)],
        length - head - tail,
        &text[at(length - tail)..]
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Component;

    fn stem(name: &str) -> String {
        default_stem(Path::new(name))
    }

    #[test]
    fn ordinary_names_are_kept() {
        for name in [
            "menger",
            "two balls",
            "a.b",
            "größe",
            "東京",
            "v1.2-final_3",
            "console",
            "com10",
            "x+y=z",
            "#7",
        ] {
            assert_eq!(stem(&format!("some/folder/{name}.star")), name);
        }
    }

    #[test]
    fn others_are_made_safe() {
        for (name, right) in [
            ("..star", "scene"),
            ("....star", "scene"),
            (".star", "star"),
            (" .star", "scene"),
            ("", "scene"),
            ("/", "scene"),
            ("..", "scene"),
            ("...hidden.star", "hidden"),
            ("a\\..\\b.star", "a_.._b"),
            ("c:d.star", "c_d"),
            ("a\u{1b}]0;x\u{7}.star", "a_]0;x_"),
            ("a\u{202e}b.json", "a_b"),
            ("a\nb.json", "a_b"),
            ("con.star", "_con"),
            ("NUL.tar.star", "_NUL.tar"),
            ("Com1.star", "_Com1"),
            ("LPT².star", "_LPT²"),
            ("conout$.star", "_conout$"),
            ("aux .star", "_aux"),
            ("trailing. .star", "trailing"),
            ("<<>>.star", "scene"),
        ] {
            assert_eq!(stem(name), right, "{name:?}");
        }
    }

    /// Whatever the file is called: one ordinary component, that stays it with an ending.
    #[test]
    fn any_name_becomes_one_component() {
        let odd = [
            '.', '/', '\\', ' ', '\u{0}', 'a', 'ß', '\u{202e}', ':', '𝄞', '\u{9b}', 'N', 'U', 'L',
        ];
        for a in odd {
            for b in odd {
                for n in [0, 1, 300] {
                    let name: String = format!("{a}{b}{}", b.to_string().repeat(n));
                    for ending in ["", ".star", ".json"] {
                        let stem = stem(&format!("{name}{ending}"));
                        assert!(
                            !stem.is_empty() && stem.len() <= STEM + 1,
                            "{name:?}: {stem:?}"
                        );
                        let file = format!("{stem}.png");
                        let parts: Vec<Component<'_>> = Path::new(&file).components().collect();
                        assert!(
                            matches!(parts[..], [Component::Normal(_)]),
                            "{name:?}: {stem:?}"
                        );
                        assert!(
                            stem.chars().all(fits) && !stem.starts_with('.'),
                            "{name:?}: {stem:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn long_texts_lose_their_middle() {
        assert_eq!(shortened("abc", 3), "abc");
        assert_eq!(shortened("äöü", 3), "äöü");
        assert_eq!(
            shortened("0123456789", 8),
            "012345 [... 2 characters ...] 89"
        );
        let long = "ä".repeat(1_000_000);
        assert!(shortened(&long, 1000).chars().count() < 1040);
    }

    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        let name = OsStr::from_bytes(b"a\xff\xfeb.star");
        assert_eq!(default_stem(Path::new(name)), "a__b");
    }
}
