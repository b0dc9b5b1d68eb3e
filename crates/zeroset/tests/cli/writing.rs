//! Files as they are written: the same bytes each time, and an end in the middle.

use crate::run::{BALL, Folder};

#[test]
fn equal_pictures_are_equal_files() {
    let folder = Folder::with(
        "size = slider(\"size\", 0.5)\nother = slider(\"other\", 0.5)\nshow(sphere(size))\n",
    );
    for name in ["a.exr", "a.png"] {
        let command = format!(
            "render scene.star --size 70x40 --set size=0.6 --set other=0.1 --time 2.5 -o {name}"
        );
        folder.good(&command);
        let first = folder.read(name);
        // five entries have 120 orders
        for _ in 0..4 {
            folder.good(&command);
            assert!(folder.read(name) == first, "{name}");
        }
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_file_in_the_middle() {
    use std::process::Command;
    use std::time::{Duration, Instant};
    let folder = Folder::with(BALL);
    for (name, flags) in [("a.exr", ""), ("a.png", "--bits 16")] {
        folder.write(name, "old");
        // noise does not compress, so that the file grows from the first row on
        folder.write(
            "scene.star",
            "show(sphere(0.1))\nrender(aa = none(), ao = none())\n",
        );
        let command = format!("render scene.star --size 3000x3000 -o {name} {flags}");
        let mut child = folder.command(&command).spawn().unwrap();
        let began = Instant::now();
        let is_writing = || {
            let unfinished = folder.names().into_iter().find(|n| n.ends_with(".partial"));
            unfinished
                .is_some_and(|n| std::fs::metadata(folder.path(&n)).is_ok_and(|m| m.len() > 1000))
        };
        while !is_writing() {
            assert!(began.elapsed() < Duration::from_secs(300), "it never wrote");
            assert!(child.try_wait().unwrap().is_none(), "it was too fast");
            std::thread::sleep(Duration::from_millis(2));
        }
        let id = child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-s", "INT", &id])
                .status()
                .unwrap()
                .success()
        );
        let asked = Instant::now();
        assert_eq!(child.wait().unwrap().code(), Some(130), "{name}");
        assert!(
            asked.elapsed() < Duration::from_secs(5),
            "{name}: it took {:?}",
            asked.elapsed()
        );
        assert_eq!(folder.read(name), b"old");
        assert!(
            !folder.names().iter().any(|n| n.ends_with(".partial")),
            "{:?}",
            folder.names()
        );
    }
}

/// What is not watched by anybody ends at once.
#[cfg(unix)]
#[test]
fn ctrl_c_ends_every_command() {
    use std::process::Command;
    let folder = Folder::with("show(sphere())\n");
    let slow = "bench march";
    let mut child = folder.command(slow).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it was too fast");
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-s", "INT", &id])
            .status()
            .unwrap()
            .success()
    );
    let asked = std::time::Instant::now();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(asked.elapsed() < std::time::Duration::from_secs(60));
}

#[test]
fn no_message_names_an_unfinished_file() {
    let folder = Folder::with("show(sphere())\nrender(size = (8, 8))\n");
    folder.write("file", "");
    let long = format!("{}.png", "n".repeat(300));
    for place in [
        "none/a.png",
        "file/a.png",
        "/proc/a.png",
        "/sys/a.png",
        "/dev/full",
        &long,
    ] {
        let ended = folder.run(&format!("render scene.star -o {place}"));
        assert!(
            ended.code == Some(4) || ended.code == Some(2),
            "{place}: {ended:?}"
        );
        assert!(
            !ended.err.contains("partial") && !ended.err.contains(".zeroset-"),
            "{}",
            ended.err
        );
        assert!(
            ended.err.replace("\n", "").contains(&place[..8]),
            "{}",
            ended.err
        );
    }
}
