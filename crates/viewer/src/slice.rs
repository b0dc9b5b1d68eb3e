//! A plane through the field: how far every point of it is from the surface, drawn into the picture.

use crate::develop::pixels;
use crate::engine::Request;
use eframe::egui::{Color32, ColorImage};
use fearless_simd::Level;
use glam::Vec3;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::{BATCH, Workspace, gradients};
use zeroset_field::program::{Limits, Program};
use zeroset_output::view::section::Section;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::scene::Scene;

/// Air around the scene's bounds, as a share of their largest side.
const AIR: f64 = 0.15;
/// Half side of the plane where nothing has an end, scene units.
const UNBOUNDED: f64 = 2.0;
/// How much of the plane is seen where nothing is before it, and where a surface is.
const BEFORE: f32 = 0.9;
const BEHIND: f32 = 0.4;

/// A plane across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// 0 = x, 1 = y, 2 = z.
    pub axis: usize,
    /// Where on the axis.
    pub at: f64,
}

impl Slice {
    /// What of space the plane can be moved through: the bounds of the scene and some air.
    pub fn room(scene: &Scene) -> Aabb {
        let Some(bounds) = scene.finite_bounds() else {
            return Aabb::centred([UNBOUNDED; 3]);
        };
        let largest = (0..3)
            .map(|k| bounds.max[k] - bounds.min[k])
            .fold(1e-3, f64::max);
        Aabb {
            min: bounds.min.map(|x| x - AIR * largest),
            max: bounds.max.map(|x| x + AIR * largest),
        }
    }

    /// Where a ray meets the part of the plane that lies in the room.
    fn meet(&self, room: &Aabb, origin: Vec3, direction: Vec3) -> Option<(f32, Vec3)> {
        let t = (self.at as f32 - origin[self.axis]) / direction[self.axis];
        let mut point = origin + direction * t;
        point[self.axis] = self.at as f32;
        let inside = (0..3)
            .filter(|&k| k != self.axis)
            .all(|k| (room.min[k]..=room.max[k]).contains(&f64::from(point[k])));
        (t > 0.0 && t.is_finite() && inside).then_some((t, point))
    }
}

/// A field that planes are cut through. It is compiled once for a scene.
#[derive(Default)]
pub struct Cut(Option<Compiled>);

struct Compiled {
    scene: Arc<Scene>,
    program: Program,
    workspace: Workspace,
    room: Aabb,
    /// The plane that was drawn last, and the largest distance on it.
    farthest: Option<(Slice, f32)>,
}

impl Cut {
    /// Draws the plane into a picture of the request, and gives the largest distance on it. A scene without a field stays
    /// as it is.
    pub fn paint(
        &mut self,
        slice: &Slice,
        request: &Request,
        film: &Film,
        image: &mut ColorImage,
    ) -> Option<f32> {
        if self
            .0
            .as_ref()
            .is_none_or(|c| !Arc::ptr_eq(&c.scene, &request.scene))
        {
            self.0 = Compiled::new(&request.scene);
        }
        let compiled = self.0.as_mut()?;
        compiled.paint(slice, request, film, image);
        Some(compiled.farthest(slice))
    }
}

impl Compiled {
    fn new(scene: &Arc<Scene>) -> Option<Compiled> {
        // what cannot be compiled cannot be rendered either, and is said there
        let field = scene.field().ok().flatten()?;
        let program = Program::compile(&field, &Limits::default()).ok()?;
        Some(Compiled {
            scene: Arc::clone(scene),
            workspace: Workspace::new(program.values(), program.marks()),
            program,
            room: Slice::room(scene),
            farthest: None,
        })
    }

    fn paint(&mut self, slice: &Slice, request: &Request, film: &Film, image: &mut ColorImage) {
        let farthest = self.farthest(slice);
        let size = [film.width(), film.height()];
        let camera = request.camera;
        let ray = |x: f32, y: f32| {
            let (origin, direction) = camera.ray(x, y, size);
            slice.meet(&self.room, origin, direction)
        };
        // pixels that see the plane, where they see it, and how the point moves from pixel to pixel
        let (mut seen, mut points, mut steps) = (Vec::new(), Vec::new(), Vec::new());
        let depth = film.plane(Plane::Depth);
        for i in 0..size[0] * size[1] {
            let (x, y) = ((i % size[0]) as f32 + 0.5, (i / size[0]) as f32 + 0.5);
            let Some((t, point)) = ray(x, y) else {
                continue;
            };
            let hidden = depth.get(i as usize).is_some_and(|d| *d < t);
            let beside = |dx, dy| ray(x + dx, y + dy).or_else(|| ray(x - dx, y - dy));
            let step = |dx, dy| beside(dx, dy).map_or(Vec3::ZERO, |(_, p)| p - point);
            seen.push((i as usize, hidden));
            points.push(point);
            steps.push([step(1.0, 0.0), step(0.0, 1.0)]);
        }
        if seen.is_empty() {
            return;
        }
        let (values, slopes) = self.evaluate(&points);
        // lines are as wide on the screen wherever they are: slopes are taken from pixel to pixel
        let across = |s: &[Vec3; 2]| s[0].length().max(s[1].length());
        let pixel =
            (steps.iter().map(across).sum::<f32>() / steps.len() as f32).max(f32::MIN_POSITIVE);
        let slopes = slopes
            .iter()
            .zip(&steps)
            .map(|(gradient, step)| gradient.dot(step[0]).hypot(gradient.dot(step[1])) / pixel);
        let section = Section {
            width: seen.len() as u32,
            height: 1,
            pixel,
            values,
            slopes: slopes.collect(),
        };
        let drawn = pixels(&section.drawn(farthest));
        for (&(i, hidden), colour) in seen.iter().zip(&drawn.pixels) {
            let share = if hidden { BEHIND } else { BEFORE };
            image.pixels[i] = blend(image.pixels[i], *colour, share);
        }
    }

