//! `--noise`, `--checkpoint` and `--resume`.

use crate::run::Folder;
use std::time::{Duration, Instant};

const SCENE: &str =
    "show(sphere(0.8))\nshow(plane().move(y = -0.8))\ncamera(eye = (2, 1.5, 3), target = (0, 0, 0))
render(integrator = path(3))\n";

#[test]
fn a_picture_ends_when_there_is_little_noise() {
    let folder = Folder::with(SCENE);
    let ended = folder.good("render scene.star --size 70x40 --noise 0.05 --json --backend cpu");
    let summary = ended.json();
    let noise = |s: &serde_json::Value| s["noise"].as_f64().unwrap();
    let rays = |s: &serde_json::Value| s["rays_a_pixel"].as_f64().unwrap();
    assert!(
        noise(&summary) <= 0.05 && rays(&summary) >= 100.0,
        "{summary}"
    );
    // as many rays as are allowed, and a word on what is left
    let ended =
        folder.good("render scene.star --size 70x40 --noise 0.0001 --spp 160 --json --backend cpu");
    let summary = ended.json();
    assert!(
        noise(&summary) > 0.0001 && rays(&summary) >= 160.0,
        "{summary}"
    );
    assert!(ended.err.contains("--spp allows more"), "{}", ended.err);
    folder.bad("render scene.star --noise 0", 2, &["above 0"]);
    folder.bad("render scene.star --resume", 2, &["--checkpoint"]);
}

/// A process that is killed in the middle leaves a checkpoint, from which another one makes the same picture, bit for bit, as one that
/// was left alone, on another number of threads.
#[test]
fn a_killed_picture_goes_on_to_the_bit() {
    let folder = Folder::with(SCENE);
    let asked = "render scene.star --size 140x70 --noise 0.012 --spp 4096 --backend cpu";
    folder.good(&format!("{asked} -o whole.exr --threads 1"));
    let asked = format!("{asked} -o parts.exr --checkpoint a.ckpt --checkpoint-every 0.001");
    let mut child = folder
        .command(&format!("{asked} --resume"))
        .spawn()
        .unwrap();
    let began = Instant::now();
    while !folder.path("a.ckpt").exists() {
        assert!(began.elapsed() < Duration::from_secs(120), "no checkpoint");
        std::thread::sleep(Duration::from_millis(1));
    }
    // on Unix this is SIGKILL
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(
        !folder.path("parts.exr").exists(),
        "it was finished before it was killed"
    );
    let ended = folder.good(&format!("{asked} --resume --threads 2"));
    assert!(ended.err.contains("Going on from"), "{}", ended.err);
    assert!(folder.read("parts.exr") == folder.read("whole.exr"));
    // a finished one has nothing left to do, and more can be asked of it
    let again = folder.good(&format!("{asked} --resume --json"));
    assert_eq!(again.json()["rays"], 0);
    assert!(folder.read("parts.exr") == folder.read("whole.exr"));
}

#[test]
fn other_checkpoints_are_refused() {
    let folder = Folder::with(SCENE);
    let asked = "--size 40x30 --spp 16 --backend cpu --checkpoint a.ckpt";
    folder.good(&format!("render scene.star {asked}"));
    let held = folder.read("a.ckpt");
    folder.bad(
        &format!("render scene.star {asked}"),
        4,
        &["a.ckpt exists already", "--resume"],
    );
    let bad = |asked: &str, words: &[&str]| {
        folder.bad(&format!("{asked} --resume"), 4, words);
        assert!(folder.read("a.ckpt") == held, "{asked}");
    };
    bad(
        "render scene.star --size 41x30 --spp 16 --backend cpu --checkpoint a.ckpt",
        &["another picture", "size", "40x30 there, 41x30 here"],
    );
    bad(
        &format!("render scene.star {asked} --integrator path,depth=4"),
        &["its settings differs", "integrator"],
    );
    folder.write("other.star", SCENE.replace("0.8))", "0.7))"));
    bad(
        &format!("render other.star {asked}"),
        &["another picture", "what the scene shows"],
    );
    folder.write("moved.star", SCENE.replace("(2, 1.5, 3)", "(2, 1.5, 5)"));
    bad(
        &format!("render moved.star {asked}"),
        &["its camera differs", "eye"],
    );
    // a comment is no other scene, and more rays are no other picture
    folder.write("same.star", format!("# the same\n{SCENE}"));
    let more = "--size 40x30 --spp 48 --backend cpu --checkpoint a.ckpt";
    let ended = folder.good(&format!("render same.star {more} --resume --json"));
    assert_eq!(ended.json()["rays_a_pixel"], 48.0);
    let mut damaged = folder.read("a.ckpt");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 4;
    folder.write("a.ckpt", &damaged);
    folder.bad(
        &format!("render scene.star {more} --resume"),
        4,
        &["damaged", "check sum"],
    );
    folder.write("a.ckpt", "no checkpoint at all");
    folder.bad(
        &format!("render scene.star {more} --resume"),
        4,
        &["it is not a checkpoint"],
    );
}

#[test]
fn time_ends_a_picture_that_converges() {
    let folder = Folder::with(SCENE);
    let asked = "render scene.star --size 70x40 --noise 0.00001 --backend cpu --checkpoint a.ckpt";
    let ended = folder.run(&format!("{asked} --time-limit 3 --json"));
    assert_eq!(ended.code, Some(5), "{}", ended.err);
    let said = ended.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("ended by the time limit of 3 s"), "{said}");
    let rays = ended.json()["rays_a_pixel"].as_f64().unwrap();
    // what it had is in the picture and in the checkpoint
    let ended = folder.run(&format!("{asked} --time-limit 1 --resume --json"));
    assert!(ended.json()["rays_a_pixel"].as_f64().unwrap() >= rays);
}
