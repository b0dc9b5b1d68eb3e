//! Files as editors write them: byte order marks, tabs, letters of all languages; and warnings.

use zeroset_language::load::{Failed, Language, Loaded, Options, load, load_text};

fn star(text: &str) -> Result<Loaded, Failed> {
    load_text(
        "scene.star",
        text,
        Language::Starlark,
        None,
        &Options::default(),
    )
}

fn shown(failed: Failed) -> String {
    let handler =
        miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
    let mut out = String::new();
    handler.render_report(&mut out, &*failed.report).unwrap();
    out
}

/// A file in a folder.
fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

#[test]
fn byte_order_marks() {
    let (_folder, path) = file("scene.star", b"\xef\xbb\xbfshow(sphere())\n");
    assert!(load(&path, &Options::default()).is_ok());
    let (_folder, path) = file(
        "scene.json",
        b"\xef\xbb\xbf{\"zeroset\": 1, \"objects\": [{\"field\": {\"sphere\": {}}}]}",
    );
    assert!(load(&path, &Options::default()).is_ok());
    // of a loaded file, too
    let (folder, path) = file("scene.star", b"load(\"a.star\", \"x\")\nshow(sphere(x))");
    std::fs::write(folder.path().join("a.star"), b"\xef\xbb\xbfx = 2\n").unwrap();
    assert!(load(&path, &Options::default()).is_ok());
    // places count from behind it; in the middle it is a letter like any other
    let failed = star("\u{feff}x = y").unwrap_err();
    assert_eq!(failed.report.position(), Some((1, 5)));
    let failed = star("x = 1\n\u{feff}show(sphere())").unwrap_err();
    assert_eq!(failed.report.position().map(|p| p.0), Some(2));
}

#[test]
fn tabs_do_not_move_marks() {
    for line in [
        "x =\t1 +\tmissing",
        "x = [1,\t\t\t2, missing]",
        "x = \"\t\t\" + missing",
        "x = 1\t\t+ missing\t# a comment",
        "x = \"\u{e4}\u{4f60}\" +\t missing",
    ] {
        // a tab between words is refused by the language itself; it may stand in texts and comments
        let text = format!("{line}\n");
        let report = shown(star(&text).unwrap_err());
        let lines: Vec<&str> = report.lines().collect();
        let at = lines
            .iter()
            .position(|l| l.contains("missing") && l.contains("x ="))
            .unwrap();
        let mark = lines[at + 1];
        // how wide a character is on a terminal
        let width = |s: &str| -> usize {
            s.chars()
                .map(|c| if (c as u32) >= 0x4e00 { 2 } else { 1 })
                .sum()
        };
        let wanted = if report.contains("tabs are not allowed") {
            continue;
        } else {
            width(&lines[at][..lines[at].find("missing").unwrap()])
        };
        let begin = mark
            .find(|c: char| "\u{2500}\u{252c}^".contains(c))
            .map(|i| width(&mark[..i]));
        assert_eq!(begin, Some(wanted), "{line:?}\n{report}");
        assert!(!lines[at].contains('\t'), "{report}");
    }
}

#[test]
fn names_of_any_letters() {
    let prints = |text: &str| match star(&format!("{text}\nshow(sphere())")) {
        Ok(loaded) => loaded.log.join("|"),
        Err(failed) => panic!("{text}: {} {:?}", failed.report, failed.report.position()),
    };
    assert_eq!(prints("gr\u{f6}\u{df}e = 3\nprint(gr\u{f6}\u{df}e)"), "3");
    assert_eq!(
        prints("\u{e9} = 1\n\u{df} = 2\n\u{3b1} = 3\nprint(\u{e9} + \u{df} * \u{3b1})"),
        "7"
    );
    assert_eq!(
        prints("\u{4e2d}\u{6587} = 4\nprint(\u{4e2d}\u{6587}, \"\u{4e2d}\")"),
        "4 \u{4e2d}"
    );
    assert_eq!(prints("\u{10400}x = 4\nprint(\u{10400}x)"), "4");
    assert_eq!(
        prints(
            "def f\u{fc}r(\u{e4}, *\u{f6}, \u{fc} = 2, **\u{df}):\n    return (\u{e4}, \u{f6}, \u{fc}, \u{df})\nprint(f\u{fc}r(1, 5, \u{fc} = 3, \u{e9} = 4))"
        ),
        "(1, (5,), 3, {\"\u{e9}\": 4})"
    );
    assert_eq!(
        prints("def f(\u{e9}):\n    return \u{e9}\nprint(f(**{\"\u{e9}\": 1}))"),
        "1"
    );
    assert_eq!(
        prints("print([\u{e4} * \u{f6} for \u{e4} in [1, 2] for \u{f6} in [3] if \u{e4} > 1])"),
        "[6]"
    );
    assert_eq!(
        prints("print({\u{e4}: \u{f6} for \u{e4}, \u{f6} in [(1, 2)]})"),
        "{1: 2}"
    );
    assert_eq!(
        prints(
            "f = lambda \u{3c6}, \u{3c8} = 2: \u{3c6} * \u{3c8}\nprint(f(3), f(3, \u{3c8} = 1))"
        ),
        "6 3"
    );
    assert_eq!(
        prints("\u{3c0}\u{3c0} = 2\nprint(f\"{\u{3c0}\u{3c0}} \u{3c0}\u{3c0} {{\u{3c0}}}\")"),
        "2 \u{3c0}\u{3c0} {\u{3c0}}"
    );
    assert_eq!(
        prints(
            "\u{e4} = [1]\n\u{e4}[0] += 2\n\u{e4} += [\u{e4}[0]]\nfor \u{f6} in \u{e4}:\n    print(\u{f6})"
        ),
        "3|3"
    );
    // texts and comments stay as they are
    assert_eq!(
        prints(
            "# \u{e4} = \u{201c}x\u{201d}\nx = '\u{e4}\" # \u{e4}' # \u{f6}\nprint(x)\ny = \"\"\"\u{e4}\n\u{f6}\"\"\"\nprint(r'\\\u{e4}')"
        ),
        "\u{e4}\" # \u{e4}|\\\u{e4}"
    );
    // one name, however its letters are composed, as in Python
    assert_eq!(prints("\u{e9}t\u{e9} = 5\nprint(e\u{301}te\u{301})"), "5");
    assert_eq!(prints("\u{fb01} = 5\nprint(fi)"), "5");
    // every name of two bytes that a file can have
    let many: String = (0xc0..0x250_u32)
        .filter_map(char::from_u32)
        .filter(|c| c.is_alphabetic())
        .map(|c| format!("{c} = 1\n"))
        .collect();
    let all_plain: String = (b'A'..=b'Z')
        .flat_map(|a| (b'a'..=b'z').map(move |b| format!("{}{} = 2\n", a as char, b as char)))
        .collect();
    assert_eq!(
        prints(&format!("{many}{all_plain}print(\u{e9}, Zz)")),
        "1 2"
    );
    // across files
    let (folder, path) = file("scene.star", "load(\"teil.star\", \"gr\u{f6}\u{df}e\", \u{fc} = \"h\u{f6}he\")\nprint(gr\u{f6}\u{df}e, \u{fc})\nshow(sphere())".as_bytes());
    std::fs::write(
        folder.path().join("teil.star"),
        "gr\u{f6}\u{df}e = 1\nh\u{f6}he = 2\n",
    )
    .unwrap();
    let loaded = load(&path, &Options::default())
        .map_err(|f| f.report.to_string())
        .unwrap();
    assert_eq!(loaded.log, ["1 2"]);
}

