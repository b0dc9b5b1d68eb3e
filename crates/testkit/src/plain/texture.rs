//! Patterns within patterns, moved and turned, and what their heights do to normals.

use super::{field, glam};
use glam::{Mat3, Vec3};
use zeroset_number::{F64, v3};
use zeroset_scene::material::{Bump, Ink, Pattern};
use zeroset_shade::pattern::{self, Place, Texture};

/// A place as it is in another space, where it is at `point`; `rows` are the derivatives of its coordinates.
pub(super) fn seen_from(at: &Place<f32>, point: Vec3, rows: [Vec3; 3]) -> Place<f32> {
    let matrix = Mat3::from_cols(rows[0], rows[1], rows[2]).transpose();
    let normals = matrix.inverse().transpose();
    let squares: f32 = rows.iter().map(|row| row.length_squared()).sum();
    Place {
        point: field(point),
        normal: field((normals * glam(at.normal)).normalize()),
        width: at.width * (squares / 3.0).sqrt(),
        stretch: field(matrix * glam(at.stretch)),
        orbit: at.orbit,
    }
}

/// The colour of a pattern.
pub(super) fn shown(whole: &Pattern, at: &Place<f32>) -> Vec3 {
    seen(whole, at, false)
}

/// What a pattern shows, as a colour or as a height.
fn seen(whole: &Pattern, at: &Place<f32>, heights: bool) -> Vec3 {
    let ink = |ink: &Ink| match ink {
        Ink::Colour(colour) => *colour,
        Ink::Pattern(inner) => seen(inner, at, heights),
    };
    let mixed = |inks: &[Ink; 2], second: f32| ink(&inks[0]).lerp(ink(&inks[1]), second);
    match whole {
        Pattern::Solid { colour } => *colour,
        Pattern::Placed {
            pattern,
            rows,
            offset,
        } => {
            let p = glam(at.point);
            let point = Vec3::from(rows.map(|row| row.dot(p))) + *offset;
            seen(pattern, &seen_from(at, point, *rows), heights)
        }
        Pattern::Formula { formula } => {
            let p = at.point.map(|x| F64(f64::from(x)));
            let colour = formula.eval(p).map(|c| c.0 as f32);
            match colour.iter().all(|c| c.abs() < 1e30) {
                true if heights => Vec3::from(colour).clamp(Vec3::splat(-1e6), Vec3::splat(1e6)),
                true => Vec3::from(colour).clamp(Vec3::ZERO, Vec3::ONE),
                false => Vec3::new(1.0, 0.0, 1.0),
            }
        }
        Pattern::Checker { colours, size } => mixed(colours, pattern::checker(at, *size)),
        Pattern::Stripes {
            colours,
            direction,
            size,
        } => mixed(colours, pattern::stripes(at, field(*direction), *size)),
        Pattern::Noise {
            colours,
            size,
            octaves,
        } => mixed(colours, pattern::noise(at, *size, *octaves as f32)),
        Pattern::Gradient { colours, from, to } => {
            mixed(colours, pattern::gradient(at, field(*from), field(*to)))
        }
        Pattern::Triplanar { .. } => glam(Texture::new(whole).colour(at)),
        Pattern::Orbit { colours } => {
            let shares = pattern::orbit(at);
            colours
                .iter()
                .zip(shares)
                .map(|(c, share)| ink(c) * share)
                .sum()
        }
    }
}

/// A pattern as a number, 0 to 1.
pub(super) fn number(pattern: &Pattern, at: &Place<f32>) -> f32 {
    luminance(shown(pattern, at)).clamp(0.0, 1.0)
}

fn height(pattern: &Pattern, at: &Place<f32>) -> f32 {
    luminance(seen(pattern, at, true))
}

fn luminance(colour: Vec3) -> f32 {
    colour.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// The normal of a surface with heights: that of the plane through what is raised, as far as it is seen. `here` is the place in the space
/// of the heights.
pub(super) fn bumped(
    bump: &Bump,
    at: &Place<f32>,
    here: &Place<f32>,
    rows: [Vec3; 3],
    d: Vec3,
) -> Vec3 {
    let normal = glam(at.normal);
    let larger = here.width / at.width;
    let finest = Texture::new(&bump.pattern).finest();
    let step = here.width.max(finest * pattern::BUMP_STEP) / larger;
    let raised = |beside: Vec3| {
        let moved = Vec3::from(rows.map(|row| row.dot(beside)));
        let place = Place {
            point: here.point + v3(moved.x, moved.y, moved.z),
            ..*here
        };
        beside + normal * (height(&bump.pattern, &place) * bump.depth / larger)
    };
    let (a, b) = normal.any_orthonormal_pair();
    let across = raised(a * step) - raised(-a * step);
    let along = raised(b * step) - raised(-b * step);
    let turned = across.cross(along).normalize();
    let turned = turned * turned.dot(normal).signum();
    (turned - d * (turned.dot(d) + 0.02).max(0.0)).normalize()
}

/// A direction on the side of a face: what is on the other goes along it.
pub(super) fn on_side(direction: Vec3, face: Vec3) -> Vec3 {
    let facing = face.dot(direction);
    if facing >= 0.0 {
        return direction;
    }
    (direction + face * (0.02 - facing)).normalize()
}
