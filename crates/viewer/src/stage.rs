//! The picture, and what hands do on it.

use crate::overlay;
use crate::panel::{self, SunPlace};
use crate::pick::{depth, pick};
use crate::session::Session;
use crate::style::Palette;
use eframe::egui::{
    Align2, Color32, Context, CursorIcon, EventFilter, FontId, Id, Key, Modifiers, PointerButton,
    Pos2, Rect, Response, Role, Sense, Stroke, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo,
    pos2, vec2,
};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;
use zeroset_scene::light::Source;

/// How much nearer a notch of the wheel brings, by its points.
const ZOOM: f64 = 0.0022;
/// How far looking around turns, for what orbiting would turn by the same way.
const LOOK: f64 = 0.5;
/// Half the width of what can be grabbed of the divider, points.
const GRIP: f32 = 7.0;
/// Share of the width that an arrow key moves the divider by.
const NUDGE: f32 = 0.02;

/// The textures of what is shown.
#[derive(Default)]
pub(crate) struct Stage {
    textures: [Option<TextureHandle>; 2],
    /// What drags the picture, and where it was last.
    held: Option<(PointerButton, Pos2)>,
    /// Where the picture is, points.
    pub(crate) rect: Option<Rect>,
}

impl Stage {
    /// Takes the pixels of a new picture.
    pub(crate) fn load(&mut self, ctx: &Context, session: &Session) {
        let Some(shown) = &session.shown else {
            return;
        };
        for (i, texture) in self.textures.iter_mut().enumerate() {
            let Some(side) = shown.sides.get(i) else {
                *texture = None;
                continue;
            };
            let image = Arc::clone(&side.image);
            match texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => {
                    let name = ["picture A", "picture B"][i];
                    *texture = Some(ctx.load_texture(name, image, TextureOptions::LINEAR));
                }
            }
        }
    }

    /// Pixels of the picture on this screen.
    pub(crate) fn pixels(&self, ctx: &Context) -> [u32; 2] {
        let size = self.rect.map_or(Vec2::splat(1.0), |r| r.size()) * ctx.pixels_per_point();
        let side = ctx.input(|i| i.max_texture_side) as f32;
        [size.x, size.y].map(|n| n.round().clamp(1.0, side.min(16_384.0)) as u32)
    }

    /// Shows the picture in all the room there is, and moves the camera.
    pub(crate) fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let rect = snapped(ui.max_rect(), ui.pixels_per_point());
        self.rect = Some(rect);
        let response = ui.interact(rect, Id::unique("picture"), Sense::click_and_drag());
        let said = format!("Picture of {}", session.name());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
        let palette = Palette::of(ui.visuals());
        ui.painter().rect_filled(rect, 0.0, palette.surround);
        self.paint(ui, session, rect);
        let size = self.pixels(ui.ctx());
        overlay::grid(ui, session, rect, size);
        let divided = session.comparison.is_on && divider(ui, session, rect);
        if !divided {
            self.hand(ui, session, &response, rect);
        }
        overlay::gizmo(ui, session, rect);
        if session.shown.is_none() && session.trouble.is_none() {
            let middle = rect.center();
            let ink = ui.visuals().weak_text_color();
            let font = FontId::proportional(14.0);
            ui.painter()
                .text(middle, Align2::CENTER_CENTER, "Loading", font, ink);
        }
    }

    fn paint(&self, ui: &Ui, session: &Session, rect: Rect) {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let show = |texture: &TextureHandle, from: f32, to: f32| {
            let x = |share| rect.left() + share * rect.width();
            let part = Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(to), rect.bottom()));
            let uv = Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
            ui.painter()
                .image(texture.id(), part, uv.intersect(whole), Color32::WHITE);
        };
        match (&self.textures, session.comparison.is_on) {
            ([Some(a), Some(b)], true) => {
                let divider = session.comparison.divider;
                show(a, 0.0, divider);
                show(b, divider, 1.0);
            }
            ([Some(a), _], _) => show(a, 0.0, 1.0),
            _ => {}
        }
    }

    /// Drags, wheel and clicks.
    fn hand(&mut self, ui: &Ui, session: &mut Session, response: &Response, rect: Rect) {
        let height = f64::from(rect.height().max(1.0));
        if let Some((button, way)) = self.travel(ui, response) {
            let modifiers = ui.input(|i| i.modifiers);
            let [right, down] = [way.x, way.y].map(f64::from);
            let [yaw, pitch] = [right, down].map(|x| x * PI / height);
            if session.is_sun_held && button == PointerButton::Primary && session.sun().is_some() {
                drag_sun(session, yaw, pitch);
                return;
            }
            if button != PointerButton::Primary || modifiers.shift {
                session.rig.pan(right, down, height);
            } else if modifiers.alt || flight(ui.ctx()) != DVec3::ZERO {
                session.rig.look(LOOK * yaw, LOOK * pitch);
            } else {
                session.rig.orbit(yaw, pitch);
            }
            session.is_free = true;
        }
        if response.dragged() {
            ui.set_cursor_icon(CursorIcon::Grabbing);
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
            let factor = (-f64::from(scroll) * ZOOM).exp() / f64::from(pinch);
            if factor != 1.0 {
                let target = self.under(session, ui.ctx(), rect, at);
                session.rig.zoom(factor, target);
                session.is_free = true;
            }
        }
        if let (Some(at), true) = (response.interact_pointer_pos(), response.clicked()) {
            self.click(session, rect, at);
            if response.double_clicked() {
                session.rig.centre(self.under(session, ui.ctx(), rect, at));
                session.is_free = true;
            }
        }
    }

    /// How far the hand moved what it holds since the last frame. On a slow machine a press, moves and the release can come
    /// together in a frame: nothing of the way is lost.
    fn travel(&mut self, ui: &Ui, response: &Response) -> Option<(PointerButton, Vec2)> {
        let at = ui.input(|i| i.pointer.interact_pos())?;
        if response.dragged() {
            let buttons = [
                PointerButton::Primary,
                PointerButton::Secondary,
                PointerButton::Middle,
            ];
            let button = buttons.into_iter().find(|b| response.dragged_by(*b))?;
            let origin = || ui.input(|i| i.pointer.press_origin()).unwrap_or(at);
            let before = self.held.map_or_else(origin, |(_, before)| before);
            self.held = Some((button, at));
            (at != before).then_some((button, at - before))
        } else {
            let (button, before) = self.held.take()?;
            (response.drag_stopped() && at != before).then_some((button, at - before))
        }
    }

    /// The point of the scene under the cursor; where nothing is, as far away as the pivot.
    fn under(&self, session: &Session, ctx: &Context, rect: Rect, at: Pos2) -> DVec3 {
        let size = self.pixels(ctx);
        let share = share_of(rect, at);
        let camera = session.camera(size);
        let place = [share[0] * size[0] as f32, share[1] * size[1] as f32];
        let (origin, direction) = camera.ray(place[0], place[1], size);
        let seen = session
            .shown
            .as_ref()
            .and_then(|s| depth(&s.sides.first()?.film, share));
        let far = seen.unwrap_or(session.rig.distance() as f32);
        (origin + direction * far).as_dvec3()
    }

    fn click(&self, session: &mut Session, rect: Rect, at: Pos2) {
        let share = share_of(rect, at);
        let Some(shown) = &session.shown else {
            return;
        };
        let side = usize::from(session.comparison.is_on && share[0] > session.comparison.divider);
        session.picked = shown.sides.get(side).and_then(|exposed| {
            pick(
                &exposed.film,
                &shown.request.camera,
                &shown.request.scene,
                share,
            )
        });
    }
}

