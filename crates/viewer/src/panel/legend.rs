//! What the colours of a view mean.

use super::picked::card;
use crate::style::Palette;
use eframe::egui::{Align2, Color32, Pos2, Rect, Sense, TextStyle, Ui, Vec2, WidgetInfo, vec2};
use zeroset_output::view::LegendKey;

/// Size of the bar of colours.
const BAR: Vec2 = vec2(14.0, 180.0);

/// A bar of colours with numbers beside it.
pub fn legend(ui: &mut Ui, key: &LegendKey) {
    let palette = Palette::of(ui.visuals());
    card(&palette).show(ui, |ui| {
        let (ink, line) = (ui.visuals().text_color(), 16.0);
        let below = if key.nothing.is_some() {
            line + 8.0
        } else {
            0.0
        };
        let size = vec2(BAR.x + 62.0, line + 10.0 + BAR.y + below + 4.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        let said = format!("Legend: {}", key.title);
        response.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Label, true, &said));
        let painter = ui.painter();
        let font = TextStyle::Small.resolve(ui.style());
        let write = |at: Pos2, text: &str| {
            painter.text(at, Align2::LEFT_CENTER, text, font.clone(), ink);
        };
        write(rect.left_top() + vec2(0.0, 0.5 * line), key.title);
        let bar = Rect::from_min_size(rect.left_top() + vec2(0.0, line + 6.0), BAR);
        let count = 60;
        for i in 0..count {
            let (low, high) = (i as f32 / count as f32, (i + 1) as f32 / count as f32);
            let y = |share: f32| bar.bottom() - share * bar.height();
            let piece = Rect::from_min_max(
                Pos2::new(bar.left(), y(high)),
                Pos2::new(bar.right(), y(low)),
            );
            painter.rect_filled(piece, 0.0, shade((key.colours)(0.5 * (low + high))));
        }
        for (place, text) in &key.ticks {
            let y = bar.bottom() - place * bar.height();
            let stroke = eframe::egui::Stroke::new(1.0, ink);
            painter.hline(bar.right()..=bar.right() + 4.0, y, stroke);
            write(Pos2::new(bar.right() + 9.0, y), text);
        }
        if let Some(word) = key.nothing {
            let corner = bar.left_bottom() + vec2(0.0, 10.0);
            let square = Rect::from_min_size(corner, vec2(BAR.x, BAR.x));
            painter.rect_filled(square, 0.0, shade(zeroset_output::view::NOTHING));
            write(square.right_center() + vec2(9.0, 0.0), word);
        }
    });
}

fn shade(rgb: [f32; 3]) -> Color32 {
    let [r, g, b] = rgb.map(|c| (c * 255.0).round() as u8);
    Color32::from_rgb(r, g, b)
}
