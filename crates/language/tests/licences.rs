//! Every dependency has a licence that `deny.toml` allows: what `cargo deny check licenses` says, without that tool.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The texts between quotation marks.
fn quoted(text: &str) -> Vec<String> {
    text.split('"')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

/// The licences of `deny.toml` that all crates may have, and those of crates by name.
fn allowed() -> (Vec<String>, Vec<(String, Vec<String>)>) {
    let text = std::fs::read_to_string(root().join("deny.toml")).expect("deny.toml");
    let list = |name: &str| {
        let start = text.find(&format!("\n{name} = [")).expect(name);
        let end = text[start..].find("\n]").expect("an end");
        text[start..start + end].to_owned()
    };
    let exceptions = list("exceptions");
    let of_crates = exceptions
        .lines()
        .filter(|l| l.contains("crate ="))
        .map(|line| {
            let mut words = quoted(line);
            (words.remove(0), words)
        });
    (quoted(&list("allow")), of_crates.collect())
}

/// Whether an SPDX expression can be met. Old manifests write `/` for `OR`.
fn is_met(expression: &str, allowed: &dyn Fn(&str) -> bool) -> bool {
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut at = 0;
    let met = any(&words, &mut at, allowed);
    assert_eq!(at, words.len(), "`{expression}` is no expression");
    met
}

fn any(words: &[&str], at: &mut usize, allowed: &dyn Fn(&str) -> bool) -> bool {
    let mut met = all(words, at, allowed);
    while words.get(*at) == Some(&"OR") {
        *at += 1;
        met |= all(words, at, allowed);
    }
    met
}

fn all(words: &[&str], at: &mut usize, allowed: &dyn Fn(&str) -> bool) -> bool {
    let mut met = one(words, at, allowed);
    while words.get(*at) == Some(&"AND") {
        *at += 1;
        met &= one(words, at, allowed);
    }
    met
}

fn one(words: &[&str], at: &mut usize, allowed: &dyn Fn(&str) -> bool) -> bool {
    let Some(&word) = words.get(*at) else {
        return false;
    };
    *at += 1;
    if word == "(" {
        let met = any(words, at, allowed);
        assert_eq!(words.get(*at), Some(&")"));
        *at += 1;
        return met;
    }
    if words.get(*at) == Some(&"WITH") {
        let whole = words[*at - 1..*at + 2].join(" ");
        *at += 2;
        return allowed(&whole);
    }
    allowed(word)
}

#[test]
fn every_dependency_may_be_passed_on() {
    // the crates of this platform are on this machine, whose tests are running
    let version = Command::new("rustc").arg("-vV").output().expect("rustc");
    let version = String::from_utf8(version.stdout).expect("text");
    let host = version
        .lines()
        .find_map(|l| l.strip_prefix("host: "))
        .expect("a host");
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--format-version",
            "1",
            "--locked",
            "--offline",
            "--filter-platform",
            host,
        ])
        .current_dir(root())
        .output()
        .expect("cargo");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let about: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = about["packages"].as_array().expect("packages");
    let (general, special) = allowed();
    assert!(general.len() > 3 && special.len() == 1);
    let refused: Vec<String> = packages
        .iter()
        .filter(|p| {
            let name = p["name"].as_str().unwrap_or_default();
            let own = special.iter().find(|(n, _)| n == name).map(|(_, own)| own);
            let fits = |l: &str| {
                general
                    .iter()
                    .chain(own.into_iter().flatten())
                    .any(|a| a == l)
            };
            !p["license"].as_str().is_some_and(|l| is_met(l, &fits))
        })
        .map(|p| format!("{} {}: {}", p["name"], p["version"], p["license"]))
        .collect();
    assert!(packages.len() > 100, "{} packages", packages.len());
    assert!(
        refused.is_empty(),
        "deny.toml does not allow\n{}",
        refused.join("\n")
    );
}

#[test]
fn expressions_are_read() {
    let mit = |l: &str| l == "MIT";
    assert!(
        is_met("MIT", &mit) && is_met("Apache-2.0/MIT", &mit) && is_met("(MIT OR X) AND MIT", &mit)
    );
    assert!(!is_met("GPL-3.0", &mit) && !is_met("MIT AND OFL-1.1", &mit) && !is_met("", &mit));
    assert!(!is_met("MIT WITH some-exception", &mit) && is_met("X WITH y OR MIT", &mit));
}
