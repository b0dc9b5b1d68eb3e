//! The scenes that come with the project.

use std::path::{Path, PathBuf};

/// The groups that scenes are in: the first steps, those of the papers, the gallery.
pub const GROUPS: [&str; 3] = ["", "papers", "gallery"];

/// The folder of all scenes.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// The scripts of a group, sorted.
///
/// # Panics
/// Where the folder cannot be read.
pub fn of(group: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder().join(group)).expect("the folder of scenes");
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "star"))
        .collect();
    found.sort();
    assert!(!found.is_empty(), "no scenes in the group `{group}`");
    found
}

/// All scripts.
///
/// # Panics
/// Where a folder cannot be read.
pub fn all() -> Vec<PathBuf> {
    GROUPS.into_iter().flat_map(of).collect()
}

/// What a scene is called here: its group and its stem, as in `papers/keinert_city`.
pub fn name(path: &Path) -> String {
    let path = path.with_extension("");
    let below = path.strip_prefix(folder()).unwrap_or(&path);
    below.display().to_string()
}
