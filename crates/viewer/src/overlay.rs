//! What is drawn over the picture: the axes, which can be pressed, and the ground as a grid.

use crate::pick::depth;
use crate::rig::Side;
use crate::session::Session;
use eframe::egui::{
    Align2, Color32, FontId, Id, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};
use glam::{DVec3, Vec3};
use zeroset_scene::camera::{Camera, Lens};

/// From the middle of the axes to their ends, points.
const REACH: f32 = 34.0;
/// Radius of what can be pressed at their ends, points.
const BALL: f32 = 9.0;
/// A picture that is narrower has no room for them, points.
const LEAST: f32 = 240.0;
/// Lines of the grid to each side of the middle.
const LINES: i32 = 20;
/// Pieces of a line, each of which is seen or hidden.
const PIECES: i32 = 80;

/// The six ways to look along an axis, with the colour and the name of what points there.
const ENDS: [(Side, Vec3, &str, [u8; 3]); 6] = [
    (Side::Right, Vec3::X, "+x", [226, 88, 78]),
    (Side::Left, Vec3::NEG_X, "-x", [226, 88, 78]),
    (Side::Top, Vec3::Y, "+y", [112, 178, 74]),
    (Side::Bottom, Vec3::NEG_Y, "-y", [112, 178, 74]),
    (Side::Front, Vec3::Z, "+z", [78, 132, 228]),
    (Side::Back, Vec3::NEG_Z, "-z", [78, 132, 228]),
];

/// The axes as the camera sees them, in a corner of the picture. Pressing an end looks from there.
pub(crate) fn gizmo(ui: &mut Ui, session: &mut Session, rect: Rect) {
    if rect.width() < LEAST || rect.height() < LEAST {
        return;
    }
    let middle = rect.right_top() + vec2(-REACH - BALL - 14.0, REACH + BALL + 14.0);
    let axes = session.rig.camera().axes;
    let mut ends = ENDS.map(|(side, way, name, rgb)| {
        let seen = axes.transpose() * way;
        let at = middle + REACH * vec2(seen.x, -seen.y);
        (seen.z, side, at, name, rgb)
    });
    // from the back to the front
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (toward, side, at, name, [r, g, b]) in ends {
        let ball = Rect::from_center_size(at, vec2(2.0 * BALL, 2.0 * BALL));
        let response = ui.interact(ball, Id::unique(("axis", name)), Sense::click());
        let said = format!("Look from {name}");
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &said));
        if response.clicked() {
            session.rig.look_from(side);
            session.is_free = true;
        }
        let is_near = response.hovered() || response.has_focus();
        // what points away is dimmer
        let light = 0.62 + 0.38 * toward;
        let ink = Color32::from_rgb(r, g, b).gamma_multiply(if is_near { 1.0 } else { light });
        let painter = ui.painter();
        match name.strip_prefix('+') {
            Some(letter) => {
                painter.line_segment([middle, at], Stroke::new(2.0, ink));
                painter.circle_filled(at, BALL, ink);
                let font = FontId::proportional(11.5);
                painter.text(at, Align2::CENTER_CENTER, letter, font, Color32::WHITE);
            }
            None => {
                let fill = Color32::from_black_alpha(if is_near { 120 } else { 60 });
                painter.circle(at, 0.62 * BALL, fill, Stroke::new(1.5, ink));
            }
        }
    }
}

