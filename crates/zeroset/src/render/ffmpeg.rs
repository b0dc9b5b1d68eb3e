//! Videos, by `ffmpeg` where it is installed: frames go into its standard input.

use crate::failure::{Exit, Failure};
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use tempfile::TempDir;

/// The program.
const PROGRAM: &str = "ffmpeg";

/// Lines of what the program said that are shown.
const LINES: usize = 3;

/// What a video is packed by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Codec {
    /// H.264 in MP4, which everything plays.
    Mp4,
    /// VP9 in WebM.
    Webm,
}

impl Codec {
    fn ending(self) -> &'static str {
        match self {
            Codec::Mp4 => "mp4",
            Codec::Webm => "webm",
        }
    }

    fn arguments(self) -> &'static [&'static str] {
        match self {
            Codec::Mp4 => &[
                "-c:v",
                "libx264",
                "-crf",
                "16",
                "-preset",
                "slow",
                "-movflags",
                "+faststart",
            ],
            Codec::Webm => &[
                "-c:v",
                "libvpx-vp9",
                "-crf",
                "20",
                "-b:v",
                "0",
                "-row-mt",
                "1",
            ],
        }
    }
}

/// Colours as in [`zeroset_output::format::animation::Kind::Y4m`]: ITU-R BT.709, and sides that are even, as the codecs want them.
const FILTER: &str =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";

/// A running ffmpeg.
pub(crate) struct Encoder {
    child: Child,
    frames: Option<ChildStdin>,
    folder: TempDir,
    file: PathBuf,
}

impl Encoder {
    /// Whether the program is there.
    ///
    /// # Errors
    /// It is not.
    pub(crate) fn check(path: &Path) -> Result<(), Failure> {
        let found = Command::new(PROGRAM)
            .arg("-version")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        if found.is_ok_and(|status| status.success()) {
            return Ok(());
        }
        Err(Failure::with_help(
            Exit::Job,
            format!(
                "{} is written by ffmpeg, which is not installed (or not in PATH)",
                path.display()
            ),
            "install ffmpeg, or write .gif, .apng or .y4m, which need nothing",
        ))
    }

    pub(crate) fn begin(
        codec: Codec,
        [width, height]: [u32; 2],
        rate: f64,
    ) -> Result<Encoder, Failure> {
        // a folder of one's own for the video until it is whole
        let folder = tempfile::Builder::new()
            .prefix("zeroset-video-")
            .tempdir()
            .map_err(|e| broken(&e))?;
        // MP4 is not written from its beginning to its end: it needs a file
        let file = folder.path().join("video").with_extension(codec.ending());
        let mut child = Command::new(PROGRAM)
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pix_fmt", "rgb24"])
            .args([
                "-s",
                &format!("{width}x{height}"),
                "-r",
                &rate.to_string(),
                "-i",
                "pipe:0",
            ])
            .args(["-an", "-vf", FILTER])
            .args([
                "-colorspace",
                "bt709",
                "-color_primaries",
                "bt709",
                "-color_trc",
                "iec61966-2-1",
            ])
            .args(codec.arguments())
            .arg(&file)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| broken(&e))?;
        Ok(Encoder {
            frames: child.stdin.take(),
            child,
            folder,
            file,
        })
    }

    pub(crate) fn push(&mut self, frame: &[u8]) -> Result<(), Failure> {
        let Some(frames) = &mut self.frames else {
            return Ok(());
        };
        match frames.write_all(frame) {
            Ok(()) => Ok(()),
            Err(error) => Err(self.said(&error.to_string())),
        }
    }

    /// The bytes of the video.
    pub(crate) fn finish(mut self) -> Result<Vec<u8>, Failure> {
        // the end of the frames
        self.frames = None;
        let status = self.child.wait().map_err(|e| broken(&e))?;
        if !status.success() {
            return Err(self.said(&status.to_string()));
        }
        fs::read(&self.file).map_err(|e| broken(&e))
    }

    /// Why the program ended, in its own words.
    fn said(&mut self, otherwise: &str) -> Failure {
        self.frames = None;
        let mut words = String::new();
        if let Some(mut stderr) = self.child.stderr.take() {
            // what it said before it ended, as far as it is text
            let mut bytes = Vec::new();
            let _ = stderr.by_ref().take(1 << 16).read_to_end(&mut bytes);
            words = String::from_utf8_lossy(&bytes).into_owned();
        }
        let _ = self.child.wait();
        let place = self.folder.path().to_string_lossy().into_owned();
        let lines: Vec<&str> = words.lines().filter(|l| !l.trim().is_empty()).collect();
        let last = lines[lines.len().saturating_sub(LINES)..].join(" ");
        let last = zeroset_output::display::clean(&last).replace(&place, "");
        let said = if last.is_empty() { otherwise } else { &last };
        Failure::with_help(
            Exit::Job,
            format!("ffmpeg failed: {said}"),
            "it must know libx264 (.mp4) or libvpx-vp9 (.webm); .gif, .apng and .y4m need no ffmpeg",
        )
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        // an animation that failed, or was interrupted: one that ended is not there any more
        self.frames = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn broken(error: &io::Error) -> Failure {
    Failure::new(Exit::Job, format!("ffmpeg cannot be run: {error}"))
}
