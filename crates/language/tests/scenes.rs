//! Every scene of the `scenes` folder loads, has a field, and goes to JSON and back.

use std::path::{Path, PathBuf};
use zeroset_language::json::{expand, to_text};
use zeroset_language::load::{Language, Options, load, load_text};

fn scenes(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.extension().and_then(|e| e.to_str()) {
            _ if path.is_dir() => scenes(&path, out),
            Some("star" | "json") => out.push(path),
            _ => {}
        }
    }
}

#[test]
fn all_load() {
    let mut all = Vec::new();
    scenes(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes"),
        &mut all,
    );
    all.sort();
    assert!(!all.is_empty());
    let mut failures = Vec::new();
    for path in all {
        match load(&path, &Options::default()) {
            Err(failed) => failures.push(format!("{:?}", miette::Report::new(*failed.report))),
            Ok(loaded) => {
                assert!(loaded.scene.field().unwrap().is_some());
                let text = to_text(&expand(&loaded.scene).unwrap());
                let folder = path.parent();
                match load_text(
                    "scene.json",
                    &text,
                    Language::Json,
                    folder,
                    &Options::default(),
                ) {
                    Ok(again) => {
                        assert_eq!(
                            text,
                            to_text(&expand(&again.scene).unwrap()),
                            "{}",
                            path.display()
                        )
                    }
                    Err(failed) => failures.push(format!("{}: {}", path.display(), failed.report)),
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
