//! Opening the window.

use crate::app::App;
use crate::engine::MakeRenderer;
use crate::loader::Explain;
use crate::movie::Animate;
use crate::save::Describe;
use eframe::egui::{ViewportBuilder, vec2};
use std::path::PathBuf;
use zeroset_language::assets::Assets;
use zeroset_language::load::Options;
use zeroset_output::display::{NAME, name};

/// What the window opens with.
pub struct Open {
    /// The scene file.
    pub scene: PathBuf,
    /// Parameters, time and limits.
    pub options: Options,
    /// What renders.
    pub renderer: MakeRenderer,
    /// What a person is told of a scene that cannot be loaded.
    pub explain: Explain,
    /// What goes into a picture so that it can be made again.
    pub describe: Describe,
    /// What makes animations.
    pub animate: Animate,
    /// What scenes take from files, and where what took long is kept.
    pub assets: Assets,
}

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// No screen.
    #[error("there is no screen to open a window on: {0}")]
    Screen(String),
    /// No way to draw on the screen.
    #[error("no graphics device can draw the window: {0}")]
    Device(String),
    /// Anything else.
    #[error("the window cannot be opened: {0}")]
    Other(String),
}

impl OpenError {
    /// What the user can do about it.
    pub fn advice(&self) -> &'static str {
        match self {
            OpenError::Screen(_) => {
                "open it from a desktop session, or make a picture without a window: zeroset render SCENE"
            }
            OpenError::Device(_) => {
                "install a Vulkan driver; one that needs no GPU is lavapipe (Debian and Ubuntu: apt install \
                 mesa-vulkan-drivers libvulkan1, Fedora: dnf install mesa-vulkan-drivers vulkan-loader). A picture \
                 needs no window: zeroset render SCENE"
            }
            OpenError::Other(_) => "a picture needs no window: zeroset render SCENE",
        }
    }
}

/// Opens the window, and returns when it is closed.
///
/// # Errors
/// No screen, no device.
pub fn open(open: Open) -> Result<(), OpenError> {
    let title = (open.scene.file_name()).map_or_else(
        || "Zeroset".to_owned(),
        |n| format!("{} - Zeroset", name(&n.to_string_lossy(), NAME)),
    );
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_app_id("zeroset")
            .with_title(title)
            .with_inner_size(vec2(1280.0, 800.0))
            .with_min_inner_size(vec2(480.0, 320.0)),
        ..eframe::NativeOptions::default()
    };
    let make = Box::new(|context: &eframe::CreationContext<'_>| {
        let app = App::start(&context.egui_ctx, open)?;
        Ok(Box::new(app) as Box<dyn eframe::App>)
    });
    eframe::run_native("zeroset", options, make).map_err(|error| match error {
        eframe::Error::Winit(error) => OpenError::Screen(plain(&error.to_string())),
        eframe::Error::WinitEventLoop(error) => OpenError::Screen(plain(&error.to_string())),
        eframe::Error::Wgpu(error) => OpenError::Device(error.to_string()),
        other => OpenError::Other(other.to_string()),
    })
}

/// What the system said, without the line of winit that passes it on.
fn plain(said: &str) -> String {
    let rest = said
        .strip_prefix("os error at ")
        .and_then(|s| s.split_once(": "));
    rest.map_or(said, |(_, rest)| rest).to_owned()
}

#[cfg(test)]
mod tests {
    #[test]
    fn messages_name_no_source_file() {
        let said = "os error at /somewhere/mod.rs:765: neither DISPLAY nor: this";
        assert_eq!(super::plain(said), "neither DISPLAY nor: this");
        assert_eq!(super::plain("no: this"), "no: this");
    }
}
