//! Rays, depth, normals, objects and time by closed forms.

use crate::known::{Check, Draw, Eye, Found, Lens, SIZE, ball, compare, loaded, scene, value};
use glam::DVec3;
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 3] = [
    Check {
        name: "balls through a pinhole",
        run: |draw| balls(draw, Lens::Fov(50.0)),
    },
    Check {
        name: "balls in parallel rays",
        run: |draw| balls(draw, Lens::Height(4.5)),
    },
    Check {
        name: "time moves",
        run: time,
    },
];

/// Two balls, at odd places, from an odd side: what is seen where, how far, and how it faces.
fn balls(draw: Draw, lens: Lens) -> Found {
    let eye = Eye {
        at: DVec3::new(3.0, 2.0, 4.0),
        target: DVec3::new(0.2, 0.3, -0.1),
        up: DVec3::new(0.2, 1.0, 0.0),
        lens,
        size: SIZE,
    };
    let balls = [
        (DVec3::new(-0.6, 0.2, 0.3), 0.9),
        (DVec3::new(1.0, 0.9, -0.2), 0.6),
    ];
    let text: String = balls
        .iter()
        .map(|(c, r)| format!("show(sphere({r}).move({}, {}, {}))\n", c.x, c.y, c.z))
        .collect();
    let film = draw(&scene(&text, &eye));
    // the nearest ball that the ray through a place meets: distance, normal, number
    let hit = |x: f64, y: f64| {
        let ray = eye.ray(x, y);
        let hits = balls
            .iter()
            .zip(1..)
            .filter_map(|(&(centre, radius), number)| {
                let t = ball(ray, centre, radius)?;
                let normal = (ray.0 + ray.1 * t - centre) / radius;
                Some((t, normal, f64::from(number)))
            });
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    // beside a silhouette nothing is compared: what the middle of a pixel sees, its corners must see too
    let sure = |x: f64, y: f64| {
        let corners = [(0.7, 0.7), (0.7, -0.7), (-0.7, 0.7), (-0.7, -0.7)];
        let number = |h: Option<(f64, DVec3, f64)>| h.map_or(0.0, |h| h.2);
        let own = number(hit(x, y));
        corners
            .iter()
            .all(|(u, v)| number(hit(x + u, y + v)) == own)
            .then(|| hit(x, y))
    };
    let steep = |n: DVec3, x: f64, y: f64| -n.dot(eye.ray(x, y).1) > 0.2;
    let number = |x, y| Some(DVec3::splat(sure(x, y)?.map_or(0.0, |h| h.2)));
    compare(&film, &eye, Plane::Object, 0.0, number)?;
    let cover = |x, y| Some(DVec3::splat(sure(x, y)?.map_or(0.0, |_| 1.0)));
    compare(&film, &eye, Plane::Coverage, 0.0, cover)?;
    let depth = |x, y| {
        let (t, n, _) = sure(x, y)??;
        steep(n, x, y).then(|| DVec3::splat(t))
    };
    compare(&film, &eye, Plane::Depth, 0.005, depth)?;
    let normal = |x, y| {
        let (_, n, _) = sure(x, y)??;
        steep(n, x, y).then_some(n)
    };
    compare(&film, &eye, Plane::Normal, 0.005, normal)?;
    let nothing = eye.pixels().find(|(x, y, u, v)| {
        sure(*u, *v) == Some(None) && value(&film, Plane::Depth, *x, *y).x != f64::INFINITY
    });
    match nothing {
        Some((x, y, ..)) => Err(format!("nothing is seen at ({x}, {y}), yet it has a depth")),
        None => Ok(()),
    }
}

/// `time()` is the second that is asked for.
fn time(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 4.0);
    let text = format!(
        "show(sphere(0.5).move(x = time()))\n{}render(aa = none(), ao = none())",
        eye.line()
    );
    for time in [0.0, 0.75, -1.25] {
        let options = Options {
            time,
            size: Some(SIZE),
            ..Options::default()
        };
        let scene = load_text("known.star", &text, Language::Starlark, None, &options);
        let film = draw(&scene.map_err(|e| e.to_string())?.scene);
        let seen = |x: f64, y: f64| {
            let from = eye.on_plane(x, y).distance(glam::DVec2::new(time, 0.0));
            let clear = (from - 0.5).abs() > 1.5 * eye.pixel();
            clear.then(|| DVec3::splat(if from < 0.5 { 1.0 } else { 0.0 }))
        };
        compare(&film, &eye, Plane::Object, 0.0, seen)?;
    }
    Ok(())
}

/// What is not asked for stands still.
#[test]
fn without_a_time_it_is_zero() {
    let still = loaded("show(sphere(1 + time()))", SIZE, None);
    let bounds = still.finite_bounds().unwrap();
    assert!((bounds.max[0] - 1.0).abs() < 1e-6, "{bounds:?}");
}