/// The plane through the origin at right angles to what is up, as a grid; what lies in front of it hides it.
pub(crate) fn grid(ui: &Ui, session: &Session, rect: Rect, size: [u32; 2]) {
    if !session.has_grid || session.current.is_none() {
        return;
    }
    let camera = session.camera(size);
    let film = (session.shown.as_ref()).and_then(|s| s.sides.first().map(|side| &side.film));
    let up = session.rig.up();
    let across = if up.y.abs() > 0.9 {
        DVec3::X
    } else {
        up.any_orthonormal_vector()
    };
    let along = across.cross(up);
    // lines every 1, 10, 100, ... scene units, as many as can be told apart
    let spacing = 10_f64.powf((0.6 * session.rig.distance()).max(1e-6).log10().floor());
    let pivot = session.rig.pivot();
    let snap = |way: DVec3| (pivot.dot(way) / spacing).round() as i64;
    let middle = [snap(across), snap(along)];
    let reach = spacing * f64::from(LINES);
    let piece = 2.0 * reach / f64::from(PIECES);
    let see = |point: DVec3| -> Option<Pos2> {
        let (share, distance) = seen(&camera, point.as_vec3(), size)?;
        let hidden = film.and_then(|film| depth(film, share));
        // the grid lies on floors at its height
        let is_seen = hidden.is_none_or(|depth| distance <= 1.004 * depth);
        let at = pos2(
            rect.left() + share[0] * rect.width(),
            rect.top() + share[1] * rect.height(),
        );
        is_seen.then_some(at)
    };
    let painter = ui.painter().with_clip_rect(rect);
    for turned in [false, true] {
        let (side, way) = if turned {
            (along, across)
        } else {
            (across, along)
        };
        let centre = if turned {
            [middle[1], middle[0]]
        } else {
            middle
        };
        for line in -i64::from(LINES)..=i64::from(LINES) {
            let number = centre[0] + line;
            let (rgb, weight) = match (number, turned) {
                (0, true) => ([226, 88, 78], 1.0),
                (0, false) => ([78, 132, 228], 1.0),
                (n, _) if n % 10 == 0 => ([150, 150, 150], 0.75),
                _ => ([150, 150, 150], 0.55),
            };
            let offset = side * (spacing * number as f64) + way * (spacing * centre[1] as f64);
            let mut before = None;
            for k in 0..=PIECES {
                let s = -reach + piece * f64::from(k);
                let now = see(offset + way * s);
                let away = (s / reach).hypot(f64::from(line as i32) / f64::from(LINES));
                let fade = (1.0 - away).clamp(0.0, 1.0);
                if let (Some(a), Some(b), true) = (before, now, fade > 0.0) {
                    let [r, g, b8] = rgb;
                    let alpha = (220.0 * weight * fade) as u8;
                    let ink = Color32::from_rgba_unmultiplied(r, g, b8, alpha);
                    painter.line_segment([a, b], Stroke::new(1.0, ink));
                }
                before = now;
            }
        }
    }
}

/// Where a camera sees a point, as shares of the picture, and how far along its ray. `None` behind it.
fn seen(camera: &Camera, point: Vec3, size: [u32; 2]) -> Option<([f32; 2], f32)> {
    let local = camera.axes.transpose() * (point - camera.eye);
    let ahead = -local.z;
    if ahead <= camera.near.max(1e-6) {
        return None;
    }
    let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
    let (height, distance) = match camera.lens {
        Lens::Pinhole { .. } => (camera.plane_height() * ahead, local.length()),
        Lens::Orthographic { .. } => (camera.plane_height(), ahead),
    };
    let share = [0.5 + local.x / (height * aspect), 0.5 - local.y / height];
    Some((share, distance))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ray through where a point is seen meets the point.
    #[test]
    fn points_are_where_their_rays_go() {
        let size = [640, 360];
        for lens in [
            Lens::Pinhole { fov: 0.8 },
            Lens::Orthographic { height: 3.0 },
        ] {
            let eye = Vec3::new(2.0, 1.5, 4.0);
            let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).unwrap();
            for point in [
                Vec3::ZERO,
                Vec3::new(0.5, -0.3, 0.2),
                Vec3::new(-1.0, 0.4, -2.0),
            ] {
                let (share, distance) = seen(&camera, point, size).unwrap();
                let place = [share[0] * size[0] as f32, share[1] * size[1] as f32];
                let (origin, direction) = camera.ray(place[0], place[1], size);
                let met = origin + direction * distance;
                assert!((met - point).length() < 1e-4, "{lens:?} {met} {point}");
            }
            assert!(seen(&camera, 2.0 * eye, size).is_none());
        }
    }
}
