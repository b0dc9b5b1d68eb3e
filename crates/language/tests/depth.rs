//! Calls, blocks and expressions inside each other: one budget for all of them, whatever the limits say.
//!
//! A stack that overflows ends the process, so that a test of it cannot fail by itself: what counts is that all of these come
//! to an end.

use zeroset_language::limits::Limits;
use zeroset_language::load::{Failed, Language, Loaded, Options, load_text};

/// Limits that forbid nothing.
fn none() -> Limits {
    Limits {
        nodes: 1 << 40,
        objects: 1 << 40,
        nesting: 1 << 40,
        ticks: 1 << 50,
        heap: 1 << 40,
        calls: 1 << 40,
        seconds: 1e6,
        file_bytes: 1 << 40,
        ..Limits::default()
    }
}

fn load(text: &str, limits: Limits) -> Result<Loaded, Failed> {
    let options = Options {
        limits,
        ..Options::default()
    };
    load_text("deep.star", text, Language::Starlark, None, &options)
}

/// A name, and the text that nests so deeply.
type Form = (&'static str, fn(usize) -> String);

/// Expressions with `f(n - 1)` below so many levels of themselves. Some open brackets, of which there may be 100.
fn forms() -> Vec<Form> {
    fn around(n: usize, open: &str, close: &str) -> String {
        format!("{}f(n - 1){}", open.repeat(n), close.repeat(n))
    }
    vec![
        ("minus", |n| around(n, "-", "")),
        ("plus", |n| around(n, "+", "")),
        ("tilde", |n| around(n, "~", "")),
        ("not", |n| around(n, "not ", "")),
        ("brackets", |n| around(n, "(", ")")),
        ("sums", |n| around(n, "1 + ", "")),
        ("sums on the left", |n| around(n, "", " + 1")),
        ("sums in brackets", |n| around(n, "(1 + ", ")")),
        ("and", |n| around(n, "True and ", "")),
        ("or", |n| around(n, "", " or 1")),
        ("conditionals", |n| around(n, "0 if n < 0 else ", "")),
        ("conditions", |n| around(n, "(1 if (", ") else 0)")),
        ("lists", |n| around(n, "[", "]")),
        ("lists and indices", |n| around(n, "[", "][0]")),
        ("tuples", |n| around(n, "(", ",)")),
        ("dicts", |n| around(n, "{1: ", "}")),
        ("indices", |n| around(n, "[0, 0][0 * len(str(", "))]")),
        ("slices", |n| around(n, "[0][len(str(", ")):]")),
        ("comprehensions", |n| {
            around(n, "[x for y in [0] for x in [", "]]")
        }),
        ("conditions of comprehensions", |n| {
            around(n, "[0 for x in [0] if ", "]")
        }),
        ("dict comprehensions", |n| {
            around(n, "{0: x for x in [", "]}")
        }),
        ("sort keys", |n| {
            around(n, "sorted([1], key = lambda x: ", ")")
        }),
        ("lambdas", |n| around(n, "(lambda: ", ")()")),
        ("defaults of lambdas", |n| {
            around(n, "(lambda x = ", ": x)()")
        }),
        ("calls", |n| around(n, "str(", ")")),
        ("arguments by name", |n| {
            around(n, "dict(pairs = [(0, ", ")])")
        }),
        ("unpacked arguments", |n| around(n, "str(*[", "])")),
        ("methods", |n| around(n, "\"\".join([str(", ")])")),
        ("texts", |n| around(n, "\"%s\" % (", ",)")),
        ("formulas", |n| {
            around(n, "[field(lambda p: p.x + 0 * len(str(", "))), 0][1]")
        }),
    ]
}

/// Functions whose calls lie below `n` levels of a form.
fn script(form: fn(usize) -> String, n: usize, calls: usize) -> String {
    format!(
        "def f(n):\n    return 0 if n == 0 else {}\nf({calls})\nshow(sphere())",
        form(n)
    )
}

#[test]
fn calls_times_expressions() {
    for (name, form) in forms() {
        for (n, calls) in [
            (3900, 98),
            (1000, 98),
            (300, 98),
            (90, 98),
            (20, 98),
            (8, 98),
        ] {
            // the limits as they are, and none
            for limits in [Limits::default(), none()] {
                let unlimited = limits == none();
                let calls = if unlimited { 100 * calls } else { calls };
                let result = load(&script(form, n, calls), limits);
                if let Err(failed) = &result {
                    let report = &failed.report;
                    assert!(report.position().is_some(), "{name} {n}: {report}");
                }
                if unlimited {
                    // nothing else is in the way
                    let failed = result.map(|_| ()).expect_err(name);
                    let report = failed.report;
                    let deep = [
                        "inside each other",
                        "compared",
                        "work between",
                        "must be",
                        "must give",
                        "needs",
                    ];
                    assert!(
                        deep.iter().any(|says| report.message().contains(says)),
                        "{name} {n}: {report}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_is_below_the_budget_runs() {
    let limits = Limits {
        calls: 100_000,
        seconds: 60.0,
        ..Limits::default()
    };
    let runs = |text: &str| {
        let text = format!("{text}\nshow(sphere())");
        let failed = load(&text, limits).map(|_| ()).err();
        assert!(
            failed.is_none(),
            "{:.200}: {}",
            text,
            failed.unwrap().report
        );
    };
    // one long expression, as long as the parser takes
    runs(&format!("x = {}1", "-".repeat(3990)));
    runs(&format!("x = {}True", "not ".repeat(3990)));
    runs(&format!("x = 1{}", " + 1".repeat(1990)));
    runs(&format!("x = {}1", "0 if False else ".repeat(990)));
    runs(&format!("f = {}1", "lambda: ".repeat(1990)));
    runs(&format!("x = {}1{}", "(".repeat(99), ")".repeat(99)));
    runs(&format!("x = {}1{}", "[".repeat(99), "]".repeat(99)));
    runs(&format!("x = \"\"{}", ".strip()".repeat(1300)));
    // many calls with a little in each, and few with much
    runs("def f(n):\n    if n > 0:\n        return f(n - 1)\n    return 0\nf(900)");
    runs("f = lambda f, n: f(f, n - 1) if n > 0 else 0\nf(f, 1200)");
    runs("def f(n):\n    return [x for x in [0 if n == 0 else f(n - 1)]]\nf(450)");
    runs("def f(n):\n    return sorted([1], key = lambda x: 0 if n == 0 else f(n - 1))\nf(400)");
    runs(
        "def f(n):\n    for i in range(1):\n        for j in range(1):\n            if n > 0:\n                f(n - 1)\nf(400)",
    );
    runs(&format!(
        "def f(n):\n    return 0 if n == 0 else {}f(n - 1)\nf(90)",
        "-".repeat(90)
    ));
    // the ordinary limits
    let text = format!(
        "def f(n):\n    return 0 if n == 0 else {}f(n - 1)\nf(98)\nshow(sphere())",
        "-".repeat(60)
    );
    assert!(load(&text, Limits::default()).is_ok());
}

#[test]
fn texts_that_nest_deeply() {
    let n = 200_000;
    let blocks = |head: &str, n: usize| -> String {
        let lines = (0..n).map(|i| format!("{}{head}\n", " ".repeat(i)));
        lines.collect::<String>() + &" ".repeat(n) + "pass"
    };
    for (name, text) in [
        ("open brackets", "(".repeat(n)),
        (
            "brackets",
            format!("x = {}1{}", "(".repeat(n), ")".repeat(n)),
        ),
        ("lists", format!("x = {}{}", "[".repeat(n), "]".repeat(n))),
        (
            "lists with more in them",
            format!("x = {}{}", "[1, ".repeat(n), "]".repeat(n)),
        ),
        (
            "dicts",
            format!("x = {}0{}", "{0: ".repeat(n), "}".repeat(n)),
        ),
        (
            "calls",
            format!("x = {}0{}", "f(0, ".repeat(n), ")".repeat(n)),
        ),
        (
            "indices",
            format!("x = {}0{}", "a[".repeat(n), "]".repeat(n)),
        ),
        ("not", format!("x = {}1", "not ".repeat(n))),
        ("minus", format!("x = {}1", "-".repeat(n))),
        ("conditionals", format!("x = {}1", "1 if 0 else ".repeat(n))),
        (
            "conditions",
            format!("x = {}1{}", "1 if ".repeat(n), " else 0".repeat(n)),
        ),
        ("lambdas", format!("x = {}1", "lambda: ".repeat(n))),
        (
            "lambdas with parameters",
            format!("x = {}1", "lambda a, b: ".repeat(n)),
        ),
        (
            "lambdas in defaults",
            format!("x = {}1{}", "lambda a = ".repeat(n), ": 1".repeat(n)),
        ),
        (
            "lambdas behind lambdas",
            format!("x = {}1", "lambda a = lambda: 1, b = 2: ".repeat(n)),
        ),
        ("sums", format!("x = 1{}", " + 1".repeat(n))),
        ("powers of two", format!("x = 1{}", " << 1".repeat(n))),
        ("and", format!("x = 1{}", " and 1".repeat(n))),
        (
            "comparisons in brackets",
            format!("x = {}1{}", "(1 < ".repeat(n), ")".repeat(n)),
        ),
        ("attributes", format!("x = a{}", ".b".repeat(n))),
        ("calls of calls", format!("x = a{}", "()".repeat(n))),
        (
            "targets",
            format!("{}x{} = 1", "(".repeat(n), ",)".repeat(n)),
        ),
        (
            "comprehensions",
            format!("x = {}0{}", "[0 for a in ".repeat(n), "]".repeat(n)),
        ),
        (
            "clauses",
            format!("x = [0{}]", " for a in b if a".repeat(n)),
        ),
        ("format texts", format!("x = {}1", "f'{".repeat(n))),
        (
            "format texts in format texts",
            format!("x = {}1{}", "f'{[".repeat(n), "]}'".repeat(n)),
        ),
        ("blocks", blocks("if x:", 2200)),
        ("loops", blocks("for x in y:", 2200)),
        ("functions", blocks("def f():", 2200)),
        (
            "elif",
            format!("if a:\n    pass\n{}", "elif a:\n    pass\n".repeat(n / 10)),
        ),
        (
            "statements in a line",
            format!("x = 1{}", "; x = 1".repeat(n)),
        ),
        (
            "loads",
            format!("load(\"a.star\", {})", "\"x\", ".repeat(n)),
        ),
    ] {
        for limits in [Limits::default(), none()] {
            // ends, in whatever way
            let result = load(&text, limits);
            if let Err(failed) = result {
                // a text may also be more than there is memory for, as a whole
                let report = &failed.report;
                let whole = ["memory", "shows nothing"];
                let whole = whole.iter().any(|says| report.message().contains(says));
                assert!(whole || report.position().is_some(), "{name}: {report}");
            }
        }
    }
}

#[test]
fn values_that_nest_deeply() {
    for last in [
        "print(a)",
        "x = a == b",
        "x = a < b",
        "d = {a: 1}",
        "x = a in [b]",
        "x = str(a)",
        "x = \"%r\" % (a,)",
        "fail(a)",
        "x = sorted([a, b])",
        "x = min(a, b)",
    ] {
        for deepen in ["[x]", "(x,)", "{0: x}", "[x, x]", "(x, x)"] {
            let more = |name: &str| format!("{name} = {}", deepen.replace('x', name));
            let text = format!(
                "a = (0,)\nb = (0,)\nfor i in range(100000):\n    {}\n    {}\n{last}\nshow(sphere())",
                more("a"),
                more("b")
            );
            let result = load(&text, Limits::default());
            if let Err(failed) = result {
                assert!(
                    failed.report.position().is_some(),
                    "{last}: {}",
                    failed.report
                );
            }
        }
    }
    // a list in itself is equal to itself, and written as far as it goes
    let text = "a = [0]\na.append(a)\nprint(a)\nx = a == [0, a]\nshow(sphere())";
    let loaded = load(text, Limits::default()).unwrap();
    assert!(loaded.log[0].contains("..."), "{:?}", loaded.log);
}

#[test]
fn fields_that_nest_deeply() {
    for deepen in [
        "a = a.blend(sphere(), 0.1)",
        "a = sphere() - a",
        "a = a.round(0.0001)",
        "a = a.stretch((1, 1.0001, 1))",
        "a = a.twist(0.001)",
        "a = a.paint(\"red\").move(x = 0.001)",
        "a = a.polar(1)",
        "a = ~a",
        "a = a.blend(a, 0.1)",
    ] {
        let text = format!("a = sphere()\nfor i in range(1000):\n    {deepen}\nshow(a)");
        let failed = load(&text, Limits::default())
            .map(|_| ())
            .expect_err(deepen);
        let message = failed.report.message();
        assert!(
            message.contains("deep") || message.contains("fields"),
            "{deepen}: {message}"
        );
        assert_eq!(failed.report.position().map(|p| p.0), Some(3), "{deepen}");
    }
    // as deep as they may be, on a small stack: written as JSON, compiled, dropped
    let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(|| {
        let text = "a = sphere()\nfor i in range(500):\n    a = a.blend(sphere(), 0.1)\nshow(a)";
        let loaded = load(text, Limits::default()).unwrap();
        let json = zeroset_language::json::to_text(
            &zeroset_language::json::expand(&loaded.scene).unwrap(),
        );
        assert!(json.len() > 10_000);
        let field = loaded.scene.field().unwrap().unwrap();
        let program = zeroset_field::program::Program::compile(&field, &Default::default());
        assert!(program.is_ok());
    });
    thread.unwrap().join().unwrap();
}
