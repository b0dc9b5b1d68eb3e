//! The camera of the window: what a hand does to it.

use glam::{DMat3, DQuat, DVec3, Vec3};
use std::f64::consts::FRAC_PI_2;
use zeroset_catalogue::LARGE;
use zeroset_catalogue::bounds::Aabb;
use zeroset_language::framing::fit;
use zeroset_scene::camera::{Camera, Lens};

/// Nearest that a zoom comes to what it goes to, scene units.
const CLOSEST: f64 = 1e-5;
/// Widest and narrowest that an orthographic view becomes, scene units.
const HEIGHTS: (f64, f64) = (1e-6, 1e6);
/// The widest field of view, degrees.
const WIDEST: f32 = 170.0;

/// A direction to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From +z.
    Front,
    /// From -z.
    Back,
    /// From +x.
    Right,
    /// From -x.
    Left,
    /// From +y, with -z up.
    Top,
    /// From -y, with +z up.
    Bottom,
}

impl Side {
    /// Columns right, up, backwards.
    fn axes(self) -> DMat3 {
        let (back, up) = match self {
            Side::Front => (DVec3::Z, DVec3::Y),
            Side::Back => (DVec3::NEG_Z, DVec3::Y),
            Side::Right => (DVec3::X, DVec3::Y),
            Side::Left => (DVec3::NEG_X, DVec3::Y),
            Side::Top => (DVec3::Y, DVec3::NEG_Z),
            Side::Bottom => (DVec3::NEG_Y, DVec3::Z),
        };
        DMat3::from_cols(up.cross(back), up, back)
    }
}

/// A camera that can be moved. It keeps single precision out of what is added up over many moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rig {
    eye: DVec3,
    /// Columns right, up, backwards.
    axes: DMat3,
    lens: Lens,
    near: f32,
    far: f32,
    /// Radius of the lens.
    aperture: f32,
    /// How far before it what is sharp lies.
    focus: f32,
    /// From the eye to the point that it orbits.
    distance: f64,
    /// What orbits turn around.
    up: DVec3,
}

impl Rig {
    /// A rig that sees what a camera sees and orbits the middle of the bounds.
    pub fn new(camera: &Camera, bounds: Option<Aabb>) -> Rig {
        let mut axes = orthonormal(camera.axes.as_dmat3());
        let eye = camera.eye.as_dvec3();
        // a camera without roll keeps its right side level, but for rounding
        let level = |up: &DVec3| axes.x_axis.dot(*up).abs() < 1e-4;
        let level = [DVec3::Y, DVec3::Z].into_iter().find(level);
        let up = level.unwrap_or(DVec3::Y);
        if level.is_some() {
            let right = (axes.x_axis - up * axes.x_axis.dot(up)).normalize();
            let back = right.cross(axes.y_axis).normalize();
            axes = DMat3::from_cols(right, back.cross(right), back);
        }
        let distance = bounds.map_or(eye.length().max(1.0), |b| {
            let to = DVec3::from(b.centre()) - eye;
            let radius = DVec3::from(b.half()).length().max(1e-3);
            to.dot(-axes.z_axis).max(0.25 * radius)
        });
        Rig {
            eye,
            axes,
            lens: camera.lens,
            near: camera.near,
            far: camera.far,
            aperture: camera.aperture,
            focus: camera.focus,
            distance,
            up,
        }
    }

    /// The camera as it stands.
    pub fn camera(&self) -> Camera {
        Camera {
            eye: self.eye.as_vec3(),
            axes: self.axes.as_mat3(),
            lens: self.lens,
            near: self.near,
            far: self.far,
            aperture: self.aperture,
            focus: self.focus,
        }
    }

    /// Sees as far as a camera does.
    pub fn see_as_far_as(&mut self, camera: &Camera) {
        self.far = camera.far;
    }

    /// Whether it sees what a camera sees, but for rounding and how far that is.
    pub fn stands_at(&self, camera: &Camera) -> bool {
        let own = self.camera();
        own.eye == camera.eye
            && own.axes.abs_diff_eq(camera.axes, 2e-5)
            && own.lens == camera.lens
            && (own.near, own.aperture) == (camera.near, camera.aperture)
            && (own.aperture == 0.0 || (own.focus - camera.focus).abs() <= 1e-5 * own.focus)
    }

    /// Radius of the lens, and how far before it what is sharp lies.
    pub fn lens(&self) -> [f32; 2] {
        [self.aperture, self.focus]
    }

    /// Another radius of the lens. One that had none is focused on what it orbits.
    pub fn set_aperture(&mut self, aperture: f32) {
        self.aperture = aperture.clamp(0.0, LARGE as f32);
        if self.aperture == 0.0 {
            self.focus = 0.0;
        } else if self.focus == 0.0 {
            self.focus_at(self.distance as f32);
        }
    }

