//! `zeroset fields`.

use crate::args::FieldsArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::json;
use crate::reference::{Entry, entries, limits, methods, page, signature};
use std::fmt::Write;

/// Lists what there is, or explains one name.
pub(crate) fn run(args: &FieldsArgs, console: &Console) -> Result<(), Failure> {
    let entries = entries();
    let Some(name) = &args.name else {
        return console.emit(&if args.json {
            json::pretty(&entries)?
        } else {
            listing(&entries)
        });
    };
    if name == "limits" && !args.json {
        return console.print(&limits());
    }
    if name == "methods" && !args.json {
        return console.emit(&methods());
    }
    // a name may be a shape or a pattern, and a function of formulas as well
    let found: Vec<&Entry> = entries.iter().filter(|e| e.name == name).collect();
    let Some(first) = found.first() else {
        let help = match zeroset_language::report::nearest(name, entries.iter().map(|e| e.name)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`zeroset fields` lists all names".to_owned(),
        };
        return Err(Failure::with_help(
            Exit::Usage,
            format!("the scene language has no `{name}`"),
            help,
        ));
    };
    console.emit(&if args.json {
        json::pretty(first)?
    } else {
        found.iter().map(|e| page(e)).collect::<Vec<_>>().join("\n")
    })
}

/// All entries by group: how each is called, and what it is.
fn listing(entries: &[Entry]) -> String {
    let mut groups: Vec<&str> = Vec::new();
    for entry in entries {
        if !groups.contains(&entry.group) {
            groups.push(entry.group);
        }
    }
    let mut out = String::new();
    for group in groups {
        let _ = writeln!(out, "{}{group}", if out.is_empty() { "" } else { "\n" });
        for entry in entries.iter().filter(|e| e.group == group) {
            let is_method = entry.kind.starts_with("method");
            let dot = if is_method || matches!(entry.kind, "map" | "modifier") {
                "."
            } else {
                ""
            };
            let _ = writeln!(out, "  {dot}{}\n      {}", signature(entry), entry.doc);
        }
    }
    out
}
