//! Where the camera stands when a scene does not say so.

use crate::draft::{CameraDraft, Focus, camera_with};
use glam::{DMat3, DVec3};
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::{Field, Node};
use zeroset_scene::camera::Camera;
use zeroset_scene::scene::finite_bounds;

/// From the target to the eye: a little to the left, a little above. What is turned by 0, 30 or 45 degrees is seen from a corner.
const THREE_QUARTERS: DVec3 = DVec3::new(-0.51, 0.48, 1.0);
/// Room around what is seen.
const MARGIN: f64 = 1.06;
/// Rays end this many times farther than what is to be seen: an endless floor is endless, whatever the units.
const FAR: f64 = 200.0;

/// The camera of a view; what the view leaves out follows from what is to be seen. Depends on nothing else.
pub(crate) fn camera(
    view: &CameraDraft,
    bounds: impl Iterator<Item = Aabb>,
    size: [u32; 2],
) -> Result<Camera, String> {
    let (centre, half) = match finite_bounds(bounds) {
        Some(b) => (DVec3::from(b.centre()), DVec3::from(b.half())),
        None => (DVec3::ZERO, DVec3::ONE),
    };
    // a point would be looked at from no distance, and single precision sees nothing smaller
    let least = if half.max_element() > 0.0 {
        1e-3 * half.max_element()
    } else {
        1e-3
    };
    let half = half.max(DVec3::splat(least.max(1e-5 * centre.abs().max_element())));
    let target = view.target.unwrap_or(centre);
    let back = match (view.eye, view.direction) {
        _ if view.axes.is_some() => view.axes.unwrap_or_default().z_axis,
        (Some(eye), _) => eye - target,
        (None, Some(direction)) => -direction,
        (None, None) => THREE_QUARTERS,
    };
    let axes = match view.axes {
        Some(axes) => axes,
        None => axes_of(back, view.up)
            .ok_or("the camera stands where it looks: `eye` and `target` must differ")?,
    };
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    // tangents of the half angles, or half sides of the orthographic view
    let fit = fit(&axes, centre - target, half, (0.5 * view.fov).tan(), aspect);
    let lens = view.lens();
    let eye = view.eye.unwrap_or(target + axes.z_axis * fit);
    let reach = (eye - centre).length() + half.length();
    let far = view.far.unwrap_or(FAR * reach);
    if !(eye.is_finite() && axes.is_finite() && view.near < far) {
        return Err("the camera must have finite numbers and `near` below `far`".into());
    }
    let camera = camera_with(axes, eye, lens, view.near, far);
    let camera = match view.aperture > 0.0 {
        true => focused(camera, view, eye, target, axes)?,
        false => camera,
    };
    // what is finite in double precision need not be in single precision
    if !(camera.eye.is_finite() && camera.far.is_finite() && camera.near < camera.far) {
        return Err(format!(
            "the camera stands too far away for single precision: at ({:e}, {:e}, {:e}), with `near` {:e} and `far` {far:e}",
            eye.x, eye.y, eye.z, view.near
        ));
    }
    Ok(camera)
}

/// The camera with its lens, in focus where the view says.
fn focused(
    camera: Camera,
    view: &CameraDraft,
    eye: DVec3,
    target: DVec3,
    axes: DMat3,
) -> Result<Camera, String> {
    let ahead = |point: DVec3| (eye - point).dot(axes.z_axis);
    let focus = match view.focus {
        Some(Focus::Distance(distance)) => distance,
        Some(Focus::Point(point)) => ahead(point),
        None => ahead(target),
    };
    let (aperture, near) = (view.aperture as f32, focus as f32);
    if !(focus > 0.0 && near > 0.0 && near.is_finite()) {
        return Err(format!(
            "the focus of the camera lies {focus:e} before it: it must lie before the camera, so that `focus` is a distance above 0 \
             or a point that the camera looks towards"
        ));
    }
    Ok(camera.with_aperture(aperture, near))
}

