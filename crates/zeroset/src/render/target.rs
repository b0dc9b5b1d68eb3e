//! Where pictures go.

use super::ffmpeg::Codec;
use crate::failure::{Exit, Failure};
use crate::file::default_name;
use std::ops::Range;
use std::path::{Path, PathBuf};
use zeroset_output::format::animation::Kind;
use zeroset_scene::film::Plane;

/// The name that stands for standard output.
pub(crate) const STDOUT: &str = "-";

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Container {
    Png,
    Exr,
    /// One file of all frames.
    Clip(Clip),
}

/// A kind of animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clip {
    /// What we write.
    Own(Kind),
    /// What ffmpeg writes.
    Video(Codec),
}

impl Container {
    /// The kind that a name asks for.
    pub(crate) fn of(path: &Path) -> Result<Container, Failure> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("png") => Ok(Container::Png),
            Some("exr") => Ok(Container::Exr),
            Some("gif") => Ok(Container::Clip(Clip::Own(Kind::Gif))),
            Some("apng") => Ok(Container::Clip(Clip::Own(Kind::Apng))),
            Some("y4m") => Ok(Container::Clip(Clip::Own(Kind::Y4m))),
            Some("mp4") => Ok(Container::Clip(Clip::Video(Codec::Mp4))),
            Some("webm") => Ok(Container::Clip(Clip::Video(Codec::Webm))),
            _ if path == Path::new(STDOUT) => Ok(Container::Clip(Clip::Own(Kind::Y4m))),
            _ => Err(Failure::with_help(
                Exit::Usage,
                format!("{} does not say what kind of picture it is", path.display()),
                "end the name in .png, or in .exr for all planes as layers; with --frames in .gif, .apng, .mp4, .webm or .y4m for one file of \
                 all frames",
            )),
        }
    }
}

/// The name of a picture that was given none; with a place for the number where it is one of many.
pub(crate) fn unnamed(scene: &Path, view: Plane, many: bool) -> Result<PathBuf, Failure> {
    let view = match view {
        Plane::Colour => String::new(),
        _ => format!("-{}", view.name()),
    };
    let number = if many { "-####" } else { "" };
    default_name(scene, &format!("{view}{number}.png"))
}

/// The name of a frame: its number in place of the last `#`s of the file's name or, without any, before the ending.
pub(crate) fn numbered(path: &Path, frame: u32, frames: &Range<u32>) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = match name.rfind('#') {
        Some(last) => {
            let first = name[..last].rfind(|c| c != '#').map_or(0, |i| {
                i + name[i..].chars().next().map_or(1, char::len_utf8)
            });
            let width = last + 1 - first;
            format!("{}{frame:0width$}{}", &name[..first], &name[last + 1..])
        }
        None => {
            let width = (frames.end - 1).to_string().len().max(4);
            let (stem, ending) = name.rsplit_once('.').unwrap_or((&name, ""));
            format!("{stem}-{frame:0width$}.{ending}")
        }
    };
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_have_numbers_of_one_length() {
        let name = |path: &str, frame, end| {
            numbered(Path::new(path), frame, &(0..end))
                .to_string_lossy()
                .into_owned()
        };
        assert_eq!(name("out/a.png", 7, 30), "out/a-0007.png");
        assert_eq!(name("a.b.png", 7, 200_000), "a.b-000007.png");
        assert_eq!(name("out/f##.exr", 7, 30), "out/f07.exr");
        assert_eq!(name("##x###.png", 12, 30), "##x012.png");
        assert_eq!(name("ö#ü.png", 12, 30), "ö12ü.png");
        assert_eq!(name("####.png", 12, 30), "0012.png");
    }

    #[test]
    fn the_ending_says_what_a_picture_is() {
        assert_eq!(
            Container::of(Path::new("a/b.PNG")).ok(),
            Some(Container::Png)
        );
        assert_eq!(
            Container::of(Path::new("b.x.exr")).ok(),
            Some(Container::Exr)
        );
        for path in ["a", "a.jpg", ".png", "png", ""] {
            assert!(Container::of(Path::new(path)).is_err(), "{path}");
        }
    }
}
