//! The window: the picture, the panels around it, and the keys.

use crate::engine::{Engine, Event};
use crate::launch::Open;
use crate::loader::{Loader, Written};
use crate::movie::{Animate, Movie, Progress};
use crate::panel;
use crate::panel::set_comparison;
use crate::rig::Side;
use crate::save::{self, Describe};
use crate::session::Session;
use crate::stage::{Stage, cards, flight};
use crate::style::{self, GAP, PANEL, Palette};
use crate::widget::{section, switch};
use eframe::egui::{
    Align2, Button, CentralPanel, Context, Frame, Id, Key, Margin, Modal, Modifiers, Panel,
    ProgressBar, RichText, ScrollArea, TextEdit, Theme, Ui, ViewportCommand,
};
use glam::DVec3;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};
use zeroset_output::display::{LINE, NAME, name};

/// Characters of a reason why something is not written.
const LINES: usize = 600;
use zeroset_scene::film::Plane;
use zeroset_scene::methods::Choice;

/// Stack of the thread that makes animations: a field is compiled as deep as it nests.
const STACK: usize = 64 << 20;

/// Endings of animations.
const FILMS: [&str; 5] = ["gif", "apng", "mp4", "webm", "y4m"];

/// Width and height that a picture may have, pixels.
const SIDES: std::ops::RangeInclusive<u32> = 1..=16_384;

/// How long a note is shown.
const NOTE: Duration = Duration::from_secs(5);

/// Where there is less room for the buttons at the top, they are in a menu, points.
const WIDE: f32 = 640.0;

/// The share of the window's width that the panel takes at most, and its width in any window, points.
const SHARE: f32 = 0.42;
const NARROWEST: f32 = 190.0;
const WIDEST: f32 = 520.0;

/// How often a picture in the making is asked how far it is.
const PROGRESS: Duration = Duration::from_millis(250);

/// The window.
pub struct App {
    /// What it is about.
    pub session: Session,
    engine: Option<Engine>,
    loader: Option<Loader>,
    stage: Stage,
    is_panel_open: bool,
    is_help_open: bool,
    /// What is asked about a picture that is to be saved.
    saving: Option<Saving>,
    /// What was done, and when it was said.
    note: Option<(String, Instant)>,
    /// What goes into a picture so that it can be made again.
    describe: Option<Describe>,
    /// What makes animations.
    animate: Option<Animate>,
    /// The animation that is being made.
    film: Option<Film>,
    /// What could not be written into the file, line by line.
    unwritten: Vec<String>,
}

/// An animation that is being made, on a thread of its own.
struct Film {
    movie: Movie,
    progress: Arc<Progress>,
    end: Receiver<Result<(), String>>,
}

/// A picture that is to be saved.
struct Saving {
    /// The name of the file.
    name: String,
    /// Its size in pixels, as it is written.
    size: String,
    /// Whether it is saved as soon as the picture is finished.
    is_waiting: bool,
}

/// Whether a name is that of an animation.
fn is_film(name: &str) -> bool {
    let ending = name.trim().rsplit_once('.').map(|(_, e)| e.to_lowercase());
    ending.is_some_and(|e| FILMS.contains(&e.as_str()))
}

impl Saving {
    /// The size that is meant, if it is one that a picture can have.
    fn pixels(&self) -> Option<[u32; 2]> {
        let (width, height) = self.size.trim().split_once(['x', 'X', '×'])?;
        let side = |text: &str| text.trim().parse().ok().filter(|n| SIDES.contains(n));
        Some([side(width)?, side(height)?])
    }
}

impl App {
    /// A window without threads behind it: what it shows is put into its session.
    pub fn new(ctx: &Context, session: Session) -> App {
        style::apply(ctx);
        App {
            session,
            engine: None,
            loader: None,
            stage: Stage::default(),
            is_panel_open: true,
            is_help_open: false,
            saving: None,
            note: None,
            describe: None,
            animate: None,
            film: None,
            unwritten: Vec::new(),
        }
    }

