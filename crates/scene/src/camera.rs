//! Cameras: rays through pixels.

use glam::{Mat3, Vec3};
use serde::{Deserialize, Serialize};

/// How a camera sees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Lens {
    /// All rays through one point.
    Pinhole {
        /// Vertical field of view, radians.
        fov: f32,
    },
    /// Parallel rays.
    Orthographic {
        /// Height of what is seen, scene units.
        height: f32,
    },
}

/// A camera. Right-handed, y up; before it is turned it looks along -z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where it is.
    pub eye: Vec3,
    /// Columns: right, up, backwards; orthonormal.
    pub axes: Mat3,
    /// How it sees.
    pub lens: Lens,
    /// Rays start here.
    pub near: f32,
    /// Rays end here at the latest.
    pub far: f32,
    /// Radius of the lens, scene units: what is out of focus is as wide as it lies behind or before the focus, as a share of the way
    /// there, times twice this. 0 for a lens without extent, which shows everything sharp.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub aperture: f32,
    /// How far before the camera, along the way it looks, the plane is that is in focus, scene units; 0 where the lens has no extent.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub focus: f32,
}

fn is_zero(x: &f32) -> bool {
    *x == 0.0
}

/// At (0, 0, 5), looking at the origin, with a field of view of 40 degrees.
impl Default for Camera {
    fn default() -> Self {
        Camera {
            eye: Vec3::new(0.0, 0.0, 5.0),
            axes: Mat3::IDENTITY,
            lens: Lens::Pinhole {
                fov: 40f32.to_radians(),
            },
            near: 0.0,
            far: 1000.0,
            aperture: 0.0,
            focus: 0.0,
        }
    }
}

impl Camera {
    /// A camera at `eye` that looks at `target`, with `up` as much upwards as that allows. `None` where the three do not
    /// define a view.
    pub fn look_at(eye: Vec3, target: Vec3, up: Vec3, lens: Lens) -> Option<Camera> {
        let back = (eye - target).try_normalize()?;
        let right = up
            .cross(back)
            .try_normalize()
            .or_else(|| back.any_orthonormal_vector().try_normalize())?;
        let axes = Mat3::from_cols(right, back.cross(right), back);
        Some(Camera {
            eye,
            axes,
            lens,
            near: 0.0,
            far: 1000.0,
            aperture: 0.0,
            focus: 0.0,
        })
    }

    /// With a lens of this radius that is focused at this distance along the way it looks.
    pub fn with_aperture(self, aperture: f32, focus: f32) -> Camera {
        Camera {
            aperture,
            focus,
            ..self
        }
    }

    /// The ray through a place on the picture: `x` and `y` in pixels from the top left corner, for a picture of this
    /// size. Origin and normalised direction.
    pub fn ray(&self, x: f32, y: f32, [width, height]: [u32; 2]) -> (Vec3, Vec3) {
        let [right, up, back] = [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis];
        let scale = self.plane_height() / height as f32;
        let u = (x - 0.5 * width as f32) * scale;
        let v = (0.5 * height as f32 - y) * scale;
        match self.lens {
            Lens::Pinhole { .. } => (self.eye, (right * u + up * v - back).normalize()),
            Lens::Orthographic { .. } => (self.eye + right * u + up * v, -back),
        }
    }

    /// Height of the picture on the plane at distance 1 (pinhole), or anywhere (orthographic).
    pub fn plane_height(&self) -> f32 {
        match self.lens {
            Lens::Pinhole { fov } => 2.0 * (0.5 * fov).tan(),
            Lens::Orthographic { height } => height,
        }
    }

    /// Full width of a pixel at distance `t`: `slope * t + constant`.
    pub fn pixel_width(&self, height: u32) -> (f32, f32) {
        let width = self.plane_height() / height as f32;
        match self.lens {
            Lens::Pinhole { .. } => (width, 0.0),
            Lens::Orthographic { .. } => (0.0, width),
        }
    }
}

/// The shortest degrees that become exactly these radians of single precision.
pub fn degrees_of(radians: f32) -> f64 {
    let near = f64::from(radians).to_degrees();
    let rounded = (0..15).map(|digits| {
        let text = format!("{near:.digits$}");
        text.parse::<f64>().unwrap_or(near)
    });
    let mut exact = rounded.filter(|d| d.to_radians() as f32 == radians);
    exact.next().unwrap_or(near)
}