    /// Focuses so far before the camera.
    pub fn focus_at(&mut self, focus: f32) {
        self.focus = focus.clamp(CLOSEST as f32, LARGE as f32);
    }

    /// The point that it orbits.
    pub fn pivot(&self) -> DVec3 {
        self.eye - self.axes.z_axis * self.distance
    }

    /// From the eye to the point that it orbits, scene units.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// What orbits turn around: the way that is up.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Turns around the pivot: `right` and `down` are how far the hand moved what is seen, radians.
    pub fn orbit(&mut self, right: f64, down: f64) {
        let pivot = self.pivot();
        self.turn(-right, -down);
        self.eye = pivot + self.axes.z_axis * self.distance;
    }

    /// Looks around from where it stands, radians.
    pub fn look(&mut self, right: f64, down: f64) {
        self.turn(-right, -down);
    }

    fn turn(&mut self, yaw: f64, pitch: f64) {
        let [right, up, back] = [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis];
        // how high it stands above its pivot; beyond a quarter turn it is upside down
        let height = back.dot(self.up).atan2(up.dot(self.up));
        let pitch = if height.abs() <= FRAC_PI_2 {
            pitch.clamp(height - FRAC_PI_2, height + FRAC_PI_2)
        } else {
            pitch
        };
        let turn = DQuat::from_axis_angle(self.up, yaw) * DQuat::from_axis_angle(right, pitch);
        self.axes = orthonormal(DMat3::from_quat(turn) * self.axes);
    }

    /// Moves with what is seen: `right` and `down` are how far the hand moved it, in pixels of a picture `height` high.
    pub fn pan(&mut self, right: f64, down: f64, height: f64) {
        let plane = f64::from(self.camera().plane_height());
        let pixel = match self.lens {
            Lens::Pinhole { .. } => plane * self.distance / height,
            Lens::Orthographic { .. } => plane / height,
        };
        self.eye += (self.axes.y_axis * down - self.axes.x_axis * right) * pixel;
    }

    /// Goes nearer by a factor (below 1) or away (above 1), so that the point keeps its place in the picture.
    pub fn zoom(&mut self, factor: f64, at: DVec3) {
        if !(factor.is_finite() && factor > 0.0 && at.is_finite()) {
            return;
        }
        match &mut self.lens {
            Lens::Orthographic { height } => {
                let before = f64::from(*height);
                let after = (before * factor).clamp(HEIGHTS.0, HEIGHTS.1);
                *height = after as f32;
                let aside = at - self.eye;
                let aside = aside - self.axes.z_axis * aside.dot(self.axes.z_axis);
                self.eye += aside * (1.0 - after / before);
            }
            Lens::Pinhole { .. } => {
                let away = (self.eye - at).length();
                let factor = factor
                    .max(CLOSEST / away.max(CLOSEST))
                    .max(CLOSEST / self.distance);
                self.eye = at + (self.eye - at) * factor;
                self.distance *= factor;
            }
        }
    }

    /// Moves aside until a point is in the middle, and orbits that point from then on.
    pub fn centre(&mut self, point: DVec3) {
        let distance = (self.eye - point).dot(self.axes.z_axis);
        if point.is_finite() && distance > CLOSEST {
            self.distance = distance;
            self.eye = point + self.axes.z_axis * distance;
        }
    }

    /// Flies: `way` is along right, up and backwards, of length 1; in a second it goes as far as the pivot is.
    pub fn fly(&mut self, way: DVec3, seconds: f64) {
        self.eye += self.axes * way * (self.distance.max(0.01) * seconds);
    }

    /// Steps back or forward, in the direction that it looks, until it sees the whole box.
    pub fn frame(&mut self, bounds: Option<Aabb>, aspect: f64) {
        let bounds = bounds.unwrap_or(Aabb::centred([1.0; 3]));
        let (centre, half) = (DVec3::from(bounds.centre()), DVec3::from(bounds.half()));
        let half = half.max(DVec3::splat(1e-3 * centre.abs().max_element().max(1.0)));
        let distance = match &mut self.lens {
            Lens::Pinhole { fov } => {
                let tangent = (0.5 * f64::from(*fov)).tan();
                fit(&self.axes, DVec3::ZERO, half, tangent, aspect)
            }
            Lens::Orthographic { height } => {
                let extent = |axis: DVec3| 2.0 * axis.abs().dot(half);
                let tall = extent(self.axes.y_axis).max(extent(self.axes.x_axis) / aspect);
                *height = (1.06 * tall).clamp(HEIGHTS.0, HEIGHTS.1) as f32;
                2.0 * half.length()
            }
        };
        self.distance = distance;
        self.eye = centre + self.axes.z_axis * distance;
        self.far = self.far.max((2.0 * (distance + half.length())) as f32);
    }

