use super::contour::Piece;
use super::*;
use proptest::prelude::*;
use zeroset_catalogue::Primitive;
use zeroset_catalogue::flat::{Outline, winding};
use zeroset_number::{Args, Data, F64, v3};

fn set(text: &str, layout: &Layout) -> Text {
    Font::new(default_font(), 0)
        .and_then(|f| f.set(text, layout))
        .unwrap_or_else(|e| panic!("{e}"))
}

fn distance(outline: &[f64], x: f64, y: f64) -> f64 {
    let stored = Data::from(outline.iter().map(|&x| x as f32).collect::<Vec<f32>>());
    Outline::distance(v3(F64(x), F64(y), F64(0.0)), Args::new(&stored)).0
}

#[test]
fn letters_have_the_shapes_that_they_should() {
    let text = set("O l", &Layout::default());
    assert_eq!(text.glyphs.len(), 2, "a space leaves no mark");
    let o = &text.glyphs[0];
    assert!(Outline::check(&o.outline).is_ok());
    let b = Outline::bounds(&o.outline);
    let (middle, height) = (b.centre(), b.max[1] - b.min[1]);
    assert!((0.7..0.85).contains(&height), "{height}");
    assert!(
        distance(&o.outline, middle[0], middle[1]) > 0.1,
        "O has a hole"
    );
    assert!(
        distance(&o.outline, b.min[0] + 0.08, middle[1]) < -0.05,
        "and a side"
    );
    assert!(distance(&o.outline, b.min[0] - 0.3, middle[1]) > 0.29);
    let l = &text.glyphs[1];
    assert!(l.position[0] > b.max[0] + 0.3 && l.position[1] == 0.0);
    let b = Outline::bounds(&l.outline);
    assert!(b.min[1] == 0.0 && distance(&l.outline, b.centre()[0], 0.3) < -0.05);
}

#[test]
fn lines_are_aligned_and_spaced() {
    let wide = |layout: &Layout| set("Wide\ni", layout);
    let left = wide(&Layout::default());
    let last = |t: &Text| t.glyphs[t.glyphs.len() - 1].position;
    assert_eq!(left.glyphs[0].position, [0.0, 0.0]);
    assert!(last(&left)[0] == 0.0 && (-1.3..-1.0).contains(&last(&left)[1]));
    let aligned = |align: Align| {
        wide(&Layout {
            align,
            ..Layout::default()
        })
    };
    let (right, centre) = (aligned(Align::Right), aligned(Align::Centre));
    assert!((right.glyphs[0].position[0] + right.width).abs() < 1e-12);
    assert!((centre.glyphs[0].position[0] + centre.width / 2.0).abs() < 1e-12);
    assert!((last(&centre)[0] - last(&right)[0] / 2.0).abs() < 1e-12);
    let airy = wide(&Layout {
        letter_spacing: 0.5,
        line_spacing: 2.0,
        size: 2.0,
        ..Layout::default()
    });
    assert!(
        (airy.width - 2.0 * left.width - 3.0).abs() < 1e-9,
        "{} {}",
        airy.width,
        left.width
    );
    assert!((last(&airy)[1] - 4.0 * last(&left)[1]).abs() < 1e-9);
    let middle = set(
        "H",
        &Layout {
            vertical: Vertical::Middle,
            ..Layout::default()
        },
    );
    let b = Outline::bounds(&middle.glyphs[0].outline);
    assert!((middle.glyphs[0].position[1] + b.centre()[1]).abs() < 1e-3);
}

#[test]
fn pairs_are_kerned() {
    let plain = Layout {
        kerning: false,
        ..Layout::default()
    };
    let (near, far) = (set("AVAVA", &Layout::default()), set("AVAVA", &plain));
    assert!(near.width < far.width - 0.1, "{} {}", near.width, far.width);
}

