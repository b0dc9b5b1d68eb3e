//! What mathematics says a picture must hold, asked of every renderer: the plain one, the SIMD stream and the GPU.
//!
//! Renderers share formulas, so that comparing them with each other cannot find a formula that is wrong. Here the right
//! numbers come from elsewhere: closed forms in double precision, of simple scenes seen straight on. A check that cannot fail
//! proves nothing: planted faults in scenes and in the text of shaders must turn it red.
//!
//! The GPU's part runs on any adapter, software included, and says why it did not run where there is none.

#![allow(unreachable_pub, reason = "the modules of a test are its own")]

mod advection;
mod around;
mod camera;
mod coat;
mod colours;
mod faults;
mod film;
mod known;
mod lamps;
mod lens;
mod light;
mod paths;
mod pattern;
mod shadow;
mod sky;
mod skylight;
mod triplanar;
mod ways;

use known::Check;
use zeroset::gpu::testing;
use zeroset::scene::film::Film;
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::scene::Scene;
use zeroset::trace::CpuRenderer;
use zeroset_testkit::plain::{self, Compiled, Quality};

/// Every check.
fn checks() -> Vec<Check> {
    let groups: [&[Check]; 12] = [
        &camera::CHECKS,
        &coat::CHECKS,
        &colours::CHECKS,
        &film::CHECKS,
        &lamps::CHECKS,
        &lens::CHECKS,
        &light::CHECKS,
        &pattern::CHECKS,
        &shadow::CHECKS,
        &sky::CHECKS,
        &triplanar::CHECKS,
        &ways::CHECKS,
    ];
    groups.concat()
}

fn check_named(name: &str) -> Check {
    let own = checks().into_iter();
    let mut all = own
        .chain(paths::CHECKS)
        .chain(skylight::CHECKS)
        .chain(advection::CHECKS);
    let found = all.find(|c| c.name == name);
    found.unwrap_or_else(|| panic!("no check is called {name}"))
}

fn on(renderer: &dyn Renderer, scene: &Scene) -> Film {
    renderer.render(scene, &Silent).expect("a picture").film
}

fn on_plain(renderer: &CpuRenderer, scene: &Scene) -> Film {
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let program = picture.program();
    let quality = Quality::of(program, scene);
    plain::render(scene, &quality, || Compiled::new(program, None))
}

/// All checks with one renderer.
fn all(draw: &dyn Fn(&Scene) -> Film) {
    right(&checks(), draw);
}

/// Some checks with one renderer.
fn right(checks: &[Check], draw: &dyn Fn(&Scene) -> Film) {
    let wrong: Vec<String> = checks
        .iter()
        .filter_map(|check| Some(format!("{}: {}", check.name, (check.run)(draw).err()?)))
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// All ways of light, with one renderer.
fn all_paths(draw: &dyn Fn(&Scene) -> Film) {
    right(&paths::CHECKS, draw);
}

#[test]
fn skylight_is_right() {
    let renderer = CpuRenderer::new(None).unwrap();
    right(&skylight::CHECKS, &|scene| on(&renderer, scene));
    right(&skylight::CHECKS, &|scene| on_plain(&renderer, scene));
}

#[test]
fn skylight_is_right_on_the_gpu() {
    let Some(gpu) = testing::renderer("known values of skylight on the GPU") else {
        return;
    };
    right(&skylight::CHECKS, &|scene| on(&gpu, scene));
}

#[test]
fn light_that_flows_is_right() {
    let renderer = CpuRenderer::new(None).unwrap();
    right(&advection::CHECKS, &|scene| on(&renderer, scene));
    right(&advection::CHECKS, &|scene| on_plain(&renderer, scene));
}

#[test]
fn light_that_flows_is_right_on_the_gpu() {
    let Some(gpu) = testing::renderer("known values of light that flows on the GPU") else {
        return;
    };
    right(&advection::CHECKS, &|scene| on(&gpu, scene));
}

#[test]
fn paths_are_right() {
    let renderer = CpuRenderer::new(None).unwrap();
    all_paths(&|scene| on(&renderer, scene));
}

#[test]
fn paths_are_right_on_the_gpu() {
    let Some(gpu) = testing::renderer("known values of paths on the GPU") else {
        return;
    };
    all_paths(&|scene| on(&gpu, scene));
}

#[test]
fn the_simd_renderer_is_right() {
    let renderer = CpuRenderer::new(None).unwrap();
    all(&|scene| on(&renderer, scene));
}

#[test]
fn the_plain_renderer_is_right() {
    let renderer = CpuRenderer::new(None).unwrap();
    all(&|scene| on_plain(&renderer, scene));
}

#[test]
fn the_gpu_is_right() {
    let Some(gpu) = testing::renderer("known values on the GPU") else {
        return;
    };
    all(&|scene| on(&gpu, scene));
}