#[test]
fn mistakes_with_letters_of_any_kind() {
    for (text, says, at) in [
        (
            "gr\u{f6}\u{df}e = 1\nx = gr\u{f6}\u{df}er",
            "there is no `gr\u{f6}\u{df}er`",
            (2, 5),
        ),
        ("\u{e4}\u{e4} = \u{f6} + 1", "there is no `\u{f6}`", (1, 6)),
        ("def f(\u{e4}, \u{e4}):\n    pass", "duplicated", (1, 10)),
        ("\u{e4} = 1\n\u{e4}.\u{f6}()", "`\u{f6}`", (2, 3)),
        ("sphere(\u{e4} = 1)", "no argument `\u{e4}`", (1, 8)),
        (
            "def \u{e4}(x):\n    pass\n\u{e4}()",
            "\u{e4}() needs `x`",
            (3, 1),
        ),
        ("\u{e4} = \u{201c}text\u{201d}", "invalid input", (1, 5)),
        ("x = 3 \u{2212} 1", "invalid input", (1, 7)),
        ("x = 2\u{e4}", "", (1, 6)),
        ("x = 1\u{a0}+ 1", "invalid input", (1, 6)),
        ("x = \u{1f600}", "invalid input", (1, 5)),
    ] {
        let failed = star(text).unwrap_err();
        assert!(
            failed.report.message().contains(says),
            "{text}: {}",
            failed.report
        );
        assert_eq!(
            failed.report.position(),
            Some(at),
            "{text}: {}",
            failed.report
        );
    }
    let hint = |text: &str| {
        star(text)
            .unwrap_err()
            .report
            .hint()
            .unwrap_or_default()
            .to_string()
    };
    assert!(hint("gr\u{f6}\u{df}e = 1\nx = gr\u{f6}se").contains("gr\u{f6}\u{df}e"));
    assert!(hint("x = 3 \u{2212} 1").contains('-'));
    assert!(hint("x = \u{201c}a\u{201d}").contains('"'));
    assert!(hint("x = 2 ** 3").contains("pow"));
}

#[test]
fn characters_that_a_font_lacks() {
    let loaded = star("show(text(\"a\u{4e2d}b\u{4e2d}\u{6587}\"))").unwrap();
    let [warning] = loaded.warnings.as_slice() else {
        panic!("{:?}", loaded.warnings)
    };
    let message = warning.message();
    assert!(
        message.contains("\u{4e2d} (U+4E2D)") && message.contains("U+6587"),
        "{message}"
    );
    assert_eq!(warning.position(), Some((1, 11)));
    assert_eq!(
        miette::Diagnostic::severity(warning),
        Some(miette::Severity::Warning)
    );
    let loaded = star("show(text(\"plain \u{e4}\u{3b1}\\n\u{a0}x\"))").unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    // once for each place, however often
    let loaded = star("show(union([text(\"\u{4e2d}\").move(x = i) for i in range(50)]))").unwrap();
    assert_eq!(loaded.warnings.len(), 1);
}

#[test]
fn comments_are_no_expressions() {
    let words = format!("# {}\n", "word ".repeat(20_000));
    assert!(star(&format!("{words}show(sphere())")).is_ok());
    let lines = "# ((((((((( word\n".repeat(20_000);
    assert!(star(&format!("{lines}show(sphere())")).is_ok());
    assert!(star(&format!("show(sphere(\n{lines}1))\n{lines}")).is_ok());
    assert!(
        star(&format!(
            "x = [\n{}]\nshow(sphere())",
            "    1,  # one\n".repeat(20_000)
        ))
        .is_ok()
    );
    assert!(
        star(&format!(
            "def f():\n{}    return 1\nshow(sphere(f()))",
            "    # word\n".repeat(20_000)
        ))
        .is_ok()
    );
}
