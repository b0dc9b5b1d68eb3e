//! Keys and mouse.

use eframe::egui::{Context, Grid, RichText, ScrollArea, Window};

/// What keys and the mouse do: by what is pressed, what happens. An empty text begins a group.
pub const KEYS: &[(&str, &str)] = &[
    ("Camera", ""),
    ("Left drag", "orbit"),
    ("Right or middle drag, Shift + drag", "pan"),
    ("Wheel, pinch", "zoom to the cursor"),
    ("Double click", "orbit the point under the cursor"),
    ("W A S D, Q E", "fly; with Shift faster"),
    ("Alt + drag, or drag while flying", "look around"),
    ("F", "frame everything"),
    (
        "1, 3, 7",
        "from the front, the right, the top; with Ctrl the other side",
    ),
    ("Home", "where the file has the camera"),
    ("L", "drags move the sun instead"),
    ("Picture", ""),
    (
        "Click",
        "what is there: object, material, point, line in the file",
    ),
    ("C", "compare two settings; the divider can be dragged"),
    ("X", "a plane through the field"),
    ("N", "converge: go on until there is little noise"),
    ("V", "the next view: picture, steps, occlusion, ..."),
    ("G", "the ground as a grid"),
    ("Space", "play or pause"),
    (", and .", "a frame back or on"),
    ("Window", ""),
    ("Ctrl + S", "save the picture"),
    (
        "Ctrl + Shift + S",
        "write parameters, camera, sun, sky, materials to the file",
    ),
    ("F11", "fullscreen"),
    ("Ctrl + Shift + C", "copy the camera as scene text"),
    ("Tab", "the next control"),
    ("P", "hide or show the panel"),
    ("? or F1", "this list"),
    ("Esc", "close what is open"),
];

/// A window with the keys.
pub fn help(ctx: &Context, is_open: &mut bool) {
    Window::new("Keys and mouse")
        .open(is_open)
        .collapsible(false)
        .resizable(false)
        .vscroll(false)
        .anchor(eframe::egui::Align2::CENTER_CENTER, [0.0, 0.0])
        .show(ctx, |ui| {
            ScrollArea::vertical()
                .max_height(620.0)
                .min_scrolled_height(560.0)
                .show(ui, |ui| {
                    Grid::new("keys")
                        .num_columns(2)
                        .spacing([28.0, 6.0])
                        .show(ui, |ui| {
                            for (key, what) in KEYS {
                                if what.is_empty() {
                                    ui.label(RichText::new(*key).small().weak());
                                } else {
                                    ui.label(RichText::new(*key).strong());
                                    ui.label(*what);
                                }
                                ui.end_row();
                            }
                        });
                });
        });
}
