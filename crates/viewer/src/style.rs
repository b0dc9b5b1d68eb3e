//! How the window looks: calm, so that the picture is what one sees.

use eframe::egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Margin, Stroke, Style, TextStyle, Theme,
    Vec2, Visuals, epaint,
};

/// Between the rooms of the window.
pub(crate) const GAP: f32 = 8.0;
/// Width of the panel at the right side.
pub(crate) const PANEL: f32 = 324.0;

/// Colours that egui's own style has no place for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Palette {
    /// What can be acted on, and what is chosen.
    pub(crate) accent: Color32,
    /// Behind a card that lies on the picture.
    pub(crate) card: Color32,
    /// Around it.
    pub(crate) edge: Color32,
    /// What is wrong.
    pub(crate) wrong: Color32,
    /// Around the picture.
    pub(crate) surround: Color32,
}

impl Palette {
    /// The colours of a theme.
    pub(crate) fn of(visuals: &Visuals) -> Palette {
        if visuals.dark_mode {
            Palette {
                accent: Color32::from_rgb(122, 162, 247),
                card: Color32::from_rgba_unmultiplied(24, 25, 29, 240),
                edge: Color32::from_rgb(58, 61, 69),
                wrong: Color32::from_rgb(240, 120, 110),
                surround: Color32::from_rgb(17, 18, 20),
            }
        } else {
            Palette {
                accent: Color32::from_rgb(46, 98, 200),
                card: Color32::from_rgba_unmultiplied(252, 252, 253, 245),
                edge: Color32::from_rgb(206, 209, 216),
                wrong: Color32::from_rgb(184, 44, 36),
                surround: Color32::from_rgb(226, 228, 232),
            }
        }
    }
}

/// Makes both themes.
pub(crate) fn apply(ctx: &Context) {
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| dress(style, theme == Theme::Dark));
    }
}

fn dress(style: &mut Style, dark: bool) {
    let mut visuals = if dark {
        Visuals::dark()
    } else {
        Visuals::light()
    };
    let palette = Palette::of(&visuals);
    let grey = |level: u8| {
        if dark {
            Color32::from_rgb(level, level.saturating_add(1), level.saturating_add(4))
        } else {
            let level = 255 - level;
            Color32::from_rgb(level.saturating_sub(3), level.saturating_sub(1), level)
        }
    };
    let (panel, quiet, hover, press) = if dark {
        (30, 44, 56, 66)
    } else {
        (8, 24, 34, 44)
    };
    let text = if dark {
        Color32::from_gray(214)
    } else {
        Color32::from_gray(38)
    };
    let strong = if dark {
        Color32::from_gray(244)
    } else {
        Color32::from_gray(12)
    };
    visuals.panel_fill = grey(panel);
    visuals.window_fill = grey(panel);
    visuals.window_stroke = Stroke::new(1.0, palette.edge);
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.menu_corner_radius = CornerRadius::same(8);
    visuals.window_shadow = epaint::Shadow {
        offset: [0, 6],
        blur: 24,
        spread: 0,
        color: Color32::from_black_alpha(if dark { 110 } else { 50 }),
    };
    visuals.popup_shadow = visuals.window_shadow;
    visuals.extreme_bg_color = if dark {
        Color32::from_rgb(20, 21, 24)
    } else {
        Color32::WHITE
    };
    visuals.hyperlink_color = palette.accent;
    visuals.error_fg_color = palette.wrong;
    visuals.selection.bg_fill = palette
        .accent
        .gamma_multiply(if dark { 0.42 } else { 0.28 });
    visuals.selection.stroke = Stroke::new(1.0, strong);
    visuals.slider_trailing_fill = true;
    visuals.indent_has_left_vline = false;
    visuals.weak_text_color = Some(if dark {
        Color32::from_gray(152)
    } else {
        Color32::from_gray(96)
    });
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, text);
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, grey(quiet));
    for (widget, fill, ink) in [
        (&mut widgets.inactive, quiet, text),
        (&mut widgets.hovered, hover, strong),
        (&mut widgets.active, press, strong),
        (&mut widgets.open, hover, strong),
    ] {
        widget.bg_fill = grey(fill);
        widget.weak_bg_fill = grey(fill);
        widget.bg_stroke = Stroke::NONE;
        widget.fg_stroke = Stroke::new(1.0, ink);
        widget.expansion = 0.0;
    }
    widgets.hovered.bg_stroke = Stroke::new(1.0, grey(press));
    widgets.active.bg_stroke = Stroke::new(1.0, palette.accent);
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(6);
    }
    style.visuals = visuals;
    let spacing = &mut style.spacing;
    spacing.item_spacing = Vec2::new(8.0, 7.0);
    spacing.button_padding = Vec2::new(9.0, 4.0);
    spacing.interact_size = Vec2::new(34.0, 24.0);
    spacing.slider_rail_height = 4.0;
    spacing.window_margin = Margin::same(14);
    spacing.menu_margin = Margin::same(8);
    spacing.combo_height = 420.0;
    spacing.indent = 14.0;
    spacing.tooltip_width = 320.0;
    for (name, size, family) in [
        (TextStyle::Small, 11.5, FontFamily::Proportional),
        (TextStyle::Body, 13.5, FontFamily::Proportional),
        (TextStyle::Button, 13.5, FontFamily::Proportional),
        (TextStyle::Heading, 16.0, FontFamily::Proportional),
        (TextStyle::Monospace, 12.5, FontFamily::Monospace),
    ] {
        style.text_styles.insert(name, FontId::new(size, family));
    }
}
