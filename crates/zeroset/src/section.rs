//! Sections: a field on a plane across an axis.

use fearless_simd::Level;
use zeroset_eval::{BATCH, Workspace, gradients};
use zeroset_field::program::Program;
use zeroset_output::view::section::Section;

/// A plane across an axis, and what is seen of it.
///
/// The two axes of the picture are the other two in their order, so that `z` shows x to the right and y up; `y` shows
/// x to the right and z down, as from above; `x` shows z to the left and y up, as from its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionPlane {
    /// 0 = x, 1 = y, 2 = z.
    pub axis: usize,
    /// Where on the axis.
    pub at: f64,
    /// Middle of the picture: its coordinates on the plane, to the right and up.
    pub centre: [f64; 2],
    /// Side of a pixel, scene units.
    pub pixel: f64,
}

impl SectionPlane {
    /// The axes that point right and up on the picture, with their signs.
    pub fn directions(&self) -> [(usize, f64); 2] {
        match self.axis {
            0 => [(2, -1.0), (1, 1.0)],
            1 => [(0, 1.0), (2, -1.0)],
            _ => [(0, 1.0), (1, 1.0)],
        }
    }

    /// The point in space of a place on the picture (pixels from the top left corner).
    pub fn point(&self, x: f64, y: f64, [width, height]: [u32; 2]) -> [f64; 3] {
        let across = [x - 0.5 * f64::from(width), 0.5 * f64::from(height) - y];
        let mut point = [0.0; 3];
        point[self.axis] = self.at;
        for k in 0..2 {
            let (axis, sign) = self.directions()[k];
            point[axis] = sign * (self.centre[k] + across[k] * self.pixel);
        }
        point
    }

    /// Samples the distance to the surface of a field on the plane, as it is shown. The caller has checked the size against its limits.
    pub fn sample(&self, program: &Program, size: [u32; 2]) -> Section {
        let [width, height] = size;
        let count = width as usize * height as usize;
        let (mut values, mut slopes) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut workspace = Workspace::new(program.values(), program.marks());
        let level = Level::new();
        for first in (0..count).step_by(BATCH) {
            let n = BATCH.min(count - first);
            for i in 0..BATCH {
                let at = (first + i.min(n - 1)) as u32;
                let point = self.point(
                    f64::from(at % width) + 0.5,
                    f64::from(at / width) + 0.5,
                    size,
                );
                for (lane, x) in workspace.points_mut().iter_mut().zip(point) {
                    lane.0[i] = x as f32;
                }
            }
            zeroset_number::at_level!(level, s => gradients(s, program.values(), &mut workspace, n));
            let [(right, _), (up, _)] = self.directions();
            for i in 0..n {
                let (value, gradient) = program.shown_distance(workspace.gradient(i));
                values.push(value);
                slopes.push(gradient[right].hypot(gradient[up]));
            }
        }
        Section {
            width,
            height,
            pixel: self.pixel as f32,
            values,
            slopes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_catalogue::entries::catalogue;
    use zeroset_field::field::Field;
    use zeroset_field::placement::Placement;
    use zeroset_field::program::Limits;

    fn ball_at(centre: [f64; 3]) -> Program {
        let entry = catalogue().primitive("sphere").unwrap();
        let ball = Field::primitive(entry, vec![0.5])
            .unwrap()
            .place(Placement::moved(centre))
            .unwrap();
        Program::compile(&ball, &Limits::default()).unwrap()
    }

    #[test]
    fn a_section_is_the_field_on_the_plane() {
        let centre = [0.3, -0.2, 0.1];
        let program = ball_at(centre);
        for axis in 0..3 {
            let plane = SectionPlane {
                axis,
                at: 0.25,
                centre: [0.1, 0.2],
                pixel: 0.05,
            };
            let section = plane.sample(&program, [37, 23]);
            for (i, &value) in section.values.iter().enumerate() {
                let point = plane.point((i % 37) as f64 + 0.5, (i / 37) as f64 + 0.5, [37, 23]);
                assert_eq!(point[axis], 0.25);
                let away: Vec<f64> = (0..3).map(|k| point[k] - centre[k]).collect();
                let distance = away.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!(
                    (f64::from(value) - (distance - 0.5)).abs() < 1e-5,
                    "axis {axis}, pixel {i}"
                );
                let along = (distance * distance - away[axis] * away[axis]).sqrt() / distance;
                assert!(
                    (f64::from(section.slopes[i]) - along).abs() < 1e-4,
                    "axis {axis}, pixel {i}"
                );
            }
        }
    }

    #[test]
    fn right_is_right_and_up_is_up() {
        for (axis, right, up) in [
            (2, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            (1, [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
            (0, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
        ] {
            let plane = SectionPlane {
                axis,
                at: 0.0,
                centre: [0.0; 2],
                pixel: 1.0,
            };
            let point = |x, y| plane.point(x, y, [10, 10]).map(|c| c + 0.0);
            assert_eq!(point(6.0, 5.0), right);
            assert_eq!(point(5.0, 4.0), up);
        }
    }
}