/// Moves the sun with the hand: around the vertical, and up and down as it is seen.
fn drag_sun(session: &mut Session, right: f64, down: f64) {
    let Some((_, sun)) = session.sun() else {
        return;
    };
    if let Source::Directional { direction } = sun.source {
        let place = SunPlace::of(direction);
        let [right, down] = [right, down].map(|x| x.to_degrees() as f32);
        let moved = SunPlace {
            azimuth: place.azimuth + right,
            elevation: (place.elevation - down).clamp(-89.9, 89.9),
        };
        session.turn_sun(moved.direction());
    }
}

/// A place as shares of the picture's width and height.
fn share_of(rect: Rect, at: Pos2) -> [f32; 2] {
    let from = at - rect.min;
    [from.x / rect.width(), from.y / rect.height()]
}

/// A rectangle whose corners lie between pixels: the picture is shown without being resampled.
fn snapped(rect: Rect, scale: f32) -> Rect {
    let snap = |p: Pos2| pos2((p.x * scale).round() / scale, (p.y * scale).round() / scale);
    Rect::from_min_max(snap(rect.min), snap(rect.max))
}

/// The line between A and B, which can be dragged, or moved with the arrow keys. Gives whether it is being dragged.
fn divider(ui: &mut Ui, session: &mut Session, rect: Rect) -> bool {
    let comparison = &mut session.comparison;
    let x = rect.left() + comparison.divider * rect.width();
    let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
    let id = Id::unique("divider");
    let response = ui.interact(grip, id, Sense::click_and_drag());
    if response.has_focus() {
        let filter = EventFilter {
            horizontal_arrows: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|m| m.set_focus_lock_filter(id, filter));
        let press = |key| ui.input_mut(|i| i.count_and_consume_key(Modifiers::NONE, key)) as f32;
        comparison.divider += NUDGE * (press(Key::ArrowRight) - press(Key::ArrowLeft));
    }
    if response.dragged()
        && let Some(at) = response.interact_pointer_pos()
    {
        comparison.divider = share_of(rect, at)[0];
    }
    comparison.divider = comparison.divider.clamp(0.0, 1.0);
    let share = comparison.divider;
    response.widget_info(|| WidgetInfo::slider(true, f64::from(share), "Divider between A and B"));
    let response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    let x = rect.left() + share * rect.width();
    let palette = Palette::of(ui.visuals());
    let is_held = response.hovered() || response.dragged() || response.has_focus();
    let ink = if is_held {
        palette.accent
    } else {
        Color32::WHITE
    };
    let painter = ui.painter();
    let shadow = Stroke::new(4.0, Color32::from_black_alpha(70));
    painter.vline(x, rect.y_range(), shadow);
    painter.vline(x, rect.y_range(), Stroke::new(2.0, ink));
    painter.circle(pos2(x, rect.center().y), 8.0, ink, shadow);
    for (side, name) in [(-1.0, "A"), (1.0, "B")] {
        let align = if side < 0.0 {
            Align2::RIGHT_BOTTOM
        } else {
            Align2::LEFT_BOTTOM
        };
        let at = pos2(x + side * 14.0, rect.bottom() - 12.0);
        let font = FontId::proportional(15.0);
        painter.text(
            at + vec2(1.0, 1.0),
            align,
            name,
            font.clone(),
            Color32::from_black_alpha(160),
        );
        painter.text(at, align, name, font, Color32::WHITE);
    }
    response.dragged()
}

