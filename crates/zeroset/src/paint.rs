//! What a mesh of a scene is painted with: colours at its vertices, and what its faces are made of.

use fearless_simd::Level;
use zeroset_eval::{BATCH, Evaluator, Point, Workspace};
use zeroset_field::program::Program;
use zeroset_number::{Dual, F64, Vec3, v3};
use zeroset_scene::material::Material;
use zeroset_scene::scene::Scene;
use zeroset_shade::coat::Coat;
use zeroset_shade::pattern::Place;

/// How far behind the surface it is asked what the surface is, in cells: there it is said where two things touch.
const BEHIND: f64 = 0.02;

/// The colours of a scene's surface.
pub(crate) struct Painter<'s> {
    program: &'s Program,
    coats: Vec<Coat>,
    materials: &'s [Material],
    fallback: Coat,
    /// Width of a cell of the mesh, scene units: patterns finer than that are averaged.
    width: f64,
}

/// Which materials a place has.
#[derive(Clone, Copy)]
struct Mark {
    first: f32,
    second: f32,
    share: f32,
    orbit: [f32; 4],
}

impl<'s> Painter<'s> {
    pub(crate) fn new(scene: &'s Scene, program: &'s Program, width: f64) -> Painter<'s> {
        Painter {
            program,
            coats: Coat::all(scene, program),
            materials: scene.materials(),
            fallback: Coat::new(&Material::default(), 0),
            width,
        }
    }

    /// Normals at points of the surface, and what is there.
    fn marks(&self, points: &[[f32; 3]]) -> (Vec<glam::Vec3>, Vec<Mark>) {
        let points: Vec<glam::Vec3> = points.iter().map(|p| (*p).into()).collect();
        let mut values = vec![0.0; points.len()];
        let mut normals = vec![glam::Vec3::ZERO; points.len()];
        // slices of one length
        let _ = Evaluator::new(self.program.values()).gradients(&points, &mut values, &mut normals);
        normals
            .iter_mut()
            .for_each(|n| *n = n.normalize_or(glam::Vec3::Y));
        let behind = (BEHIND * self.width) as f32;
        let (level, tape) = (Level::new(), self.program.marks());
        let mut work = Workspace::new(self.program.values(), tape);
        let mut marks = Vec::with_capacity(points.len());
        for (points, normals) in points.chunks(BATCH).zip(normals.chunks(BATCH)) {
            let count = points.len();
            for (k, lane) in work.points_mut().iter_mut().enumerate() {
                for (x, (p, n)) in lane.0.iter_mut().zip(points.iter().zip(normals)) {
                    *x = p[k] - behind * n[k];
                }
                let last = lane.0[count - 1];
                lane.0[count..].fill(last);
            }
            let w = &mut work;
            zeroset_number::at_level!(level, s => zeroset_eval::marks(s, tape, w, count));
            let found = work.marks();
            marks.extend((0..count).map(|i| Mark {
                first: found.first.0[i],
                second: found.second.0[i],
                share: found.share.0[i],
                orbit: found.orbit.each_ref().map(|lane| lane.0[i]),
            }));
        }
        (normals, marks)
    }

    fn coat(&self, number: f32) -> &Coat {
        let at = if number >= 0.0 {
            number as usize
        } else {
            usize::MAX
        };
        self.coats.get(at).unwrap_or(&self.fallback)
    }

    /// The linear colours at points of the surface.
    pub(crate) fn colours(&self, points: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let (normals, marks) = self.marks(points);
        let mut places = Point::<Dual<F64>>::new(self.program.places());
        let mut colour = |coat: &Coat, at: &Place<f32>| {
            let mut here = *at;
            if coat.place != 0 {
                let p = at.point.array().map(|x| F64(x.into()));
                let found = places
                    .place(Dual::point(v3(p[0], p[1], p[2])), coat.place)
                    .array();
                let [x, y, z] = found.map(|c| c.v.0 as f32);
                let rows = found.map(|c| vector(c.d.map(|x| x.0 as f32)));
                here = at.mapped(v3(x, y, z), rows);
            }
            coat.local(&here).albedo.array()
        };
        (points.iter().zip(normals).zip(marks))
            .map(|((p, normal), mark)| {
                let n = vector(normal.to_array());
                let at = Place::new(vector(*p), n, -n, self.width as f32).with_orbit(mark.orbit);
                let first = colour(self.coat(mark.first), &at);
                if mark.share <= 0.0 || mark.second < 0.0 {
                    return first;
                }
                let second = colour(self.coat(mark.second), &at);
                std::array::from_fn(|k| first[k] + (second[k] - first[k]) * mark.share)
            })
            .collect()
    }

    /// The number of the scene's material that each face has most of, asked in its middle.
    pub(crate) fn materials(&self, points: &[[f32; 3]], faces: &[[u32; 3]]) -> Vec<u16> {
        let middles: Vec<[f32; 3]> = (faces.iter())
            .map(|f| f.map(|v| points[v as usize]))
            .map(|[a, b, c]| std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0))
            .collect();
        let (_, marks) = self.marks(&middles);
        let last = self.materials.len().saturating_sub(1) as u16;
        (marks.iter())
            .map(|mark| {
                let number = mark.first.max(0.0) as usize;
                let of_coat = || {
                    let coats = self.program.coats();
                    coats.get(number - self.materials.len()).map(|c| c.material)
                };
                let material = if number < self.materials.len() {
                    Some(number as u16)
                } else {
                    of_coat()
                };
                material.unwrap_or_default().min(last)
            })
            .collect()
    }
}

fn vector(v: [f32; 3]) -> Vec3<f32> {
    v3(v[0], v[1], v[2])
}