    /// A window with the threads that load and render.
    ///
    /// # Errors
    /// The system gives no threads.
    pub(crate) fn start(ctx: &Context, open: Open) -> std::io::Result<App> {
        let session = Session::new(open.scene.clone(), open.options.clone());
        let wake = || {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        let loader = Loader::start(open.scene, open.options, open.explain, open.assets, wake())?;
        let engine = Engine::start(open.renderer, wake())?;
        Ok(App {
            describe: Some(open.describe),
            animate: Some(open.animate),
            engine: Some(engine),
            loader: Some(loader),
            ..App::new(ctx, session)
        })
    }

    /// Takes what the threads have done, and asks for what is wanted next.
    fn exchange(&mut self, ctx: &Context) {
        if let Some(loader) = &self.loader {
            while let Some(outcome) = loader.take() {
                if let Err(report) = &outcome.result {
                    tracing::debug!("{report}");
                }
                self.session.absorb(outcome);
            }
            if let Some(options) = self.session.to_load() {
                loader.ask(options);
            }
        }
        let (mut has_news, mut said) = (false, None);
        if let Some(written) = self.loader.as_ref().and_then(Loader::take_written) {
            said = self.confirm(written);
        }
        if let Some(engine) = &self.engine {
            while let Some(event) = engine.take() {
                match event {
                    Event::Ready(name) => self.session.backend = Some(name),
                    Event::FellBack(reason) => {
                        said = Some(format!("The CPU renders now: {reason}"));
                    }
                    Event::Failed(reason) => self.session.trouble = Some(reason),
                    Event::Shown(shown) => {
                        let before = self.session.shown.as_ref();
                        if before.is_none_or(|b| !Arc::ptr_eq(&b.request, &shown.request)) {
                            self.session.pace.mark(Instant::now());
                        }
                        self.session.shown = Some(shown);
                        has_news = true;
                    }
                }
            }
            let is_busy = (self.session.shown.as_ref()).is_some_and(|shown| !shown.is_last);
            self.session.progress = is_busy.then(|| engine.progress());
            if is_busy {
                ctx.request_repaint_after(PROGRESS);
            }
            if !engine.is_alive() && self.session.trouble.is_none() {
                self.session.trouble =
                    Some("the renderer broke down; please report this scene as a bug".into());
            }
        }
        if let Some(said) = said {
            self.tell(said);
        }
        if has_news {
            self.stage.load(ctx, &self.session);
        }
    }

    /// Asks for what was changed to be put into the scene's file.
    fn write(&mut self) {
        if !self.session.is_unwritten() {
            self.tell("The file says all of this already.");
        } else if let Some(loader) = &self.loader {
            let changes = self.session.changes();
            loader.write(self.session.options.clone(), changes);
        }
    }

    /// What to say of values that were written; what was not is shown until it is closed.
    fn confirm(&mut self, written: Written) -> Option<String> {
        let revision = match written {
            Ok(revision) => revision,
            Err(reason) => {
                self.unwritten = vec![reason];
                return None;
            }
        };
        self.unwritten = revision.left.iter().map(ToString::to_string).collect();
        let file = self.session.path.file_name().unwrap_or_default();
        (!revision.written.is_empty()).then(|| {
            let what = revision.written.join(", ");
            format!("Written to {}: {what}", file.to_string_lossy())
        })
    }

    /// What could not be written, and why.
    fn say_unwritten(&mut self, ctx: &Context) {
        if self.unwritten.is_empty() {
            return;
        }
        let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(18));
        let modal = Modal::new(Id::unique("unwritten")).frame(frame);
        let modal = modal.show(ctx, |ui| {
            ui.set_max_width(460.0);
            ui.heading("Not written");
            ui.weak("These stay as they are in the window, and the file as it was:");
            for line in &self.unwritten {
                ui.label(name(line, LINES));
            }
            ui.add_space(6.0);
            ui.button("Close").clicked()
        });
        if modal.inner || modal.should_close() {
            self.unwritten.clear();
        }
    }

