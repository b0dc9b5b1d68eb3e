//! `docs/fields.md` is what the catalogue says. `ZEROSET_BLESS=1 cargo test -p zeroset --test reference_page` writes it anew.

use std::fmt::Write;
use std::path::PathBuf;
use zeroset::catalogue::bounds::Exactness;
use zeroset::catalogue::entries::catalogue;
use zeroset::catalogue::{self, Info, LARGE, Unit};
use zeroset::scene::methods::{GROUPS, Kind};

fn number(x: f64, unit: Unit) -> String {
    let x = match unit {
        Unit::Angle | Unit::Rate => x.to_degrees(),
        _ => x,
    };
    let text = format!("{x:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

fn range(min: f64, max: f64, unit: Unit) -> String {
    let from = (min > -LARGE).then(|| number(min, unit));
    let to = (max < LARGE).then(|| number(max, unit));
    match (from, to) {
        (Some(a), Some(b)) => format!("{a} to {b}"),
        (Some(a), None) if a == "0" => "above 0".into(),
        (Some(a), None) => format!("{a} or more"),
        (None, Some(b)) => format!("{b} or less"),
        (None, None) => "any".into(),
    }
}

fn entry(out: &mut String, info: &Info, says: &str) {
    let source = if info.source.is_empty() {
        String::new()
    } else {
        format!(" ({})", info.source)
    };
    writeln!(out, "### `{}`\n\n{}{source} {says}\n", info.name, info.doc).unwrap();
    if info.params.is_empty() {
        return;
    }
    out.push_str("| parameter | default | range | |\n| --- | --- | --- | --- |\n");
    for p in info.params {
        let defaults: Vec<String> = p.default.iter().map(|x| number(*x, p.unit)).collect();
        let default = match p.kind {
            catalogue::Kind::Number => defaults.concat(),
            catalogue::Kind::List(_) => "a list".into(),
            _ => format!("({})", defaults.join(", ")),
        };
        writeln!(
            out,
            "| `{}` | {default} | {} | {} |",
            p.name,
            range(p.min, p.max, p.unit),
            p.doc
        )
        .unwrap();
    }
    out.push('\n');
}

/// Entries under the headings of their groups, in the order in which groups first appear.
fn section<'a>(out: &mut String, title: &str, entries: impl Iterator<Item = (&'a Info, String)>) {
    writeln!(out, "## {title}\n").unwrap();
    let entries: Vec<(&Info, String)> = entries.collect();
    let mut groups: Vec<&str> = Vec::new();
    for (info, _) in &entries {
        if !groups.contains(&info.group) {
            groups.push(info.group);
        }
    }
    for group in groups {
        writeln!(out, "**{group}**\n").unwrap();
        for (info, says) in entries.iter().filter(|(info, _)| info.group == group) {
            entry(out, info, says);
        }
    }
}

/// The methods of rendering, from their registry.
fn methods(out: &mut String) {
    out.push_str(
        "## Methods\n\nOf each kind a rendering chooses one; the first is the default. `render(march = relaxed(1.4))` states one \
         in a scene, `--march relaxed=1.4` on the command line, `{\"march\": {\"method\": \"relaxed\", \"omega\": 1.4}}` in JSON.\n\n",
    );
    for group in &GROUPS {
        writeln!(out, "**{}** (`{}`)\n", group.title, group.key).unwrap();
        for method in group.methods {
            let word = match (group.is_called(), method.word == method.name) {
                (true, true) => format!("`{}()`", method.word),
                (true, false) => format!("`{}()`, `--{} {}`", method.word, group.key, method.name),
                (false, _) => format!("`\"{}\"`", method.name),
            };
            writeln!(out, "### {word}\n\n{} ({})\n", method.doc, method.source).unwrap();
            if method.params.is_empty() {
                continue;
            }
            out.push_str(
                "| parameter | default | range | unit | |\n| --- | --- | --- | --- | --- |\n",
            );
            for p in method.params {
                let (range, unit) = match p.kind {
                    Kind::Word(words) => {
                        let words: Vec<_> =
                            words.iter().map(|m| format!("`\"{}\"`", m.name)).collect();
                        (words.join(", "), "")
                    }
                    Kind::Real | Kind::Whole | Kind::Limit => {
                        (p.allowed.to_string(), p.unit.name())
                    }
                };
                let default = p.written(p.default);
                writeln!(
                    out,
                    "| `{}` | {default} | {range} | {unit} | {} |",
                    p.name, p.doc
                )
                .unwrap();
            }
            out.push('\n');
        }
    }
}

fn page() -> String {
    let all = catalogue();
    let mut out = String::from(
        "# Field reference\n\nGenerated from the catalogue of fields and the registry of methods: the same as `zeroset fields`. Lengths are scene units, angles \
         degrees, rates degrees a unit. *Exact* is the distance everywhere, *exact outside* a bound inside, a *bound* never \
         more than the distance, an *estimate* is not proven.\n\n",
    );
    let says = |e: Exactness| match e {
        Exactness::Exact => "*Exact.*",
        Exactness::Outside => "*Exact outside.*",
        Exactness::Bound => "*Bound.*",
        Exactness::Estimate => "*Estimate.*",
    };
    section(
        &mut out,
        "Shapes",
        all.primitives
            .iter()
            .map(|e| (&e.info, says(e.exactness).to_string())),
    );
    section(
        &mut out,
        "Joins",
        all.joins.iter().map(|e| (&e.info, String::new())),
    );
    section(
        &mut out,
        "Changes of a shape",
        all.modifiers.iter().map(|e| (&e.info, String::new())),
    );
    section(
        &mut out,
        "Changes of space",
        all.maps.iter().map(|e| (&e.info, String::new())),
    );
    methods(&mut out);
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

#[test]
fn the_reference_page_is_what_the_catalogue_says() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/fields.md");
    let page = page();
    if std::env::var_os("ZEROSET_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == page,
        "docs/fields.md is not what the catalogue says: ZEROSET_BLESS=1 cargo test -p zeroset --test reference_page"
    );
}