#[test]
fn curves_keep_the_tolerance() {
    let outline = |tolerance: f64| {
        let text = set(
            "O&S",
            &Layout {
                tolerance,
                ..Layout::default()
            },
        );
        text.glyphs
            .into_iter()
            .map(|g| g.outline)
            .collect::<Vec<_>>()
    };
    let (coarse, fine) = (outline(0.01), outline(1e-5));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!(
            coarse[0] * 4.0 < fine[0],
            "{} pieces, {}",
            coarse[0],
            fine[0]
        );
        let mut worst = 0f64;
        for i in 0..400 {
            let (x, y) = (f64::from(i % 20) / 20.0, f64::from(i / 20) / 20.0);
            worst = worst.max((distance(coarse, x, y) - distance(fine, x, y)).abs());
        }
        assert!(worst <= 0.0101 && worst > 1e-4, "{worst}");
    }
}

#[test]
fn a_character_that_the_font_lacks_is_drawn_as_that() {
    let text = set("\u{10ffff}", &Layout::default());
    assert_eq!(text.glyphs.len(), 1);
    assert_eq!(
        text.glyphs[0].outline,
        set("\u{10fffe}", &Layout::default()).glyphs[0].outline
    );
}

#[test]
fn limits_and_settings_are_errors() {
    let font = Font::new(default_font(), 0).unwrap();
    let long = "x".repeat(CHARACTERS + 1);
    let given = CHARACTERS + 1;
    assert_eq!(
        font.set(&long, &Layout::default()),
        Err(TextError::TooLong { given })
    );
    let fine = Layout {
        tolerance: 1e-5,
        ..Layout::default()
    };
    let tolerance = fine.tolerance;
    assert_eq!(
        font.set(&"@".repeat(2000), &fine),
        Err(TextError::TooDetailed { tolerance })
    );
    for bad in [
        Layout { size: 0.0, ..fine },
        Layout {
            size: f64::NAN,
            ..fine
        },
        Layout {
            tolerance: 1.0,
            ..fine
        },
        Layout {
            letter_spacing: f64::INFINITY,
            ..fine
        },
        Layout {
            line_spacing: -1.0,
            ..fine
        },
    ] {
        assert!(
            matches!(font.set("a", &bad), Err(TextError::Setting { .. })),
            "{bad:?}"
        );
    }
    assert!(matches!(Font::new(b"no font", 0), Err(TextError::Font(_))));
    assert!(matches!(Font::new(&[], 0), Err(TextError::Font(_))));
    assert!(Font::new(&default_font()[..2000], 0).is_err());
}

fn ring(corners: &[[f64; 2]]) -> Vec<Piece> {
    (0..corners.len())
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            [a[0], a[1], b[0], b[1]]
        })
        .collect()
}

fn square(x: f64, y: f64, half: f64) -> Vec<Piece> {
    ring(&[
        [x - half, y - half],
        [x + half, y - half],
        [x + half, y + half],
        [x - half, y + half],
    ])
}

/// Where a point's winding number is not zero, and the distance to the true edge of that, by search.
fn inside(pieces: &[Piece], at: [f64; 2]) -> bool {
    winding(pieces.as_flattened(), at) != 0
}

