//! Programs that nest: bytes become text, and what is put into what how often is all that they choose.
//!
//! Depth has many forms, each with a limit of its own, and limits that hold alone may multiply: calls inside expressions
//! inside calls, sort keys that sort, formulas that call, values that hold values. Random text hardly ever nests twice.
//!
//! This file needs nothing else: an ordinary test includes it too.

use std::fmt::Write;

/// What is put around an expression.
const AROUND: [(&str, &str); 58] = [
    ("-", ""),
    ("+", ""),
    ("~", ""),
    ("not ", ""),
    ("(", ")"),
    ("[", "]"),
    ("(", ",)"),
    ("{0: ", "}"),
    ("{", ": 0}"),
    ("1 + ", ""),
    ("", " + 1"),
    ("2 * (", ")"),
    ("1 < ", ""),
    ("[1] + [", "]"),
    ("True and ", ""),
    ("False or ", ""),
    ("1 if ", " else 2"),
    ("1 if True else ", ""),
    ("0 if False else (", ")"),
    ("[x for x in [", "]]"),
    ("[", " for x in [0]]"),
    ("[0 for x in [0] if ", "]"),
    ("{x: 0 for x in [", "]}"),
    ("{0: ", " for x in [0]}"),
    ("(lambda: ", ")()"),
    ("(lambda x: x)(", ")"),
    ("(lambda x = ", ": x)()"),
    ("(lambda *a: a)(*[", "])"),
    ("(lambda **k: k)(a = ", ")"),
    ("sorted([2, 1], key = lambda v: ", ")"),
    ("sorted([", ", 0])"),
    ("max([1, 2], key = lambda v: ", ")"),
    ("max(0, ", ")"),
    ("len([", "])"),
    ("sum([", "])"),
    ("str(", ")"),
    ("repr(", ")"),
    ("list((", ",))"),
    ("dict(a = ", ")"),
    ("any([", "])"),
    ("\"%s\" % (", ",)"),
    ("\"{}\".format(", ")"),
    ("f\"{", "}\""),
    ("", "[0]"),
    ("[0][", "]"),
    ("[0, 1][", ":]"),
    ("(", ").x"),
    ("(", ").move(x = 1)"),
    ("sphere(1).move(x = ", ")"),
    ("sphere(", ")"),
    ("union([", "])"),
    ("union([sphere(1), ", "])"),
    ("(sphere(1) | ", ")"),
    ("(box(1) - (", "))"),
    ("field(lambda p: ", ")"),
    ("min(p.x, ", ")"),
    ("length((p.x, p.y, ", "))"),
    ("show(", ")"),
];

/// What is in the middle.
const CORES: [&str; 12] = [
    "0",
    "1",
    "x",
    "n",
    "g(0)",
    "p.x",
    "length(p)",
    "sphere(1)",
    "[]",
    "\"x\"",
    "None",
    "time()",
];

/// Statements that hold others.
const BLOCKS: [&str; 6] = [
    "if True:",
    "if x:",
    "for x in [0]:",
    "for i in range(2):",
    "def g(n):",
    "def h(x = 0, *a, **k):",
];

/// What is done with a value that was made.
const USES: [&str; 12] = [
    "print(x)",
    "y = x == x",
    "y = [x] < [x]",
    "y = {x: 1}",
    "y = sorted([x, x])",
    "y = str(x)",
    "y = repr(x)",
    "y = x in [x]",
    "show(x)",
    "y = x + x",
    "y = \"%r\" % (x,)",
    "fail(x)",
];

