//! `docs/fields.md` and the tables of `docs/formulas.md` and `docs/coming-from.md` are what the catalogue and the language say.
//! `ZEROSET_BLESS=1 cargo test --workspace --test reference_page` writes them anew.

use std::fmt::Write;
use std::path::PathBuf;
use zeroset::catalogue::bounds::Exactness;
use zeroset::catalogue::entries::catalogue;
use zeroset::catalogue::{self, Info, LARGE, Unit};
use zeroset::language::load::{Language, Options, load_text};
use zeroset::language::starlark::{SYNONYMS, Word, formula_functions, words};
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

/// The small picture of an entry, where there is one: `crates/testkit/tests/thumbnails.rs` makes them.
fn picture(name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/fields");
    match folder.join(format!("{name}.png")).exists() {
        true => format!("![{name}](fields/{name}.png)\n\n"),
        false => String::new(),
    }
}

fn entry(out: &mut String, info: &Info, says: &str) {
    let source = if info.source.is_empty() {
        String::new()
    } else {
        format!(" ({})", info.source)
    };
    let picture = picture(info.name);
    writeln!(
        out,
        "### `{}`\n\n{picture}{}{source} {says}\n",
        info.name, info.doc
    )
    .unwrap();
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
            let picture = picture(&format!("{}_{}", group.key, method.name));
            writeln!(
                out,
                "### {word}\n\n{picture}{} ({})\n",
                method.doc, method.source
            )
            .unwrap();
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

/// How a word is written: with its parameters, those that may be left out with their defaults.
fn signature(word: &Word) -> String {
    if word.kind == "constant" {
        return word.name.to_owned();
    }
    let params = word.params.iter().map(|(name, default, _)| match *default {
        "" | "..." => (*name).to_owned(),
        default => format!("{name} = {default}"),
    });
    let more = word.more.then(|| "...".to_owned());
    let all: Vec<String> = params.chain(more).collect();
    let dot = if word.kind.starts_with("method") {
        "."
    } else {
        ""
    };
    format!("{dot}{}({})", word.name, all.join(", "))
}

/// The words of the language beside the catalogue: stage, materials, settings, mathematics, methods.
fn language(out: &mut String) {
    out.push_str("## The language\n\nFunctions, methods and constants beside the shapes. ");
    out.push_str("Functions of numbers take radians, parameters called angle degrees; [formulas](formulas.md) have more.\n\n");
    let words = words();
    let mut groups: Vec<(&str, &str)> = Vec::new();
    // a method of texts, lists or dicts stands with its like
    let group = |word: &Word| match word.kind {
        "method of a text" => ("", "Methods of texts"),
        "method of a list" => ("", "Methods of lists"),
        "method of a dict" => ("", "Methods of dicts"),
        _ => (word.group, ""),
    };
    for word in &words {
        if !groups.contains(&group(word)) {
            groups.push(group(word));
        }
    }
    for (name, title) in groups {
        let title = if title.is_empty() { name } else { title };
        writeln!(out, "**{title}**\n").unwrap();
        for word in words
            .iter()
            .filter(|w| group(w) == (name, "") || group(w).1 == title)
        {
            // functions of numbers may have the names of patterns
            let picture = match title {
                "Patterns" if !word.kind.starts_with("method") => picture(word.name),
                _ => String::new(),
            };
            writeln!(out, "### `{}`\n\n{picture}{}\n", signature(word), word.doc).unwrap();
            let said: Vec<_> = word.params.iter().filter(|p| !p.2.is_empty()).collect();
            if said.is_empty() {
                continue;
            }
            out.push_str("| parameter | default | |\n| --- | --- | --- |\n");
            for (name, default, doc) in said {
                let default = if default.is_empty() {
                    "must be given"
                } else {
                    default
                };
                writeln!(
                    out,
                    "| `{name}` | {} | {doc} |",
                    default.replace('|', "\\|")
                )
                .unwrap();
            }
            out.push('\n');
        }
    }
}

/// A page with what stands between its marks written anew.
fn between(page: &str, mark: &str, table: &str) -> String {
    let begin = format!("<!-- {mark} -->\n");
    let (before, rest) = page.split_once(&begin).expect("the mark of the table");
    let (_, after) = rest
        .split_once("<!-- end -->")
        .expect("the end of the table");
    format!("{before}{begin}\n{table}\n<!-- end -->{after}")
}

/// Holds a page of the documentation, or writes it.
fn held(name: &str, wanted: impl FnOnce(&str) -> String) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs")
        .join(name);
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let page = wanted(&kept);
    if std::env::var_os("ZEROSET_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
        return;
    }
    assert!(
        kept == page,
        "docs/{name} is not what the catalogue and the language say: \
         ZEROSET_BLESS=1 cargo test --workspace --test reference_page"
    );
}

#[test]
fn the_functions_of_formulas_are_listed() {
    held("formulas.md", |page| {
        let mut table = String::from("| function | |\n| --- | --- |\n");
        for word in formula_functions() {
            writeln!(table, "| `{}` | {} |", signature(&word), word.doc).unwrap();
        }
        between(page, "functions", &table)
    });
}

#[test]
fn the_words_of_other_tools_are_listed() {
    held("coming-from.md", |page| {
        let mut table = String::from("| elsewhere | here |\n| --- | --- |\n");
        for synonym in SYNONYMS {
            let words: Vec<String> = synonym.words.iter().map(|w| format!("`{w}`")).collect();
            writeln!(
                table,
                "| {} | {} |",
                words.join(", "),
                synonym.write.replace('|', "\\|")
            )
            .unwrap();
        }
        between(page, "words", &table)
    });
}

/// Everything that `zeroset fields` explains stands on the page.
#[test]
fn no_name_is_missing() {
    let page = page();
    for word in words() {
        assert!(
            page.contains(&format!("### `{}`", signature(&word))),
            "{}",
            word.name
        );
    }
    for info in catalogue().infos() {
        assert!(
            page.contains(&format!("### `{}`", info.name)),
            "{}",
            info.name
        );
    }
}

/// Examples of the pages are scenes.
#[test]
fn examples_load() {
    // the files that they speak of
    let folder = tempfile::tempdir().unwrap();
    let disc =
        "x var-x\ny var-y\na square x\nb square y\nc add a b\nd sqrt c\nr const 0.5\nout sub d r\n";
    for name in ["prospero.vm", "bear.vm"] {
        std::fs::write(folder.path().join(name), disc).unwrap();
    }
    for name in ["formulas.md", "coming-from.md"] {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
            .join("../../docs")
            .join(name);
        let page = std::fs::read_to_string(&path).unwrap();
        let mut options = Options::default();
        // of a debug build on a busy machine
        options.limits.seconds = 60.0;
        let mut count = 0;
        for block in page.split("```python\n").skip(1) {
            let (text, _) = block.split_once("```").expect("the end of an example");
            let loaded = load_text(
                "scene.star",
                text,
                Language::Starlark,
                Some(folder.path()),
                &options,
            );
            if let Err(failed) = loaded {
                panic!("{name}: {}\n{text}", failed.report);
            }
            count += 1;
        }
        assert!(count >= 3, "{name}");
    }
}

fn page() -> String {
    let all = catalogue();
    let mut out = String::from(
        "# Field reference\n\nGenerated from the catalogue of fields, the words of the language and the registry of methods: the same as `zeroset fields`. Lengths are scene units, angles \
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
    language(&mut out);
    methods(&mut out);
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

#[test]
fn the_reference_page_is_what_the_catalogue_says() {
    held("fields.md", |_| page());
}