/// A box that holds the surface of a field, for what looks at it: that of a formula is as small as a short search finds it,
/// where the box it lives in may be far larger.
pub(crate) fn surface(field: &Field) -> Aabb {
    let bounds = field.facts().bounds;
    match field.node() {
        Node::Formula(formula) => formula.reach(),
        Node::Place { placement, shape } => placement.bounds(&surface(shape)),
        Node::Paint { shape, .. } | Node::Sided(shape) => surface(shape),
        Node::Join {
            entry,
            shapes,
            params,
        } if entry.sharp => {
            let of: Vec<Aabb> = shapes.iter().map(surface).collect();
            (entry.bounds)(params, &of)
        }
        _ => bounds,
    }
}

/// Columns right, up, backwards. `None` where `back` has no direction.
pub(crate) fn axes_of(back: DVec3, up: DVec3) -> Option<DMat3> {
    let back = back.try_normalize()?;
    let right = up.cross(back).try_normalize().unwrap_or_else(|| {
        // looking along `up`: any right will do
        back.any_orthonormal_vector()
    });
    Some(DMat3::from_cols(right, back.cross(right), back))
}

/// How far from the target the eye must stand to see the whole box, whose centre lies at `offset` from the target, with
/// some room around it. `axes` are those of the camera, `tangent` is that of half its vertical field of view, `aspect` the
/// picture's width over its height.
pub fn fit(axes: &DMat3, offset: DVec3, half: DVec3, tangent: f64, aspect: f64) -> f64 {
    let corner = |i: usize| {
        let sign = |k: usize| if i >> k & 1 == 0 { -1.0 } else { 1.0 };
        offset + half * DVec3::new(sign(0), sign(1), sign(2))
    };
    let distance = |p: DVec3| {
        let (x, y, z) = (
            p.dot(axes.x_axis).abs(),
            p.dot(axes.y_axis).abs(),
            p.dot(axes.z_axis),
        );
        z + MARGIN * (x / (tangent * aspect)).max(y / tangent)
    };
    (0..8).map(|i| distance(corner(i))).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(centre: [f64; 3], r: f64) -> Aabb {
        Aabb::new(centre.map(|c| c - r), centre.map(|c| c + r))
    }

    /// Every corner of what is seen lies in the picture, in a wide picture and in a tall one.
    #[test]
    fn sees_the_whole_box() {
        for size in [[400, 400], [900, 300], [200, 800]] {
            for bounds in [
                ball([0.0; 3], 1.0),
                ball([5.0, -2.0, 9.0], 30.0),
                Aabb::new([0.0; 3], [8.0, 0.1, 0.1]),
            ] {
                let camera = camera(&CameraDraft::default(), [bounds].into_iter(), size).unwrap();
                for p in bounds.corners() {
                    let p = DVec3::from(p).as_vec3() - camera.eye;
                    let local = camera.axes.transpose() * p;
                    let half = 0.5 * camera.plane_height() * -local.z;
                    assert!(
                        local.z < 0.0 && local.y.abs() <= half,
                        "{local} in {size:?}"
                    );
                    assert!(
                        local.x.abs() <= half * size[0] as f32 / size[1] as f32,
                        "{local} in {size:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn leaves_out_what_has_no_end() {
        let floor = Aabb {
            max: [f64::INFINITY, 0.0, f64::INFINITY],
            ..Aabb::WHOLE
        };
        let one = camera(
            &CameraDraft::default(),
            [ball([0.0; 3], 1.0)].into_iter(),
            [64, 64],
        )
        .unwrap();
        let two = camera(
            &CameraDraft::default(),
            [floor, ball([0.0; 3], 1.0), Aabb::EMPTY].into_iter(),
            [64, 64],
        )
        .unwrap();
        assert_eq!(one, two);
        assert!(camera(&CameraDraft::default(), [floor].into_iter(), [64, 64]).is_ok());
    }

    #[test]
    fn keeps_what_is_stated() {
        let view = CameraDraft {
            eye: Some(DVec3::new(0.0, 5.0, 0.0)),
            target: Some(DVec3::ZERO),
            ..CameraDraft::default()
        };
        let camera = camera(&view, [ball([0.0; 3], 1.0)].into_iter(), [64, 64]).unwrap();
        assert_eq!(camera.eye, glam::Vec3::new(0.0, 5.0, 0.0));
        let view = CameraDraft {
            target: view.eye,
            ..view
        };
        assert!(super::camera(&view, std::iter::empty(), [64, 64]).is_err());
    }
}
