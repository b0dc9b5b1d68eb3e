use crate::{Counting, RenderInto, check, toy};
use zeroset_gpu::{GpuError, testing};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{RenderError, Silent};
use zeroset_scene::settings::Filter;

#[test]
fn a_picture_is_the_same_in_any_bands() {
    let Some(renderer) = testing::renderer("a_picture_is_the_same_in_any_bands") else {
        return;
    };
    let mut renderer = renderer;
    for (budget, size, fits) in [
        (256 << 20, [97, 61], true),
        (1 << 20, [97, 61], false),
        (1 << 20, [640, 203], false),
        (3 << 20, [640, 203], false),
        (256 << 20, [640, 480], true),
        (256 << 20, [1, 1], true),
        (256 << 20, [3, 100], true),
    ] {
        renderer = renderer.with_budget(budget);
        let job = toy(size, 3, 0.0);
        let mut film = Film::new(size[0], size[1]);
        let counting = Counting::default();
        let statistics = renderer
            .render_into(&job, &mut film, &counting)
            .expect("a picture");
        check(&film, &job);
        let rays = u64::from(size[0] * size[1]) * 3;
        assert_eq!(*counting.seen.lock().expect("no panic"), (rays, rays));
        let timings = renderer.timings().expect("a picture was made");
        assert!(timings.bands > 1 || fits, "{timings:?}");
        // bands trace the rows between them twice
        assert!(statistics.rays >= rays, "{statistics:?}");
        let doubled = u64::from(4 * (timings.bands - 1) * size[0]) * 3;
        assert!(statistics.rays <= rays + doubled, "{statistics:?}");
        assert!(statistics.evaluations.march >= 3 << 32, "{statistics:?}");
        assert!(statistics.hits >= u64::from(3 * size[1]));
        assert!(statistics.evaluations.prepass > 0);
        assert_eq!(timings.retries, 0);
        assert!(timings.wall > 0.0 && timings.stages.total() > 0.0);
    }
}

#[test]
fn a_film_gets_the_planes_that_it_has() {
    let Some(renderer) = testing::renderer("a_film_gets_the_planes_that_it_has") else {
        return;
    };
    let mut job = toy([50, 40], 0, 0.0);
    (job.frame.prepass, job.frame.filter_kind) = (0, Filter::Box as u32);
    let mut film = Film::with(50, 40, &[Plane::Depth]);
    renderer
        .render_into(&job, &mut film, &Silent)
        .expect("a picture");
    assert!(film.plane(Plane::Depth).iter().all(|d| *d == 7.0));
    assert!(!film.has(Plane::Colour));

    let mut film = Film::with(50, 40, &[]);
    let statistics = renderer
        .render_into(&job, &mut film, &Silent)
        .expect("no picture");
    assert_eq!(statistics.rays, 2000);

    let mut film = Film::with(3, 3, &[Plane::Colour, Plane::Depth]);
    renderer
        .render_into(&job, &mut film, &Silent)
        .expect("a picture of another size");
    assert_eq!([film.width(), film.height()], [50, 40]);
    check(&film, &job);
}

#[test]
fn dear_pictures_are_dispatched_in_tiles() {
    let Some(renderer) = testing::renderer("dear_pictures_are_dispatched_in_tiles") else {
        return;
    };
    let (cheap, dear) = (toy([256, 256], 1, 1.0), toy([256, 256], 1, 20_000.0));
    let mut film = Film::new(256, 256);
    renderer
        .render_into(&cheap, &mut film, &Silent)
        .expect("a picture");
    renderer
        .render_into(&dear, &mut film, &Silent)
        .expect("a picture");
    renderer
        .render_into(&dear, &mut film, &Silent)
        .expect("a picture");
    check(&film, &dear);
    let timings = renderer.timings().expect("a picture was made");
    let trace = timings
        .stages
        .iter()
        .find(|s| s.0 == "trace")
        .expect("a stage")
        .1;
    println!("{timings:?}");
    // other work on the machine makes tiles longer: the limit itself is tested on a model in `pace`
    assert!(f64::from(timings.dispatches) >= trace / 0.1, "{timings:?}");
    if trace > 0.2 {
        assert!(timings.longest < trace / 2.0, "{timings:?}");
    }
}

#[test]
fn a_picture_can_be_cancelled_and_begun_again() {
    let Some(renderer) = testing::renderer("a_picture_can_be_cancelled_and_begun_again") else {
        return;
    };
    let job = toy([256, 256], 50, 300.0);
    let mut film = Film::new(256, 256);
    for enough in [0, 1, 100_000] {
        let counting = Counting {
            enough: Some(enough),
            ..Counting::default()
        };
        let error = renderer.render_into(&job, &mut film, &counting).err();
        assert_eq!(
            error,
            Some(GpuError::Scene(RenderError::Cancelled)),
            "{enough}"
        );
        let (seen, total) = *counting.seen.lock().expect("no panic");
        assert!(seen < 256 * 256 * 50, "{seen} of {total}");
    }
    let job = toy([70, 70], 2, 0.0);
    renderer
        .render_into(&job, &mut film, &Silent)
        .expect("a picture");
    check(&film, &job);
}

#[test]
fn a_shader_that_does_not_compile_is_an_error_with_its_log() {
    let test = "a_shader_that_does_not_compile_is_an_error_with_its_log";
    let Some(renderer) = testing::renderer(test) else {
        return;
    };
    let good = toy([20, 20], 1, 0.0);
    let mut film = Film::new(20, 20);
    for broken in [
        "fn trace() -> Nothing { }",
        "",
        "@compute @workgroup_size(8, 8) fn trace() {}",
    ] {
        let job = zeroset_gpu::Job {
            source: broken.into(),
            ..good.clone()
        };
        match renderer.render_into(&job, &mut film, &Silent) {
            Err(GpuError::Shader { log }) => assert!(log.len() > 20, "{log}"),
            other => panic!("{other:?}"),
        }
    }
    renderer
        .render_into(&good, &mut film, &Silent)
        .expect("a picture");
    check(&film, &good);
}

#[test]
fn a_scene_that_fits_into_no_buffer_is_an_error() {
    let Some(renderer) = testing::renderer("a_scene_that_fits_into_no_buffer_is_an_error") else {
        return;
    };
    let largest = renderer.adapter().largest_binding;
    if largest > 1 << 28 {
        println!("buffers of {largest} bytes are not filled here");
        return;
    }
    let job = zeroset_gpu::Job {
        table: vec![[1.0; 4]; largest as usize / 16 + 1].into(),
        ..toy([20, 20], 1, 0.0)
    };
    let error = renderer
        .render_into(&job, &mut Film::new(20, 20), &Silent)
        .err();
    assert!(
        matches!(error, Some(GpuError::TooLarge { .. })),
        "{error:?}"
    );
}