    /// Looks at its pivot from a side.
    pub fn look_from(&mut self, side: Side) {
        let pivot = self.pivot();
        self.axes = side.axes();
        self.up = DVec3::Y;
        self.eye = pivot + self.axes.z_axis * self.distance;
    }

    /// The statement of the scene language that makes this camera.
    pub fn statement(&self) -> String {
        let camera = self.camera();
        let target = self.pivot().as_vec3();
        let mut text = format!(
            "camera(eye = {}, target = {}",
            point(camera.eye),
            point(target)
        );
        let level = Camera::look_at(camera.eye, target, Vec3::Y, camera.lens);
        if !level.is_some_and(|c| c.axes.abs_diff_eq(camera.axes, 1e-5)) {
            text += &format!(", up = {}", point(camera.axes.y_axis));
        }
        match camera.lens {
            Lens::Pinhole { fov } => {
                let degrees = (f64::from(fov).to_degrees() * 1e4).round() / 1e4;
                text += &format!(", fov = {degrees}");
            }
            Lens::Orthographic { height } => text += &format!(", lens = orthographic({height})"),
        }
        if camera.near != 0.0 {
            text += &format!(", near = {}", camera.near);
        }
        if camera.aperture > 0.0 {
            text += &format!(", aperture = {}, focus = {}", camera.aperture, camera.focus);
        }
        // what is automatic depends on where the camera stands
        text + &format!(", far = {})", camera.far)
    }
}

/// A point as the scene language writes it.
pub(crate) fn point(p: Vec3) -> String {
    // -0 is written as 0
    let [x, y, z] = p.to_array().map(|x| x + 0.0);
    format!("({x}, {y}, {z})")
}

fn orthonormal(axes: DMat3) -> DMat3 {
    let back = axes.z_axis.normalize();
    let right = axes.y_axis.cross(back).normalize();
    DMat3::from_cols(right, back.cross(right), back)
}

