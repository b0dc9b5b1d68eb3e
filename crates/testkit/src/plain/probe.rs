//! What the plain renderer asks of a field.

use fearless_simd::Level;
use glam::Vec3;
use zeroset_eval::{Point, Workspace};
use zeroset_field::program::Program;
use zeroset_number::{Dual, v3};

/// The marks of a surface. Numbers are whole, -1 where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Object.
    pub object: f32,
    /// The material that counts most.
    pub first: f32,
    /// The material that counts second.
    pub second: f32,
    /// Share of the second.
    pub share: f32,
    /// How near the orbit of a fractal came to its traps.
    pub orbit: [f32; 4],
}

/// Evaluates a field, one point at a time.
pub trait Probe {
    /// The value.
    fn value(&mut self, p: Vec3) -> f32;
    /// The gradient.
    fn gradient(&mut self, p: Vec3) -> Vec3;
    /// The marks.
    fn marks(&mut self, p: Vec3) -> Mark;
    /// The material that a mark stands for of a scene with `materials` of them, the point in the space that it lies in, and of each of its
    /// coordinates there the derivatives; nothing where that is the world.
    fn placed(
        &mut self,
        _mark: f32,
        _materials: usize,
        _p: Vec3,
    ) -> Option<(usize, Vec3, [Vec3; 3])> {
        None
    }
    /// From now on, whether values and gradients are those of the clear bodies alone, without the opaque ones in them. Where no scene
    /// with clear bodies is rendered there is nothing to do.
    fn enter(&mut self, _clear: bool) {}
}

/// A program, interpreted.
pub struct Compiled<'p> {
    program: &'p Program,
    values: Point<'p, f32>,
    gradients: Point<'p, Dual<f32>>,
    /// The clear bodies alone, and whether they are asked for.
    inside: Option<Program>,
    is_inside: bool,
    /// The only mark there is, or memory to find one.
    marks: Result<Mark, Box<Workspace>>,
}

impl<'p> Compiled<'p> {
    /// An evaluator of `program`. `only` is the mark of the whole surface, if it has no other.
    pub fn new(program: &'p Program, only: Option<Mark>) -> Self {
        Compiled {
            program,
            values: Point::new(program.values()),
            gradients: Point::new(program.values()),
            inside: program.inside(),
            is_inside: false,
            marks: only.ok_or_else(|| Box::new(Workspace::new(program.values(), program.marks()))),
        }
    }
}

impl Probe for Compiled<'_> {
    fn value(&mut self, p: Vec3) -> f32 {
        match &self.inside {
            Some(inside) if self.is_inside => {
                Point::<f32>::new(inside.values()).value(v3(p.x, p.y, p.z))
            }
            _ => self.values.value(v3(p.x, p.y, p.z)),
        }
    }

    fn enter(&mut self, clear: bool) {
        self.is_inside = clear;
    }

    fn placed(&mut self, mark: f32, materials: usize, p: Vec3) -> Option<(usize, Vec3, [Vec3; 3])> {
        let number = (mark >= 0.0).then_some(mark as usize)?;
        let coat = self.program.coats().get(number.checked_sub(materials)?)?;
        let mut places = Point::<Dual<f32>>::new(self.program.places());
        let at = places.place(Dual::point(v3(p.x, p.y, p.z)), coat.place);
        let point = Vec3::new(at.x.v, at.y.v, at.z.v);
        let rows = [at.x.d, at.y.d, at.z.d].map(Vec3::from);
        Some((usize::from(coat.material), point, rows))
    }

    fn gradient(&mut self, p: Vec3) -> Vec3 {
        if let Some(inside) = self.inside.as_ref().filter(|_| self.is_inside) {
            let mut gradients = Point::<Dual<f32>>::new(inside.values());
            return Vec3::from(gradients.value(Dual::point(v3(p.x, p.y, p.z))).d);
        }
        Vec3::from(self.gradients.value(Dual::point(v3(p.x, p.y, p.z))).d)
    }

    fn marks(&mut self, p: Vec3) -> Mark {
        let work = match &mut self.marks {
            Ok(mark) => return *mark,
            Err(work) => work,
        };
        let sided = self
            .is_inside
            .then(|| self.program.inside_marks())
            .flatten();
        let program = sided.as_ref().unwrap_or(self.program);
        for (lane, c) in work.points_mut().iter_mut().zip(p.to_array()) {
            lane.0.fill(c);
        }
        zeroset_number::at_level!(Level::new(), s => zeroset_eval::marks(s, program.marks(), work, 1));
        let m = work.marks();
        Mark {
            object: m.object.0[0],
            first: m.first.0[0],
            second: m.second.0[0],
            share: m.share.0[0],
            orbit: std::array::from_fn(|k| m.orbit[k].0[0]),
        }
    }
}

/// A function, with its gradient by central differences and one mark everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Formula<F>(pub F);

impl<F: Fn(Vec3) -> f32> Probe for Formula<F> {
    fn value(&mut self, p: Vec3) -> f32 {
        (self.0)(p)
    }

    fn gradient(&mut self, p: Vec3) -> Vec3 {
        let h = 1e-3 * p.abs().max_element().max(1e-3);
        let along = |axis: Vec3| ((self.0)(p + axis * h) - (self.0)(p - axis * h)) / (2.0 * h);
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z))
    }

    fn marks(&mut self, _p: Vec3) -> Mark {
        Mark {
            object: 0.0,
            first: 0.0,
            second: -1.0,
            share: 0.0,
            orbit: [0.0; 4],
        }
    }
}
