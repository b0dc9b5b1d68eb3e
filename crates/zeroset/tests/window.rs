//! The window on a screen: the program, opened under Xvfb on whatever Vulkan device there is (lavapipe in CI), used with a
//! mouse, and looked at.
//!
//! Where the tools or a device are missing, the test says so and passes, unless `ZEROSET_REQUIRE_GPU=1`.

#![cfg(all(target_os = "linux", feature = "window"))]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How long a slow machine may take for anything.
const PATIENCE: Duration = Duration::from_secs(180);
/// How long something that was done may take to be seen, before it is done again.
const AGAIN: Duration = Duration::from_secs(30);
/// Between two looks at the screen.
const PAUSE: Duration = Duration::from_millis(250);
/// Between moving the mouse and pressing it: the window has to see that it is there.
const HAND: Duration = Duration::from_millis(300);
/// Size of the screen, and of the window on it.
const SCREEN: (usize, usize) = (1280, 800);
/// Left of here is the picture, right of here the panel.
const PANEL: usize = 940;
/// The slider of the only parameter: its ends, and its height on the screen.
const SLIDER: (i32, i32, i32) = (1083, 1188, 98);

/// A red ball at the left, a green box at the right, before a grey sky.
const SCENE: &str = "size = slider(\"size\", 0.4, min = 0.2, max = 1.0)
show(sphere(size).move(x = -0.8), material(color = \"#e00000\", specular = 0))
show(box(0.8).move(x = 0.8), material(color = \"#00d000\", specular = 0))
camera(eye = (0, 0, 5), target = (0, 0, 0), fov = 40)
sky(color = \"#8c98a4\", ambient = 0.7)
";

/// What is on the screen.
struct Shot {
    rgb: Vec<[u8; 3]>,
}

impl Shot {
    /// Pixels of a part of the screen that look so: their number, and their middle.
    fn count(
        &self,
        columns: std::ops::Range<usize>,
        like: impl Fn([u8; 3]) -> bool,
    ) -> (usize, f64) {
        let (mut count, mut sum) = (0, 0.0);
        for (i, rgb) in self.rgb.iter().enumerate() {
            let x = i % SCREEN.0;
            if columns.contains(&x) && like(*rgb) {
                count += 1;
                sum += x as f64;
            }
        }
        (count, sum / (count.max(1) as f64))
    }

    fn red(&self) -> (usize, f64) {
        self.count(0..PANEL, |[r, g, b]| {
            r > 90 && u32::from(r) > 3 * u32::from(g.max(b))
        })
    }

    fn green(&self) -> (usize, f64) {
        self.count(0..PANEL, |[r, g, b]| {
            g > 90 && u32::from(g) > 3 * u32::from(r.max(b))
        })
    }

    fn yellow(&self) -> usize {
        self.count(0..PANEL, |[r, g, b]| r > 90 && g > 90 && b < 40)
            .0
    }

    /// The edge of the card that says what is wrong.
    fn wrong(&self) -> usize {
        let near = |a: u8, b: u8| a.abs_diff(b) < 14;
        self.count(0..PANEL, |[r, g, b]| {
            near(r, 240) && near(g, 120) && near(b, 110)
        })
        .0
    }
}

/// A screen with the window on it. Everything ends with it.
struct Window {
    folder: tempfile::TempDir,
    screen: Child,
    display: String,
    program: Option<Child>,
}

impl Drop for Window {
    fn drop(&mut self) {
        for child in self.program.iter_mut().chain([&mut self.screen]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Why there is no window.
enum Missing {
    Tool(String),
    /// Another server took the screen's number at the same moment, which X servers do not keep apart.
    Screen(String),
    Device(String),
}

impl Window {
    fn open(scene: &str) -> Result<Window, Missing> {
        for _ in 0..5 {
            match Window::try_open(scene) {
                Err(Missing::Screen(reason)) => eprintln!("once more: {reason}"),
                other => return other,
            }
            std::thread::sleep(4 * PAUSE);
        }
        Window::try_open(scene)
    }

    fn try_open(scene: &str) -> Result<Window, Missing> {
        for tool in ["Xvfb", "xdotool", "import"] {
            let paths = std::env::var_os("PATH").unwrap_or_default();
            if !std::env::split_paths(&paths).any(|p| p.join(tool).is_file()) {
                return Err(Missing::Tool(format!("{tool} is not installed")));
            }
        }
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.star"), scene).unwrap();
        let size = format!("{}x{}x24", SCREEN.0, SCREEN.1);
        let mut screen = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &size, "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        BufReader::new(screen.stdout.take().unwrap())
            .read_line(&mut number)
            .unwrap();
        let display = format!(":{}", number.trim());
        let mut window = Window {
            folder,
            screen,
            display,
            program: None,
        };
        if number.trim().is_empty() {
            return Err(Missing::Screen("Xvfb gives no screen".into()));
        }
        let mut command = Command::new(env!("CARGO_BIN_EXE_zeroset"));
        command
            .arg(window.path("scene.star"))
            .args(["--threads", "2"])
            .env("DISPLAY", &window.display)
            .env("XDG_RUNTIME_DIR", window.folder.path())
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let lavapipe = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
        if std::env::var_os("VK_DRIVER_FILES").is_none() && fs::exists(lavapipe).unwrap_or(false) {
            command.env("VK_DRIVER_FILES", lavapipe);
        }
        window.program = Some(command.spawn().unwrap());
        window.wait_for_window()?;
        Ok(window)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn wait_for_window(&mut self) -> Result<(), Missing> {
        let begun = Instant::now();
        loop {
            let program = self.program.as_mut().unwrap();
            if let Some(status) = program.try_wait().unwrap() {
                let mut said = String::new();
                program
                    .stderr
                    .take()
                    .unwrap()
                    .read_to_string(&mut said)
                    .unwrap();
                if said.contains("no graphics device") {
                    return Err(Missing::Device(said));
                }
                if said.contains("no screen") {
                    return Err(Missing::Screen(said));
                }
                panic!("the program ended with {status}: {said}");
            }
            let found =
                self.xdotool(&["search", "--onlyvisible", "--name", "scene.star - Zeroset"]);
            if let Some(id) = found.lines().next().filter(|id| !id.is_empty()) {
                // there is no window manager: nothing else gives it the keyboard, and its place
                self.xdotool(&["windowmove", id, "0", "0"]);
                self.xdotool(&["windowfocus", id]);
                return Ok(());
            }
            assert!(begun.elapsed() < PATIENCE, "there is no window");
            std::thread::sleep(PAUSE);
        }
    }

    fn xdotool(&self, arguments: &[&str]) -> String {
        let mut command = Command::new("xdotool");
        let output = command
            .args(arguments)
            .env("DISPLAY", &self.display)
            .output();
        String::from_utf8_lossy(&output.unwrap().stdout).into_owned()
    }

    fn shot(&self) -> Option<Shot> {
        let mut command = Command::new("import");
        let output = command
            .args(["-window", "root", "-depth", "8", "png:-"])
            .env("DISPLAY", &self.display)
            .output()
            .unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(output.stdout));
        decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
        let mut reader = decoder.read_info().ok()?;
        let mut bytes = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut bytes).ok()?;
        assert_eq!((info.width as usize, info.height as usize), SCREEN);
        let channels = info.color_type.samples();
        let pixel = |p: &[u8]| {
            if channels < 3 {
                [p[0]; 3]
            } else {
                [p[0], p[1], p[2]]
            }
        };
        let rgb = bytes[..info.buffer_size()]
            .chunks_exact(channels)
            .map(pixel)
            .collect();
        Some(Shot { rgb })
    }

    /// Looks at the screen until it is as it should be.
    #[track_caller]
    fn until(&mut self, what: &str, is_so: impl Fn(&Shot) -> bool) -> Shot {
        self.until_after(what, |_| {}, is_so)
    }

    /// Does something, and looks at the screen until it is as it should be. A hand that was too fast for a machine under
    /// load does it again.
    #[track_caller]
    fn until_after(
        &mut self,
        what: &str,
        act: impl Fn(&Window),
        is_so: impl Fn(&Shot) -> bool,
    ) -> Shot {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            act(self);
            let acted = Instant::now();
            while acted.elapsed() < AGAIN {
                if let Some(shot) = self.shot()
                    && is_so(&shot)
                {
                    return shot;
                }
                if let Some(status) = self.program.as_mut().unwrap().try_wait().unwrap() {
                    panic!("the program ended with {status} before {what}");
                }
                std::thread::sleep(PAUSE);
            }
        }
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("window.png");
        let mut command = Command::new("import");
        let command = command.args(["-window", "root"]).arg(&path);
        let _ = command.env("DISPLAY", &self.display).status();
        panic!(
            "waited in vain for {what}; the screen is in {}",
            path.display()
        );
    }

    /// Presses the mouse at one place and lets it go at another.
    fn drag(&self, from: (i32, i32), to: (i32, i32)) {
        let goto = |x: i32, y: i32| {
            self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
            std::thread::sleep(HAND);
        };
        goto(from.0, from.1);
        self.xdotool(&["mousedown", "1"]);
        std::thread::sleep(HAND);
        for step in 1..=4 {
            let between = |a: i32, b: i32| a + (b - a) * step / 4;
            goto(between(from.0, to.0), between(from.1, to.1));
        }
        self.xdotool(&["mouseup", "1"]);
        std::thread::sleep(HAND);
    }

    fn save(&self, text: &str) {
        fs::write(self.path("scene.star"), text).unwrap();
    }
}

#[test]
fn a_scene_is_opened_turned_changed_broken_and_mended() {
    let mut window = match Window::open(SCENE) {
        Ok(window) => window,
        Err(Missing::Tool(reason) | Missing::Screen(reason) | Missing::Device(reason)) => {
            let needed = std::env::var("ZEROSET_REQUIRE_GPU").is_ok_and(|v| v == "1");
            assert!(!needed, "{reason}");
            eprintln!("not tested: {reason}");
            return;
        }
    };
    let shot = window.until("the scene", |s| s.red().0 > 2000 && s.green().0 > 4000);
    let ((small, left), (wide, _)) = (shot.red(), shot.green());
    assert!(
        left + 100.0 < shot.green().1,
        "the ball is not left of the box"
    );

    // half a turn: what was left is right
    let turn = |w: &Window| {
        w.xdotool(&["key", "Home"]);
        w.drag((300, 300), (300 + 740, 300));
    };
    window.until_after("the camera to turn", turn, |s| {
        s.red().0 > 1000 && s.green().0 > 1000 && s.red().1 > s.green().1 + 100.0
    });
    let back = |w: &Window| {
        w.xdotool(&["key", "Home"]);
    };
    window.until_after("the camera to come back", back, |s| {
        s.red().1 + 100.0 < s.green().1
    });

    let (low, high, y) = SLIDER;
    let grow = |w: &Window| w.drag((low + (high - low) / 4, y), (high, y));
    let shot = window.until_after("a larger ball", grow, |s| s.red().0 > 2 * small);
    assert!(shot.wrong() < 100);

    let yellow = SCENE.replace("#e00000", "#e0d000");
    window.save(&yellow);
    window.until("a yellow ball", |s| {
        s.yellow() > 2 * small && s.red().0 < small / 4
    });

    window.save(&yellow.replace("show(box(0.8)", "show(bocks(0.8)"));
    let shot = window.until("the mistake", |s| s.wrong() > 500);
    assert!(shot.yellow() > small, "the last good picture is gone");
    assert!(shot.green().0 > 1000, "the last good picture is gone");

    window.save(&SCENE.replace("show(box(0.8).move(x = 0.8)", "show(box(0.3).move(x = 0.8)"));
    window.until("the mended scene", |s| {
        s.wrong() < 100 && s.yellow() < 100 && s.red().0 > small && s.green().0 < wide / 3
    });
    assert!(
        window
            .program
            .as_mut()
            .unwrap()
            .try_wait()
            .unwrap()
            .is_none()
    );
}
