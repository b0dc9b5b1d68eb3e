//! Rooms that may not have what others own.

use std::path::Path;

/// Crates that a browser runs: their clocks are those of `web_time`.
const BROWSER: [&str; 11] = [
    "number",
    "catalogue",
    "eval",
    "field",
    "scene",
    "shade",
    "shader",
    "trace",
    "language",
    "gpu",
    "volume",
];

/// Files below a folder, with their text.
fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).expect("a text");
            found.push((path.display().to_string(), text));
        }
    }
}

/// Whether a line takes the system's clock.
fn takes_clock(line: &str) -> bool {
    let line = line.trim();
    line.contains("std::time::") && (line.contains("Instant") || line.contains("SystemTime"))
}

#[test]
fn browsers_have_their_own_clock() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for name in BROWSER {
        let mut found = Vec::new();
        sources(&crates.join(name).join("src"), &mut found);
        assert!(!found.is_empty(), "{name}");
        for (path, text) in found {
            // the room that waits for files to change
            if path.ends_with("language/src/watch.rs") || path.ends_with("tests.rs") {
                continue;
            }
            let line = text.lines().find(|l| takes_clock(l));
            assert_eq!(line, None, "{path}");
        }
    }
    assert!(takes_clock("use std::time::{Duration, Instant};"));
    assert!(!takes_clock("use std::time::Duration;"));
}

/// Whether a line waits for a GPU.
fn waits(line: &str) -> bool {
    let line = line.trim();
    !line.starts_with("//")
        && ["pollster::", "PollType::Wait", ".recv("]
            .iter()
            .any(|w| line.contains(w))
}

#[test]
fn one_room_waits_for_the_gpu() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../gpu/src");
    let mut found = Vec::new();
    sources(&folder, &mut found);
    for (path, text) in found {
        let does = text.lines().any(waits);
        assert_eq!(does, path.ends_with("gpu/src/blocking.rs"), "{path}");
    }
}
