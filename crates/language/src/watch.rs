//! Files of a scene that are looked at again and again, to see whether one was saved.
//!
//! Files are looked at instead of being subscribed to: that also works on network disks and in containers, survives
//! editors that save by renaming, and cannot miss a save, because what counts is how a file differs from what was loaded.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

/// A good time between two looks.
pub const PAUSE: Duration = Duration::from_millis(100);
/// How long all files must stay as they are before a change counts: some editors write in several steps.
const SETTLED: Duration = Duration::from_millis(50);
/// How long is waited for that at most: some programs never stop writing.
const LONGEST: Duration = Duration::from_millis(500);

/// What a file looked like; `None` where there is none.
type Stamp = Option<(SystemTime, u64, u64)>;

fn stamp(path: &Path) -> Stamp {
    let metadata = fs::metadata(path).ok()?;
    #[cfg(unix)]
    let number = std::os::unix::fs::MetadataExt::ino(&metadata);
    #[cfg(not(unix))]
    let number = 0;
    Some((metadata.modified().ok()?, metadata.len(), number))
}

/// Files with what they looked like.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched(Vec<(PathBuf, Stamp)>);

impl Watched {
    /// Files as they look now. To miss no save, this is asked before they are loaded.
    pub fn of(files: impl IntoIterator<Item = PathBuf>) -> Watched {
        Watched(
            files
                .into_iter()
                .map(|path| (stamp(&path), path))
                .map(|(stamp, path)| (path, stamp))
                .collect(),
        )
    }

    /// The files of a new load: those that were known before keep what they looked like then.
    #[must_use]
    pub fn with(&self, files: Vec<PathBuf>) -> Watched {
        let known = |path: &Path| {
            self.0
                .iter()
                .find(|(p, _)| p == path)
                .map(|(_, stamp)| *stamp)
        };
        let stamped = files
            .into_iter()
            .map(|path| (known(&path).unwrap_or_else(|| stamp(&path)), path));
        Watched(stamped.map(|(stamp, path)| (path, stamp)).collect())
    }

    /// Whether a file looks different now.
    pub fn changed(&self) -> bool {
        self.0.iter().any(|(path, before)| stamp(path) != *before)
    }

    /// The same files as they look now, once they stay so. This waits for it, half a second at most: files that never rest
    /// are given as they look then.
    #[must_use]
    pub fn settled(&self) -> Watched {
        let began = Instant::now();
        loop {
            let now = Watched::of(self.0.iter().map(|(path, _)| path.clone()));
            if began.elapsed() >= LONGEST {
                return now;
            }
            thread::sleep(SETTLED);
            if !now.changed() {
                return now;
            }
        }
    }

    /// The files.
    pub fn files(&self) -> impl ExactSizeIterator<Item = &Path> {
        self.0.iter().map(|(path, _)| path.as_path())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn files_that_never_rest_are_not_waited_for_for_ever() {
        let folder = std::env::temp_dir().join(format!("zeroset-watch-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("a.star");
        fs::write(&path, "0").unwrap();
        let ended = AtomicBool::new(false);
        let elapsed = thread::scope(|scope| {
            scope.spawn(|| {
                let mut text = String::new();
                while !ended.load(Ordering::Relaxed) {
                    // another length each time: the clock of a file system is coarse
                    text.push('x');
                    fs::write(&path, &text).unwrap();
                    thread::sleep(Duration::from_millis(5));
                }
            });
            let began = Instant::now();
            let _ = Watched::of([path.clone()]).settled();
            let elapsed = began.elapsed();
            ended.store(true, Ordering::Relaxed);
            elapsed
        });
        fs::remove_dir_all(&folder).unwrap();
        // one that rests is told at once
        assert!(
            elapsed >= LONGEST && elapsed < Duration::from_secs(20),
            "{elapsed:?}"
        );
    }
}