/// The camera for a picture of another shape than the scene asks for: what was seen stays in sight.
pub fn widened(camera: &Camera, aspect: f32, shape: [u32; 2]) -> Camera {
    let narrower = aspect / (shape[0].max(1) as f32 / shape[1].max(1) as f32);
    if narrower <= 1.0 {
        return *camera;
    }
    let lens = match camera.lens {
        Lens::Pinhole { fov } => Lens::Pinhole {
            fov: (2.0 * ((0.5 * fov).tan() * narrower).atan()).min(WIDEST.to_radians()),
        },
        Lens::Orthographic { height } => Lens::Orthographic {
            height: (height * narrower).min(HEIGHTS.1 as f32),
        },
    };
    Camera { lens, ..*camera }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn rig() -> Rig {
        let lens = Lens::Pinhole { fov: 0.7 };
        let camera = Camera::look_at(
            Vec3::new(3.0, 2.0, 4.0),
            Vec3::new(0.0, 0.5, 0.0),
            Vec3::Y,
            lens,
        );
        Rig::new(
            &camera.unwrap(),
            Some(Aabb::new([-1.0, -0.5, -1.0], [1.0, 1.5, 1.0])),
        )
    }

    fn orthographic() -> Rig {
        Rig {
            lens: Lens::Orthographic { height: 3.0 },
            ..rig()
        }
    }

    /// Where a point is seen in a picture of 400x300, pixels from the middle.
    fn place(rig: &Rig, p: DVec3) -> (f64, f64) {
        let local = rig.axes.transpose() * (p - rig.eye);
        let scale = 300.0 / f64::from(rig.camera().plane_height());
        match rig.lens {
            Lens::Pinhole { .. } => (local.x / -local.z * scale, local.y / -local.z * scale),
            Lens::Orthographic { .. } => (local.x * scale, local.y * scale),
        }
    }

    #[test]
    fn orbits_keep_their_distance_and_stay_level() {
        let mut rig = rig();
        let pivot = rig.pivot();
        for (right, down) in [
            (0.3, 0.1),
            (-1.2, -0.4),
            (2.0, 3.0),
            (0.1, -7.0),
            (0.5, 0.2),
        ] {
            rig.orbit(right, down);
            assert!((rig.pivot() - pivot).length() < 1e-9);
            assert!(rig.axes.x_axis.y.abs() < 1e-9, "it rolled: {:?}", rig.axes);
            assert!(rig.axes.y_axis.y > -1e-9, "it stands on its head");
            assert!((rig.axes.determinant() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn what_is_orbited_follows_the_hand() {
        let mut turned = rig();
        let near = turned.pivot() + turned.axes.z_axis * 0.5;
        turned.orbit(0.1, 0.1);
        let (x, y) = place(&turned, near);
        assert!(x > 1.0 && y < -1.0, "{x} {y}");
    }

    #[test]
    fn pans_carry_the_pivot_with_the_hand() {
        for mut rig in [rig(), orthographic()] {
            let pivot = rig.pivot();
            rig.pan(30.0, -12.0, 300.0);
            let (x, y) = place(&rig, pivot);
            assert!(
                (x - 30.0).abs() < 1e-3 && (y - 12.0).abs() < 1e-3,
                "{x} {y}"
            );
        }
    }

    #[test]
    fn zooms_keep_the_point_under_the_cursor() {
        for mut rig in [rig(), orthographic()] {
            let p = rig.pivot() + DVec3::new(0.4, -0.2, 0.7);
            let before = place(&rig, p);
            let far = (rig.eye - p).length();
            for factor in [0.5, 0.8, 1.7, 0.01] {
                rig.zoom(factor, p);
                let after = place(&rig, p);
                assert!((before.0 - after.0).abs() + (before.1 - after.1).abs() < 1e-2);
            }
            if matches!(rig.lens, Lens::Pinhole { .. }) {
                assert!((rig.eye - p).length() < 0.01 * far);
            }
            rig.zoom(f64::NAN, p);
            rig.zoom(-1.0, p);
            assert!(rig.eye.is_finite());
        }
    }

    #[test]
    fn a_point_can_be_made_the_pivot() {
        let (mut centred, p) = (rig(), DVec3::new(0.4, -0.2, 0.7));
        centred.centre(p);
        assert!((centred.pivot() - p).length() < 1e-9 && place(&centred, p).0.abs() < 1e-6);
        assert_eq!(centred.axes, rig().axes);
        let before = centred;
        centred.centre(before.eye + before.axes.z_axis);
        assert_eq!(centred, before, "what is behind the camera is no pivot");
    }

    #[test]
    fn framing_shows_every_corner_from_every_side() {
        let bounds = Aabb::new([-3.0, 0.0, 1.0], [1.0, 0.5, 9.0]);
        for start in [rig(), orthographic()] {
            for side in [
                Side::Front,
                Side::Back,
                Side::Right,
                Side::Left,
                Side::Top,
                Side::Bottom,
            ] {
                for aspect in [0.5, 4.0 / 3.0, 3.0] {
                    let mut rig = start;
                    rig.look_from(side);
                    rig.frame(Some(bounds), aspect);
                    for corner in bounds.corners() {
                        let (x, y) = place(&rig, DVec3::from(corner));
                        assert!(
                            y.abs() <= 150.0 && x.abs() <= 150.0 * aspect,
                            "{side:?} {aspect}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_narrow_window_loses_nothing() {
        let camera = rig().camera();
        assert_eq!(widened(&camera, 1.0, [900, 300]), camera);
        let narrow = widened(&camera, 1.5, [300, 600]);
        let width = |c: &Camera, aspect: f32| c.plane_height() * aspect;
        assert!((width(&narrow, 0.5) - width(&camera, 1.5)).abs() < 1e-5);
    }

    /// The statement is read as a scene and gives the same camera.
    #[test]
    fn the_statement_makes_the_same_camera() {
        let mut rigs = vec![rig(), orthographic()];
        let mut moved = rig();
        moved.orbit(1.3, 0.7);
        moved.pan(20.0, 33.0, 400.0);
        moved.zoom(0.31, DVec3::new(0.2, 0.3, -0.1));
        rigs.push(moved);
        for side in [Side::Front, Side::Left, Side::Top, Side::Bottom] {
            moved.look_from(side);
            rigs.push(moved);
        }
        let mut far = rig();
        far.frame(Some(Aabb::centred([4000.0; 3])), 1.0);
        far.near = 0.25;
        rigs.push(far);
        for rig in rigs {
            let text = format!("show(sphere())\n{}\n", rig.statement());
            let loaded = load_text(
                "copy.star",
                &text,
                Language::Starlark,
                None,
                &Options::default(),
            );
            let scene = loaded.unwrap_or_else(|e| panic!("{text}: {e}")).scene;
            let camera = scene.camera();
            let wanted = rig.camera();
            assert_eq!(camera.eye, wanted.eye, "{text}");
            assert!(
                camera.axes.abs_diff_eq(wanted.axes, 2e-5),
                "{text}: {:?}",
                camera.axes
            );
            assert!(
                (camera.plane_height() - wanted.plane_height()).abs()
                    < 1e-5 * wanted.plane_height()
            );
            assert_eq!(
                (camera.near, camera.far),
                (wanted.near, wanted.far),
                "{text}"
            );
        }
    }
}
