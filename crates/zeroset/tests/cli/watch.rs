//! `--watch`: edit, break, mend, and a file that is loaded later.

use crate::run::{BALL, Folder};
use std::io::{BufRead, BufReader};
use std::process::Child;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// The program while it watches, with what it says line by line.
struct Watching {
    child: Child,
    said: Receiver<String>,
}

impl Watching {
    fn start(folder: &Folder, arguments: &str) -> Watching {
        let mut child = folder.command(arguments).spawn().unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let (tell, said) = channel();
        std::thread::spawn(move || {
            lines
                .map_while(Result::ok)
                .try_for_each(|line| tell.send(line))
        });
        Watching { child, said }
    }

    /// Everything that is said until a line holds a word.
    #[track_caller]
    fn until(&self, word: &str) -> String {
        let mut all = String::new();
        loop {
            match self.said.recv_timeout(Duration::from_secs(60)) {
                Ok(line) => all += &format!("{line}\n"),
                Err(_) => panic!("waited in vain for `{word}`; it said\n{all}"),
            }
            if all.lines().last().is_some_and(|line| line.contains(word)) {
                return all;
            }
        }
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_scene_is_rendered_again_on_every_save() {
    let folder = Folder::with(BALL);
    let watching = Watching::start(&folder, "render scene.star --size 16x16 --watch");
    watching.until("Waiting for a change of scene.star");
    let first = folder.read("scene.png");

    folder.write("scene.star", "show(sphere(0.8\n");
    let broken = watching.until("Waiting");
    assert!(
        broken.contains("scene.star") && !broken.contains("rays"),
        "{broken}"
    );
    assert!(folder.read("scene.png") == first);

    // a file that the scene loads from now on, saved after the scene and mended later
    folder.write("part.star", "ball = box(1.2)\n");
    folder.write("scene.star", "load(\"part.star\", \"ball\")\nshow(ball)\n");
    let mended = watching.until("Waiting");
    assert!(
        mended.contains("scene.png: 16x16") && mended.contains("and 1 more"),
        "{mended}"
    );
    let second = folder.read("scene.png");
    assert!(first != second);

    // saved the way that many editors do
    folder.write("part.new", "ball = sphere(0.7) - box(1.0)\n");
    std::fs::rename(folder.path("part.new"), folder.path("part.star")).unwrap();
    watching.until("Waiting");
    assert!(folder.read("scene.png") != second);

    std::fs::remove_file(folder.path("part.star")).unwrap();
    assert!(watching.until("Waiting").contains("part.star"));
    folder.write("part.star", "ball = box(1.2)\n");
    watching.until("Waiting");
    assert!(folder.read("scene.png") == second);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_watching_and_a_save_ends_a_rendering() {
    let folder = Folder::with("show(sphere(0.8))\nrender(aa = none())\n");
    let flags = "render scene.star --size 4000x4000 --march fixed=0.00002 --watch";
    let mut watching = Watching::start(&folder, flags);
    std::thread::sleep(Duration::from_millis(500));
    folder.write("scene.star", "show(\n");
    watching.until("Waiting");
    assert_eq!(folder.names(), ["scene.star"]);
    let id = watching.child.id().to_string();
    assert!(
        std::process::Command::new("kill")
            .args(["-s", "INT", &id])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(watching.child.wait().unwrap().code(), Some(0));
}

/// A file that is written all the time, whole each time.
#[test]
fn files_that_never_rest_are_rendered() {
    use std::sync::atomic::{AtomicBool, Ordering};
    // lit by itself: the stage of a scene without lights takes longer
    const LIT: &str = "show(sphere(0.8))\nsun()\n";
    let folder = Folder::with(LIT);
    let ended = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for number in 0.. {
                if ended.load(Ordering::Relaxed) {
                    return;
                }
                folder.write(
                    "scene.new",
                    format!("{LIT}# {}\n", "x".repeat(number % 1000)),
                );
                std::fs::rename(folder.path("scene.new"), folder.path("scene.star")).unwrap();
                std::thread::sleep(Duration::from_millis(20));
            }
        });
        // a picture that takes longer than a file rests
        let watching = Watching::start(
            &folder,
            "render scene.star --size 700x700 --watch --limit seconds=100",
        );
        for _ in 0..2 {
            let said = watching.until("scene.png: 700x700");
            assert!(!said.contains("Waiting"), "{said}");
        }
        ended.store(true, Ordering::Relaxed);
    });
}

#[test]
fn a_mended_file_is_taken_while_a_slow_picture_is_rendered() {
    let slow = "show(sphere())\nrender(size = (512, 512), ao = hemisphere(4096), aa = supersample(4096))\n";
    let folder = Folder::with(slow);
    let watching = Watching::start(&folder, "render scene.star --watch --limit seconds=100");
    for number in 0..3 {
        std::thread::sleep(Duration::from_millis(700));
        let began = std::time::Instant::now();
        folder.write(
            "scene.star",
            format!("show(sphere())\nrender(size = (1{number}, 16))\n"),
        );
        watching.until(&format!("scene.png: 1{number}x16"));
        // hours are left of the other picture
        assert!(
            began.elapsed() < Duration::from_secs(40),
            "{:?}",
            began.elapsed()
        );
        watching.until("Waiting");
        folder.write("scene.star", slow);
    }
}