/// Where the keys that are held fly to: along right, up and backwards.
pub(crate) fn flight(ctx: &Context) -> DVec3 {
    if ctx.text_edit_focused() {
        return DVec3::ZERO;
    }
    ctx.input(|i| {
        if i.modifiers.command || i.modifiers.alt {
            return DVec3::ZERO;
        }
        let along = |more, less| f64::from(i8::from(i.key_down(more)) - i8::from(i.key_down(less)));
        let way = DVec3::new(
            along(Key::D, Key::A),
            along(Key::E, Key::Q),
            along(Key::S, Key::W),
        );
        way.normalize_or_zero() * if i.modifiers.shift { 3.0 } else { 1.0 }
    })
}

/// The cards that lie on the picture.
pub(crate) fn cards(ui: &mut Ui, session: &mut Session, rect: Rect) {
    use eframe::egui::{Area, Order};
    let place = |name: &str, align: Align2, corner: Pos2| {
        Area::new(Id::unique(name))
            .order(Order::Middle)
            .pivot(align)
            .fixed_pos(corner)
            .constrain_to(rect)
    };
    let inner = rect.shrink(14.0);
    if session.trouble.is_some() {
        let area = place("error card", Align2::LEFT_TOP, inner.left_top());
        area.show(ui.ctx(), |ui| {
            ui.set_max_width(inner.width().min(860.0));
            panel::error(ui, session);
        });
    }
    if session.picked.is_some() {
        let area = place("picked card", Align2::LEFT_BOTTOM, inner.left_bottom());
        area.show(ui.ctx(), |ui| panel::picked(ui, session));
    }
    if let Some(key) = session.key().cloned() {
        let area = place("legend card", Align2::RIGHT_BOTTOM, inner.right_bottom());
        area.interactable(false)
            .show(ui.ctx(), |ui| panel::legend(ui, &key));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_lie_on_pixels() {
        for scale in [1.0, 1.25, 1.5, 2.0, 2.625] {
            let rect = snapped(
                Rect::from_min_max(pos2(0.3, 36.7), pos2(811.4, 600.2)),
                scale,
            );
            let size = rect.size() * scale;
            assert!(
                (size.x - size.x.round()).abs() < 1e-2 && (size.y - size.y.round()).abs() < 1e-2
            );
        }
    }
}