#[test]
fn overlaps_leave_the_outer_edge() {
    // two crossing squares, one within another, one the other way round, two that touch
    let both = [square(0.0, 0.0, 1.0), square(0.75, 0.5, 1.0)].concat();
    assert_eq!(boundary(both.clone()).len(), 8);
    let nested = [square(0.0, 0.0, 1.0), square(0.0, 0.0, 0.5)].concat();
    assert_eq!(boundary(nested).len(), 4);
    let hole: Vec<Piece> = square(0.0, 0.0, 0.5)
        .into_iter()
        .map(|[a, b, c, d]| [c, d, a, b])
        .collect();
    assert_eq!(
        boundary([square(0.0, 0.0, 1.0), hole.clone()].concat()).len(),
        8
    );
    // the inside comes to the left
    let mut turned = boundary(hole);
    turned.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut wanted = square(0.0, 0.0, 0.5);
    wanted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    assert_eq!(turned, wanted);
    let beside = boundary([square(0.0, 0.0, 1.0), square(2.0, 0.5, 1.0)].concat());
    assert!(inside(&beside, [0.9, 0.0]) && inside(&beside, [1.1, 0.0]));
    let edge = boundary(both.clone());
    let list: Vec<f64> = std::iter::once(8.0)
        .chain(edge.iter().flatten().copied())
        .collect();
    assert!(
        (distance(&list, 0.375, 0.25) + 0.375f64.hypot(1.0)).abs() < 0.4,
        "deep inside"
    );
    assert!(
        distance(&list, 1.0, 0.25) < -0.2,
        "on an edge that is none any more"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn edges_of_random_contours_enclose_the_same(
        corners in prop::collection::vec(prop::collection::vec((0..32i32, 0..32i32), 3..8), 1..4),
        points in prop::collection::vec((0.0..32.0f64, 0.0..32.0f64), 60),
    ) {
        let contours: Vec<Piece> = corners
            .iter()
            .flat_map(|c| ring(&c.iter().map(|&(x, y)| [f64::from(x), f64::from(y)]).collect::<Vec<_>>()))
            .filter(|p| (p[0], p[1]) != (p[2], p[3]))
            .collect();
        let edge = boundary(contours.clone());
        for (x, y) in points {
            let near = contours.iter().chain(&edge).any(|p| {
                let list = [1.0, p[0], p[1], p[2], p[3]];
                distance(&list, x, y).abs() < 1e-4
            });
            prop_assert!(near || inside(&contours, [x, y]) == inside(&edge, [x, y]), "at ({x}, {y})");
        }
    }

    /// Fonts with damaged bytes, most of them where reading goes: an error or a text, never a panic, and soon.
    #[test]
    fn damaged_fonts_are_no_panic(
        damage in prop::collection::vec((prop_oneof![1 => Just(0), 40 => 1..12usize], 0..3i32, 0.0..1.0f64, any::<u8>()), 1..24),
        cut in prop::option::weighted(0.1, 0.0..1.0f64),
        text in "[A-Za-z@&é\u{2c2}\n\t ]{1,6}",
    ) {
        let mut bytes = default_font().to_vec();
        let tables = tables(&bytes);
        for (table, head, place, value) in damage {
            let (start, end) = tables[table % tables.len()];
            // anywhere, near the table's head and in it, where its structure is
            let at = start + ((end - start) as f64 * place.powi(1 + 5 * head)) as usize;
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate((bytes.len() as f64 * cut) as usize);
        }
        let before = std::time::Instant::now();
        let set = Font::new(&bytes, 0).and_then(|f| f.set(&text, &Layout::default()));
        for glyph in set.map(|t| t.glyphs).unwrap_or_default() {
            prop_assert!(Outline::check(&glyph.outline).is_ok());
            prop_assert!(glyph.position.iter().chain(&glyph.outline[..]).all(|x| x.is_finite()));
        }
        prop_assert!(before.elapsed().as_secs() < 5, "{:?}", before.elapsed());
    }
}

/// The header, and where the tables lie that texts are made from.
fn tables(font: &[u8]) -> Vec<(usize, usize)> {
    let word = |at: usize| u32::from_be_bytes(font[at..at + 4].try_into().unwrap()) as usize;
    let count = usize::from(u16::from_be_bytes([font[4], font[5]]));
    let mut out = vec![(0, 12 + 16 * count)];
    for record in (0..count).map(|i| 12 + 16 * i) {
        let used = [
            "cmap", "glyf", "head", "hhea", "hmtx", "kern", "loca", "maxp", "GPOS", "OS/2",
        ];
        if used
            .iter()
            .any(|tag| tag.as_bytes() == &font[record..record + 4])
        {
            let start = word(record + 8);
            out.push((start, start + word(record + 12)));
        }
    }
    out
}