/// What is put around a field in JSON.
const JSON: [(&str, &str); 8] = [
    (r#"{"union": {"of": ["#, "]}}"),
    (r#"{"union": {"of": [{"sphere": {}}, "#, "]}}"),
    (r#"{"subtraction": {"of": [{"sphere": {}}, "#, "]}}"),
    (r#"{"place": {"offset": [1, 0, 0], "of": "#, "}}"),
    (r#"{"round": {"radius": 0.1, "of": "#, "}}"),
    (r#"{"onion": {"of": "#, "}}"),
    ("[", "]"),
    (r#"{"x": "#, "}"),
];

/// Bytes that are read one by one; zeros follow.
struct Bytes<'a>(std::slice::Iter<'a, u8>);

impl Bytes<'_> {
    fn next(&mut self) -> usize {
        usize::from(self.0.next().copied().unwrap_or(0))
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.next() % choices.len()]
    }

    /// How often: mostly a few times, now and then thousands of times.
    fn times(&mut self) -> usize {
        match self.next() {
            n @ 0..128 => n,
            n @ 128..224 => 8 * (n - 112),
            n => 128 * (n - 216),
        }
    }

    /// The core with one to four kinds of things around it, each so many times. At most so long.
    fn around(&mut self, core: &str, kinds: &[(&str, &str)], longest: usize) -> String {
        let mut text = core.to_string();
        for _ in 0..=self.next() % 4 {
            let (before, after) = self.of(kinds);
            let room = longest.saturating_sub(text.len()) / (before.len() + after.len());
            let times = self.times().min(room);
            text = before.repeat(times) + &text + &after.repeat(times);
        }
        text
    }
}

/// Bytes that a piece of a program may have at most.
const LONGEST: usize = 30_000;

/// The program that the bytes stand for: Starlark, or JSON where it begins with a brace.
pub fn program(bytes: &[u8]) -> String {
    let mut b = Bytes(bytes.iter());
    let mut text = String::new();
    for _ in 0..=b.next() % 3 {
        match b.next() % 9 {
            0 => {
                let core = b.of(&CORES);
                let _ = writeln!(text, "x = {}", b.around(core, &AROUND, LONGEST));
            }
            1 | 2 => recursion(&mut b, &mut text),
            3 => mutual(&mut b, &mut text),
            4 => values(&mut b, &mut text),
            5 => blocks(&mut b, &mut text),
            6 => formula(&mut b, &mut text),
            7 => keys(&mut b, &mut text),
            _ => return json(&mut b),
        }
    }
    text
}

/// A function that calls itself from the midst of an expression.
fn recursion(b: &mut Bytes<'_>, text: &mut String) {
    let call = b.around("f(n - 1)", &AROUND, LONGEST);
    let end = b.of(&CORES);
    let times = b.times();
    let _ = match b.next() % 4 {
        0 => writeln!(
            text,
            "f = lambda n: {end} if n == 0 else {call}\nx = f({times})"
        ),
        1 => writeln!(
            text,
            "def f(n):\n    if n == 0:\n        return {end}\n    x = {call}\n    return x\nx = f({times})"
        ),
        2 => writeln!(
            text,
            "def f(n):\n    for x in [n]:\n        if n > 0:\n            {call}\nf({times})"
        ),
        _ => writeln!(
            text,
            "def f(n):\n    return {end} if n == 0 else {call}\nx = f({times})"
        ),
    };
}

/// Two functions that call each other.
fn mutual(b: &mut Bytes<'_>, text: &mut String) {
    let (one, other) = (
        b.around("g(n - 1)", &AROUND, LONGEST),
        b.around("f(n - 1)", &AROUND, LONGEST),
    );
    let times = b.times();
    let _ = writeln!(
        text,
        "def f(n):\n    return 0 if n <= 0 else {one}\ndef g(n):\n    return 1 if n <= 0 else {other}\nx = f({times})"
    );
}

/// A value that holds values, and what is done with it.
fn values(b: &mut Bytes<'_>, text: &mut String) {
    let core = b.of(&CORES);
    let step = b.around("x", &AROUND, 300);
    let times = b.times() * (1 + b.next() % 16);
    let _ = writeln!(text, "x = {core}\nfor i in range({times}):\n    x = {step}");
    for _ in 0..=b.next() % 3 {
        let _ = writeln!(text, "{}", b.of(&USES));
    }
}

/// Statements inside each other.
fn blocks(b: &mut Bytes<'_>, text: &mut String) {
    let mut depth = 0;
    for _ in 0..=b.next() % 3 {
        let block = b.of(&BLOCKS);
        for _ in 0..b.times().min(150) {
            let _ = writeln!(text, "{}{block}", " ".repeat(depth));
            depth += 1;
        }
    }
    let core = b.of(&CORES);
    let line = b.around(core, &AROUND, 300);
    let _ = writeln!(text, "{}x = {line}", " ".repeat(depth));
}

/// A field by a formula, whose functions call each other.
fn formula(b: &mut Bytes<'_>, text: &mut String) {
    let call = b.around("f(p, n - 1)", &AROUND, 3000);
    let end = b.of(&CORES);
    let times = b.times();
    let outer = b.around(&format!("f(p, {times})"), &AROUND, 3000);
    let _ = writeln!(
        text,
        "def f(p, n):\n    return {end} if n == 0 else {call}\nshow(field(lambda p: {outer}, slope = 9, size = 2))"
    );
}

/// Sorting by what sorts.
fn keys(b: &mut Bytes<'_>, text: &mut String) {
    let inner = b.around("f(n - 1)", &AROUND, 3000);
    let times = b.times();
    let by = b.of(&[
        "sorted([1, 2], key = lambda v: ",
        "max([1, 2], key = lambda v: ",
        "min([[n], [n]], key = lambda v: ",
        "[v for v in [0] if (lambda q: q)(0) == ",
        "(lambda a = 0, *b: a)(",
    ]);
    let close = if by.starts_with('[') { "]" } else { ")" };
    let _ = writeln!(
        text,
        "def f(n):\n    return 0 if n == 0 else {by}{inner}{close}\nx = f({times})"
    );
}

/// A scene in JSON: fields inside each other, parts that use parts.
fn json(b: &mut Bytes<'_>) -> String {
    let mut text = String::from(r#"{"zeroset": 1, "parts": [{"sphere": {}}"#);
    let count = b.times().min(1000);
    let how = b.next() % 3;
    for k in 0..count {
        let _ = match how {
            0 => write!(
                text,
                r#", {{"union": {{"of": [{{"part": {k}}}, {{"part": {k}}}]}}}}"#
            ),
            1 => write!(
                text,
                r#", {{"place": {{"offset": [1, 0, 0], "of": {{"part": {k}}}}}}}"#
            ),
            _ => write!(
                text,
                r#", {{"union": {{"of": [{{"part": {}}}, {{"box": {{}}}}]}}}}"#,
                k / 2
            ),
        };
    }
    let field = b.around(&format!(r#"{{"part": {count}}}"#), &JSON, LONGEST);
    let _ = write!(text, r#"], "objects": [{{"field": {field}}}"#);
    for _ in 0..b.times() {
        let _ = write!(
            text,
            r#", {{"field": {{"part": {}}}}}"#,
            b.next() % (count + 1)
        );
    }
    text + "]}"
}