    /// Asks for the picture, if it is another one than before.
    fn ask(&mut self, ctx: &Context) {
        // a picture that is saved may have another size than the window
        let saved = self.saving.as_ref().filter(|saving| saving.is_waiting);
        let size = saved.and_then(Saving::pixels);
        let size = size.unwrap_or_else(|| self.stage.pixels(ctx));
        if let (Some(engine), true) = (&self.engine, self.stage.rect.is_some())
            && let Some(request) = self.session.to_render(size)
        {
            engine.ask(request);
        }
    }

    /// Draws the window.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.exchange(&ctx);
        self.keys(&ctx);
        self.fly(&ctx);
        let palette = Palette::of(ui.visuals());
        let bar = |margin: Margin| {
            Frame::new()
                .fill(ui.visuals().panel_fill)
                .inner_margin(margin)
        };
        let (wide, thin) = (bar(Margin::symmetric(14, 8)), bar(Margin::symmetric(14, 4)));
        let side = bar(Margin::symmetric(14, 10));
        Panel::top("top").frame(wide).show(ui, |ui| self.top(ui));
        Panel::bottom("status")
            .frame(thin)
            .show(ui, |ui| panel::status(ui, &self.session));
        if self.session.is_animated() {
            Panel::bottom("timeline")
                .frame(wide)
                .show(ui, |ui| panel::timeline(ui, &mut self.session));
        }
        if self.is_panel_open {
            // the picture keeps more than half of a small window
            let most = (SHARE * ui.available_width()).clamp(NARROWEST, WIDEST);
            Panel::right("panel")
                .frame(side)
                .default_size(PANEL.min(most))
                .size_range(PANEL.min(most)..=most)
                .show(ui, |ui| self.side(ui));
        }
        CentralPanel::default()
            .frame(Frame::new().fill(palette.surround))
            .show(ui, |ui| {
                self.stage.show(ui, &mut self.session);
            });
        if let Some(rect) = self.stage.rect {
            cards(ui, &mut self.session, rect);
        }
        panel::help(&ctx, &mut self.is_help_open);
        self.save_dialog(&ctx);
        self.film_dialog(&ctx);
        self.say_unwritten(&ctx);
        self.say(&ctx);
        self.ask(&ctx);
        if self.session.clock.is_playing {
            ctx.request_repaint();
        }
    }

    fn top(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label(RichText::new(self.session.name()).heading().strong());
            let file = self
                .session
                .path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy();
            ui.label(RichText::new(name(&file, NAME)).small().weak())
                .on_hover_text(name(&self.session.path.to_string_lossy(), LINE));
            if ui.available_width() < WIDE {
                ui.menu_button("Menu", |ui| self.buttons(ui))
                    .response
                    .on_hover_text("What the window can do.");
                ui.toggle_value(&mut self.is_panel_open, "Panel")
                    .on_hover_text("Shows or hides the panel (P).");
                return;
            }
            // at the right side, and yet from left to right, which is the order of the Tab key
            let id = Id::unique("width of the buttons");
            let width = ui.data(|d| d.get_temp(id)).unwrap_or(0.0);
            ui.add_space((ui.available_width() - width).max(0.0));
            let buttons = ui.horizontal(|ui| self.buttons(ui)).response.rect.width();
            if buttons != width {
                ui.data_mut(|d| d.insert_temp(id, buttons));
                ui.ctx().request_repaint();
            }
        });
    }

    fn buttons(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.x = GAP;
        let mut on = self.session.comparison.is_on;
        ui.toggle_value(&mut on, "Compare")
            .on_hover_text("Two settings beside each other (C).");
        set_comparison(&mut self.session, on);
        ui.toggle_value(&mut self.session.is_sliced, "Slice")
            .on_hover_text("A plane through the field (X).");
        ui.toggle_value(&mut self.session.converge, "Converge")
            .on_hover_text("Goes on until there is little noise (N).");
        let write = ui.add_enabled(self.session.is_unwritten(), Button::new("Write to file"));
        let about = "Puts what was changed here (parameters, camera, sun, sky, materials) into the scene's file; all else in it stays as it is (Ctrl+Shift+S).";
        if write.on_hover_text(about).clicked() {
            self.write();
        }
        let save = ui
            .button("Save…")
            .on_hover_text("Saves the picture (Ctrl+S).");
        if save.clicked() {
            let ctx = ui.ctx().clone();
            self.ask_for_name(&ctx);
        }
        let (word, theme) = if ui.visuals().dark_mode {
            ("Theme: dark", Theme::Light)
        } else {
            ("Theme: light", Theme::Dark)
        };
        let other = ui
            .button(word)
            .on_hover_text("Changes between a dark and a light window.");
        if other.accessible_name("Change the theme").clicked() {
            ui.ctx().set_theme(theme);
        }
        ui.toggle_value(&mut self.is_help_open, "Help")
            .on_hover_text("Keys and mouse (? or F1).");
        ui.toggle_value(&mut self.is_panel_open, "Panel")
            .on_hover_text("Shows or hides the panel (P).");
    }

    fn side(&mut self, ui: &mut Ui) {
        let size = self.stage.pixels(ui.ctx());
        let session = &mut self.session;
        // what is wider all the same is scrolled to, and does not make the panel wider
        let width = ui.available_width() - GAP;
        ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            ui.set_max_width(width);
            ui.set_min_width(width);
            if session.comparison.is_on {
                section(ui, "A and B", true, |ui| panel::comparison(ui, session));
            }
            if session.is_sliced {
                section(ui, "Plane through the field", true, |ui| {
                    panel::slice(ui, session)
                });
            }
            if session.current.is_some() {
                let has_parameters = !session.parameters().is_empty();
                section(ui, "Parameters", has_parameters, |ui| {
                    panel::parameters(ui, session)
                });
            }
            section(ui, "Camera", true, |ui| panel::camera(ui, session, size));
            section(ui, "Sun", true, |ui| panel::sun(ui, session));
            section(ui, "Sky", false, |ui| panel::sky(ui, session));
            section(ui, "Material", true, |ui| panel::material(ui, session));
            section(ui, "Objects", false, |ui| panel::objects(ui, session));
            section(ui, "View", true, |ui| {
                panel::view(ui, session);
                let about = "The ground as a grid, and the axes (G).";
                switch(ui, "Grid", about, &mut session.has_grid);
                panel::presets(ui, session);
            });
            section(ui, "Methods", false, |ui| panel::methods(ui, session));
            let said = session.current.as_ref().map(|c| {
                let warnings = c.loaded.warnings.iter().map(|w| format!("warning: {w}"));
                warnings.chain(c.loaded.log.iter().cloned()).collect()
            });
            let log: Vec<String> = said.unwrap_or_default();
            if !log.is_empty() {
                section(ui, "Printed by the scene", true, |ui| panel::log(ui, &log));
            }
        });
    }

    fn fly(&mut self, ctx: &Context) {
        let way = flight(ctx);
        if way != DVec3::ZERO {
            let seconds = f64::from(ctx.input(|i| i.stable_dt)).min(0.1);
            self.session.rig.fly(way, seconds);
            self.session.is_free = true;
            ctx.request_repaint();
        }
        if self.session.is_animated() {
            // the first frame after a rest would be a long one
            let seconds = f64::from(ctx.input(|i| i.unstable_dt)).min(0.25);
            self.session.clock.advance(seconds);
        } else {
            self.session.clock.is_playing = false;
        }
    }

    /// Keys that mean something wherever the focus is, except where text is written.
    fn keys(&mut self, ctx: &Context) {
        let pressed = |modifiers, key| ctx.input_mut(|i| i.consume_key(modifiers, key));
        let none = Modifiers::NONE;
        if pressed(none, Key::F1) {
            self.is_help_open = !self.is_help_open;
        }
        if pressed(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::C) {
            ctx.copy_text(self.session.rig.statement());
            self.tell("The camera is on the clipboard.");
        }
        if pressed(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S) {
            self.write();
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            self.ask_for_name(ctx);
        }
        if pressed(none, Key::F11) {
            let is_full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
            ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
        }
        if self.saving.is_some() || ctx.text_edit_focused() {
            return;
        }
        if pressed(none, Key::Escape) {
            self.is_help_open = false;
            self.session.picked = None;
        }
        if pressed(Modifiers::SHIFT, Key::Questionmark) || pressed(none, Key::Questionmark) {
            self.is_help_open = !self.is_help_open;
        }
        for (key, near, far) in [
            (Key::Num1, Side::Front, Side::Back),
            (Key::Num3, Side::Right, Side::Left),
            (Key::Num7, Side::Top, Side::Bottom),
        ] {
            for (modifiers, side) in [(Modifiers::COMMAND, far), (none, near)] {
                if pressed(modifiers, key) {
                    self.session.rig.look_from(side);
                    self.session.is_free = true;
                }
            }
        }
        let session = &mut self.session;
        if pressed(none, Key::F) {
            session.frame_all(self.stage.pixels(ctx));
        }
        if pressed(none, Key::Home) {
            session.reset_camera();
        }
        if pressed(none, Key::C) {
            let on = !session.comparison.is_on;
            set_comparison(session, on);
        }
        if pressed(none, Key::X) {
            session.is_sliced = !session.is_sliced;
        }
        if pressed(none, Key::L) {
            session.is_sun_held = !session.is_sun_held;
        }
        if pressed(none, Key::G) {
            session.has_grid = !session.has_grid;
        }
        if pressed(none, Key::N) {
            session.converge = !session.converge;
        }
        if pressed(none, Key::V) {
            let plane = &mut session.edited().plane;
            *plane = Plane::ALL[(plane.place() + 1) % Plane::ALL.len()];
        }
        if pressed(none, Key::P) {
            self.is_panel_open = !self.is_panel_open;
        }
        if session.is_animated() {
            if ctx.memory(|m| m.focused().is_none()) && pressed(none, Key::Space) {
                session.clock.toggle();
            }
            for (key, frames) in [(Key::Comma, -1), (Key::Period, 1)] {
                if pressed(none, key) {
                    session.clock.step(frames);
                }
            }
        }
    }

    /// The size of the picture on the screen, in words.
    fn written_size(&self, ctx: &Context) -> String {
        let [width, height] = self.stage.pixels(ctx);
        format!("{width}x{height}")
    }

    /// Asks what the picture is to be called. The time stands still meanwhile.
    fn ask_for_name(&mut self, ctx: &Context) {
        self.session.clock.is_playing = false;
        self.saving = Some(Saving {
            name: save::default_name(&self.session),
            size: self.written_size(ctx),
            is_waiting: false,
        });
    }

    fn save_dialog(&mut self, ctx: &Context) {
        let Some(saving) = &mut self.saving else {
            return;
        };
        let on_screen = self.stage.pixels(ctx);
        let is_here = saving.pixels() == Some(on_screen);
        let fits = saving.pixels().is_some_and(|[width, height]| {
            u64::from(width) * u64::from(height) <= self.session.options.limits.pixels
        });
        let size = self.session.shown.as_ref().map(|s| s.request.size);
        let is_finished = self.session.is_finished() && (is_here || size == saving.pixels());
        let is_animated = self.session.is_animated() && self.animate.is_some();
        let is_film = is_animated && is_film(&saving.name);
        let is_finished = is_finished || is_film;
        let (mut is_done, mut is_left) = (false, false);
        let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(18));
        let modal = Modal::new(Id::unique("save")).frame(frame).show(ctx, |ui| {
            ui.set_width(420.0);
            ui.heading("Save the picture");
            ui.weak("The ending says how: .png, or .exr with all planes of the film.");
            if is_animated {
                ui.weak("All of the time line: .gif, .apng, or through ffmpeg .mp4 and .webm.");
            }
            ui.add_space(6.0);
            let edit = TextEdit::singleline(&mut saving.name).desired_width(f32::INFINITY);
            let edit = ui.add(edit).accessible_name("File name");
            let entered = edit.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
            ui.add_space(2.0);
            ui.horizontal(|ui| {
                ui.label("Size");
                let edit = TextEdit::singleline(&mut saving.size).desired_width(110.0);
                ui.add_enabled(!saving.is_waiting, edit)
                    .accessible_name("Size of the picture");
                if fits {
                    ui.weak("pixels");
                } else {
                    ui.colored_label(
                        ui.visuals().error_fg_color,
                        "as in 1920x1080, no larger than the limit `pixels`",
                    );
                }
            });
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let word = if is_finished {
                    "Save"
                } else {
                    "Save when finished"
                };
                let save = ui.add_enabled(fits && !saving.is_waiting, Button::new(word));
                saving.is_waiting |= fits && (save.clicked() || entered);
                if !is_finished && is_here {
                    is_done = ui.button("Save as it is").clicked();
                }
                is_left = ui.button("Cancel").clicked();
            });
            if saving.is_waiting && !is_finished {
                ui.weak("The picture is still being refined.");
            }
        });
        if let (true, Some(size)) = (saving.is_waiting && is_film, saving.pixels()) {
            let path = saving.name.trim().into();
            self.saving = None;
            self.shoot(ctx, Movie::of(&self.session, path, size));
        } else if is_done || (saving.is_waiting && is_finished) {
            let said = match save::save(&self.session, &saving.name, self.describe) {
                Ok(path) => format!("Saved {}", path.display()),
                Err(reason) => format!("Not saved: {reason}"),
            };
            self.saving = None;
            self.tell(said);
        } else if is_left || modal.should_close() {
            self.saving = None;
        }
    }

    /// Makes an animation, beside the window.
    fn shoot(&mut self, ctx: &Context, movie: Movie) {
        let Some(animate) = self.animate else {
            return;
        };
        let progress = Arc::new(Progress::default());
        let (tell, end) = channel();
        let (theirs, asked, ctx) = (Arc::clone(&progress), movie.clone(), ctx.clone());
        let work = move || {
            // a window that is gone needs no news
            let _ = tell.send(animate(&asked, &theirs));
            ctx.request_repaint();
        };
        let thread = std::thread::Builder::new()
            .name("film".into())
            .stack_size(STACK)
            .spawn(work);
        match thread {
            Ok(_) => {
                self.film = Some(Film {
                    movie,
                    progress,
                    end,
                });
            }
            Err(error) => self.tell(format!("No animation: {error}")),
        }
    }

    /// Shows how far the animation is, and ends it where that is wanted.
    fn film_dialog(&mut self, ctx: &Context) {
        let Some(film) = &self.film else {
            return;
        };
        let end = match film.end.try_recv() {
            Ok(end) => Some(end),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(
                "the renderer broke down; please report this scene as a bug".to_owned(),
            )),
        };
        if let Some(end) = end {
            let path = film.movie.path.display();
            let said = match end {
                Ok(()) => format!("Saved {path}"),
                Err(_) if film.progress.is_cancelled() => "No animation: it was ended".to_owned(),
                Err(reason) => format!("No animation: {reason}"),
            };
            self.film = None;
            self.tell(said);
            return;
        }
        let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(18));
        Modal::new(Id::unique("film")).frame(frame).show(ctx, |ui| {
            ui.set_width(360.0);
            ui.heading("The animation is made");
            let (done, all) = (film.progress.frames().saturating_sub(1), film.movie.frames);
            let share = done as f32 / all.max(1) as f32;
            ui.add(ProgressBar::new(share).text(format!("{done} of {all} frames")));
            let word = if film.progress.is_cancelled() {
                "Ending"
            } else {
                "Cancel"
            };
            if ui.button(word).clicked() {
                film.progress.cancel();
            }
        });
        ctx.request_repaint_after(PROGRESS);
    }

    fn tell(&mut self, text: impl Into<String>) {
        self.note = Some((name(&text.into(), LINE), Instant::now()));
    }

    /// Shows a note for a while.
    fn say(&mut self, ctx: &Context) {
        let Some((text, since)) = &self.note else {
            return;
        };
        let left = NOTE.saturating_sub(since.elapsed());
        if left.is_zero() {
            self.note = None;
            return;
        }
        eframe::egui::Area::new(Id::unique("note"))
            .anchor(Align2::CENTER_BOTTOM, [0.0, -60.0])
            .interactable(false)
            .show(ctx, |ui| {
                let palette = Palette::of(ui.visuals());
                panel::card(&palette).show(ui, |ui| ui.label(text));
            });
        ctx.request_repaint_after(left);
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
}
