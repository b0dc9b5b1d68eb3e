//! Formulas over SIMD lanes must become vector code.
//!
//! One function or closure on the way that is not inlined is compiled without vector instructions, and everything it is given
//! goes through memory: the whole formula is then many times slower than it should be, and nothing else shows it. To look at
//! the code itself: `objdump -d` of a release build, which should be full of `zmm` (AVX-512) or `ymm` (AVX2) registers.
//! `zeroset bench eval` measures it as `simd_over_scalar`.

/// The files whose every function runs over lanes.
const SOURCES: [(&str, &str); 9] = [
    ("args", include_str!("../../src/args.rs")),
    ("dual", include_str!("../../src/dual.rs")),
    ("elementary", include_str!("../../src/elementary.rs")),
    ("hash", include_str!("../../src/hash.rs")),
    ("lanes", include_str!("../../src/lanes.rs")),
    ("list", include_str!("../../src/list.rs")),
    ("real", include_str!("../../src/real.rs")),
    ("scalar", include_str!("../../src/scalar.rs")),
    ("vector", include_str!("../../src/vector.rs")),
];

/// Functions with a body that are not `#[inline(always)]` (nor kept out of line on purpose).
fn not_inlined(source: &str) -> Vec<String> {
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let is_function = |line: &str| {
        let line = line
            .trim_start_matches("pub ")
            .trim_start_matches("pub(super) ");
        line.starts_with("fn ") || line.starts_with("const fn ")
    };
    let has_body = |i: usize| {
        let end = lines[i..]
            .iter()
            .find(|l| l.ends_with('{') || l.ends_with(';') || l.ends_with('}'));
        end.is_some_and(|l| !l.ends_with(';'))
    };
    let is_marked = |i: usize| {
        let above = lines[..i]
            .iter()
            .rev()
            .take_while(|l| l.starts_with("#[") || l.starts_with("//"));
        let mut marks = above.filter(|l| l.starts_with("#[inline("));
        marks.any(|l| *l == "#[inline(always)]" || *l == "#[inline(never)]")
    };
    (0..lines.len())
        .filter(|i| is_function(lines[*i]) && has_body(*i) && !is_marked(*i))
        .map(|i| lines[i].to_owned())
        .collect()
}

#[test]
fn functions_over_lanes_are_inlined() {
    for (name, source) in SOURCES {
        assert_eq!(not_inlined(source), Vec::<String>::new(), "in {name}.rs");
    }
    let sample = "#[inline(always)]\nfn a() {\n}\nfn b(x: [f32; 2]) -> f32\nwhere\n{\n}\nfn c();\npub fn d() {}\n";
    assert_eq!(
        not_inlined(sample),
        ["fn b(x: [f32; 2]) -> f32", "pub fn d() {}"]
    );
}