    /// The largest distance on the plane, so that colours keep their meaning when the camera moves.
    fn farthest(&mut self, slice: &Slice) -> f32 {
        if let Some((before, farthest)) = self.farthest
            && before == *slice
        {
            return farthest;
        }
        let along = |k: usize, i: i32| {
            let share = f64::from(i) / 32.0;
            (self.room.min[k] + share * (self.room.max[k] - self.room.min[k])) as f32
        };
        let (u, v) = ((slice.axis + 1) % 3, (slice.axis + 2) % 3);
        let points: Vec<Vec3> = (0..33 * 33)
            .map(|i| {
                let mut point = Vec3::splat(slice.at as f32);
                (point[u], point[v]) = (along(u, i % 33), along(v, i / 33));
                point
            })
            .collect();
        let finite = |m: f32, v: &f32| if v.is_finite() { m.max(v.abs()) } else { m };
        let farthest = self.evaluate(&points).0.iter().fold(0.0, finite);
        self.farthest = Some((*slice, farthest));
        farthest
    }

    /// Distances as they are shown, and their gradients.
    fn evaluate(&mut self, points: &[Vec3]) -> (Vec<f32>, Vec<Vec3>) {
        let level = Level::new();
        let (mut values, mut slopes) = (Vec::new(), Vec::new());
        for batch in points.chunks(BATCH) {
            let n = batch.len();
            for (k, lane) in self.workspace.points_mut().iter_mut().enumerate() {
                for (i, x) in lane.0.iter_mut().enumerate() {
                    *x = batch[i.min(n - 1)][k];
                }
            }
            let (program, workspace) = (&self.program, &mut self.workspace);
            zeroset_number::at_level!(level, s => gradients(s, program.values(), workspace, n));
            for i in 0..n {
                let (value, gradient) = self.program.shown_distance(self.workspace.gradient(i));
                values.push(value);
                slopes.push(Vec3::from(gradient));
            }
        }
        (values, slopes)
    }
}

/// A colour over another.
fn blend(under: Color32, over: Color32, share: f32) -> Color32 {
    let mix = |a: u8, b: u8| (f32::from(a) + share * (f32::from(b) - f32::from(a))).round() as u8;
    let ([r, g, b, _], [s, h, c, _]) = (under.to_array(), over.to_array());
    Color32::from_rgb(mix(r, s), mix(g, h), mix(b, c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Look;
    use zeroset_language::load::{Language, Options, load_text};
    use zeroset_scene::render::{Renderer, Silent};
    use zeroset_trace::CpuRenderer;

    /// A ball seen along z, cut through its middle by the plane across z.
    fn cut(at: f64) -> (ColorImage, ColorImage, Option<f32>) {
        let text = "show(sphere(0.5))\ncamera(eye = (0, 0, 4), target = (0, 0, 0), lens = orthographic(2))\n\
                    render(size = (200, 200), aa = none())\nsky(color = \"#00ff00\")\n";
        let loaded = load_text(
            "cut.star",
            text,
            Language::Starlark,
            None,
            &Options::default(),
        );
        let scene = Arc::new(loaded.unwrap().scene);
        let look = Look {
            settings: *scene.settings(),
            shadow: None,
            plane: Plane::Colour,
        };
        let film = CpuRenderer::new(Some(1))
            .unwrap()
            .render(&scene, &Silent)
            .unwrap()
            .film;
        let request = Request {
            edition: 0,
            camera: *scene.camera(),
            size: [200, 200],
            looks: vec![look],
            refine: false,
            converge: None,
            slice: None,
            scene,
        };
        let before = ColorImage::filled([200, 200], Color32::from_rgb(0, 255, 0));
        let mut after = before.clone();
        let slice = Slice { axis: 2, at };
        let farthest = Cut::default().paint(&slice, &request, &film, &mut after);
        (before, after, farthest)
    }

    #[test]
    fn the_plane_shows_inside_surface_and_outside() {
        let (before, after, farthest) = cut(0.0);
        // the middle of the ball is farther from its surface than the corners of the room
        assert!((farthest.unwrap() - 0.5).abs() < 1e-3, "{farthest:?}");
        // along a row through the middle: pixels are 0.01 wide
        let pixel = |x: f32| after.pixels[100 * 200 + (100.0 + 100.0 * x) as usize];
        assert_eq!(pixel(0.7), before.pixels[0], "beside the plane");
        let (inside, surface, outside) = (pixel(0.1), pixel(0.5), pixel(0.6));
        assert!(outside.r() > outside.b(), "{outside:?}");
        assert!(surface.r() < 110 && surface.b() < 110, "{surface:?}");
        // behind the front of the ball the plane only shines through
        assert!(inside.b() > 40 && inside.g() > 140, "{inside:?}");
    }

    #[test]
    fn a_plane_before_the_surface_hides_it() {
        let (_, after, _) = cut(0.57);
        let middle = after.pixels[100 * 200 + 100];
        assert!(middle.r() > 180 && middle.g() < 250, "{middle:?}");
    }
}
