//! What drivers do rarely, brought about on purpose.

use crate::{Counting, RenderInto, check, toy};
use std::sync::PoisonError;
use std::time::{Duration, Instant};
use zeroset_gpu::testing::{self, Faults, with_faults};
use zeroset_gpu::{Choice, GpuError, GpuRenderer, Kind};
use zeroset_scene::film::Film;
use zeroset_scene::render::{RenderError, Silent};

#[test]
fn memory_that_runs_out_makes_bands_smaller() {
    // each allocation of the first picture fails once
    for number in 1..12 {
        let faults = Faults::default().failing_allocations([number]);
        let Some(renderer) = with_faults("memory_that_runs_out_makes_bands_smaller", faults) else {
            return;
        };
        let job = toy([200, 150], 2, 0.0);
        let mut film = Film::new(200, 150);
        let counting = Counting::default();
        renderer
            .render_into(&job, &mut film, &counting)
            .expect("a picture");
        check(&film, &job);
        let seen = *counting.seen.lock().unwrap_or_else(PoisonError::into_inner);
        assert_eq!(seen, (60_000, 60_000));
    }
}

#[test]
fn a_picture_fits_into_little_memory() {
    let faults = Faults::default().with_memory(2 << 20);
    let Some(renderer) = with_faults("a_picture_fits_into_little_memory", faults) else {
        return;
    };
    let job = toy([512, 512], 1, 0.0);
    let mut film = Film::new(512, 512);
    renderer
        .render_into(&job, &mut film, &Silent)
        .expect("a picture");
    check(&film, &job);
    let timings = renderer.timings().expect("a picture was made");
    assert!(timings.retries > 0 && timings.bands > 5, "{timings:?}");
    // what was learned stays
    renderer
        .render_into(&job, &mut film, &Silent)
        .expect("a picture");
    assert_eq!(renderer.timings().map(|t| t.retries), Some(0));
}

#[test]
fn no_memory_at_all_is_an_error() {
    let faults = Faults::default().with_memory(20_000);
    let Some(renderer) = with_faults("no_memory_at_all_is_an_error", faults) else {
        return;
    };
    let job = toy([512, 512], 1, 0.0);
    let mut film = Film::new(512, 512);
    let error = renderer.render_into(&job, &mut film, &Silent).err();
    assert!(
        matches!(error, Some(GpuError::OutOfMemory { .. })),
        "{error:?}"
    );
    let error = RenderError::from(error.expect("it is one"));
    assert!(matches!(error, RenderError::Device { .. }), "{error}");
}

#[test]
fn a_lost_device_is_opened_anew() {
    for number in [0, 3, 6, 8] {
        let faults = Faults::default().losing_at([number]);
        let Some(renderer) = with_faults("a_lost_device_is_opened_anew", faults.clone()) else {
            return;
        };
        let job = toy([300, 300], 2, 10.0);
        let mut film = Film::new(300, 300);
        let counting = Counting::default();
        renderer
            .render_into(&job, &mut film, &counting)
            .expect("a picture");
        check(&film, &job);
        assert_eq!(renderer.timings().map(|t| t.retries), Some(1));
        assert_eq!(faults.counts()[2], 2);
        let seen = *counting.seen.lock().unwrap_or_else(PoisonError::into_inner);
        assert_eq!(seen, (180_000, 180_000));
    }
}

#[test]
fn a_device_that_is_lost_twice_is_an_error_and_the_next_picture_a_new_chance() {
    let test = "a_device_that_is_lost_twice_is_an_error_and_the_next_picture_a_new_chance";
    let Some(renderer) = with_faults(test, Faults::default().losing_at([2, 4])) else {
        return;
    };
    let job = toy([100, 100], 1, 0.0);
    let mut film = Film::new(100, 100);
    let error = renderer.render_into(&job, &mut film, &Silent).err();
    assert!(matches!(error, Some(GpuError::Lost { .. })), "{error:?}");
    renderer
        .render_into(&job, &mut film, &Silent)
        .expect("a picture");
    check(&film, &job);
}

#[test]
fn a_device_that_does_not_come_back_is_an_error() {
    let faults = Faults::default().losing_at([2]).refusing_devices([1]);
    let Some(renderer) = with_faults("a_device_that_does_not_come_back_is_an_error", faults) else {
        return;
    };
    let job = toy([100, 100], 1, 0.0);
    let error = renderer
        .render_into(&job, &mut Film::new(100, 100), &Silent)
        .err();
    assert!(
        matches!(error, Some(GpuError::NoDevice { .. })),
        "{error:?}"
    );
}

#[test]
fn a_device_that_is_not_given_is_an_error() {
    let error =
        GpuRenderer::with_faults(&Choice::Any, Faults::default().refusing_devices([0])).err();
    match error {
        Some(GpuError::NoDevice { .. }) => {}
        Some(GpuError::NoAdapter { .. }) => println!("there is no adapter to refuse a device"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_device_that_does_not_answer_is_lost() {
    let faults = Faults::default().with_patience(Duration::from_micros(200));
    let Some(renderer) = with_faults("a_device_that_does_not_answer_is_lost", faults) else {
        return;
    };
    // milliseconds of work in one workgroup, where software does it
    let job = toy([8, 8], 1, 65_000.0);
    let began = Instant::now();
    match renderer.render_into(&job, &mut Film::new(8, 8), &Silent) {
        Err(error @ GpuError::Lost { .. }) => {
            assert!(error.to_string().contains("did not answer"), "{error}");
        }
        Ok(_) if renderer.adapter().kind != Kind::Software => println!("a fast device"),
        other => panic!("{other:?}"),
    }
    assert!(began.elapsed() < Duration::from_secs(30));
}

/// llvmpipe ends all loops of a thread once they have made 65,535 turns together, those of inner loops counted in.
#[test]
fn loops_that_end_early_are_an_error() {
    let Some(renderer) = testing::renderer("loops_that_end_early_are_an_error") else {
        return;
    };
    let ends_early = renderer.adapter().name.contains("llvmpipe");
    let flat = "for (var i = 0u; i < u32(params[0]); i++) { work = fract(work * 1.3 + f32(i) * table[0].x); }";
    let nested = "for (var j = 0u; j < u32(params[0]); j++) { for (var i = 0u; i < u32(params[0]); i++) { work = \
                  fract(work * 1.3 + f32(i) * table[0].x); } }";
    let split = "for (var j = 0u; j < u32(params[0]); j++) { work = fract(work * 1.3 + f32(j) * table[0].x); } \
                 for (var i = 0u; i < u32(params[0]); i++) { work = fract(work * 1.7 + f32(i) * table[0].x); }";
    for (text, turns, long) in [
        (flat, 65_000.0, false),
        (flat, 66_000.0, true),
        (nested, 250.0, false),
        (nested, 260.0, true),
        (split, 32_000.0, false),
        (split, 33_000.0, true),
    ] {
        let mut job = toy([20, 20], 2, turns);
        assert!(job.source.contains(flat));
        job.source = job.source.replace(flat, text).into();
        let mut film = Film::new(20, 20);
        match renderer.render_into(&job, &mut film, &Silent) {
            Ok(_) => {
                assert!(!(long && ends_early), "{turns} turns of {text}");
                check(&film, &job);
            }
            Err(GpuError::Loops { .. }) => assert!(long && ends_early, "{turns} turns of {text}"),
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn a_renderer_can_be_sent_to_another_thread() {
    fn sendable<T: Send + Sync>() {}
    sendable::<GpuRenderer>();
}
