//! From the tree to the list: lowering, sharing, registers.

use crate::field::{Field, Node, Paint};
use crate::formula::{Binary, Formula, FormulaStep, Guide, Inner};
use crate::placement::Placement;
use crate::program::{Coat, CompileError, Limits, Program, Structure};
use crate::repetition::{Polar, Repetition};
use crate::sampled::Sampled;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::{PrimitiveEntry, catalogue};
use zeroset_catalogue::flat::strips;
use zeroset_catalogue::op::{code, reads_point};
use zeroset_catalogue::tape::{Code, Instruction, Operation};
use zeroset_catalogue::{Dimension, Stretch};
use zeroset_number::{Data, Grid};

/// Sides of a box that has none, as parameters: squares of it still fit single precision.
const FAR: f64 = 1e18;

/// How many times larger a guide may make a value that is too small.
const RAISED: f64 = 8.0;

mod colours;

pub(crate) use colours::{colour, with_colours};

/// A step before registers are assigned: operands are the numbers of earlier steps.
#[derive(Clone, Copy)]
struct Lowered {
    operation: Operation,
    a: u32,
    b: u32,
    at: u32,
}

impl Lowered {
    fn gives_point(&self) -> bool {
        matches!(self.operation, Operation::Warp(_) | Operation::Put(_))
    }
}

/// The step that is the point to evaluate at.
const INPUT: u32 = u32::MAX;

struct Lowering<'l> {
    steps: Vec<Lowered>,
    params: Vec<f32>,
    grids: Vec<Arc<Grid>>,
    /// See [`Structure::sides`].
    sides: Vec<u32>,
    /// Shared nodes: the value of a node at a point.
    known: HashMap<(usize, u32), u32>,
    limits: &'l Limits,
    /// Of each material, whether it depends on where it is.
    spatial: &'l [bool],
    /// Materials, and the points of the spaces that they lie in.
    coats: Vec<(u16, u32)>,
    /// Whether a value may need a division by its slope, by the kinds of nodes alone.
    steep: bool,
    /// The largest slope that a value is divided by.
    slope: f64,
    /// Whether guides make values of formulas about as large as distances.
    guided: bool,
}

pub(crate) fn compile(
    field: &Field,
    limits: &Limits,
    spatial: &[bool],
) -> Result<Program, CompileError> {
    if field.facts().dimension == Dimension::Two {
        return Err(CompileError::Flat);
    }
    compile_any(field, limits, spatial)
}

/// Compiles a field, be it a plane shape.
pub(crate) fn compile_any(
    field: &Field,
    limits: &Limits,
    spatial: &[bool],
) -> Result<Program, CompileError> {
    let program = lowered(field, limits, spatial, true)?;
    if !program.unbounded {
        return Ok(program);
    }
    let bare = lowered(field, limits, spatial, false)?;
    let is_guided = bare.structure != program.structure;
    Ok(Program {
        bare: is_guided.then(|| Arc::new(bare)),
        ..program
    })
}

/// Compiles a field, with or without [guides](Guide).
fn lowered(
    field: &Field,
    limits: &Limits,
    spatial: &[bool],
    guided: bool,
) -> Result<Program, CompileError> {
    let facts = field.facts();
    let mut l = Lowering::new(limits, spatial, guided);
    let value = l.field(field, INPUT)?;
    let result = l.unit(field, value)?;
    let (places, coats) = places(&l.steps, &l.coats)?;
    let structure = Structure {
        values: registers(&l.steps, &[result], false)?.0,
        marks: registers(&l.steps, &[result], true)?.0,
        sides: l.sides,
        places,
        coats,
        colours: Vec::new(),
    };
    Ok(Program {
        structure: Arc::new(structure),
        data: Arc::new(Data {
            params: l.params,
            grids: l.grids,
        }),
        bounds: facts.bounds,
        exactness: facts.exactness,
        steep: l.steep,
        slope: l.slope,
        unbounded: facts.unbounded,
        bare: None,
    })
}

impl<'l> Lowering<'l> {
    fn new(limits: &'l Limits, spatial: &'l [bool], guided: bool) -> Self {
        Lowering {
            steps: Vec::new(),
            params: Vec::new(),
            grids: Vec::new(),
            sides: Vec::new(),
            known: HashMap::new(),
            limits,
            spatial,
            coats: Vec::new(),
            steep: false,
            slope: 1.0,
            guided,
        }
    }

    fn emit(
        &mut self,
        operation: Operation,
        a: u32,
        b: u32,
        params: &[f64],
    ) -> Result<u32, CompileError> {
        if self.steps.len() >= self.limits.instructions {
            return Err(CompileError::Instructions {
                limit: self.limits.instructions,
            });
        }
        if self.params.len() + params.len() > self.limits.params {
            return Err(CompileError::Params {
                limit: self.limits.params,
            });
        }
        let at = self.params.len() as u32;
        self.params
            .extend(params.iter().map(|&x| x.clamp(-FAR, FAR) as f32));
        self.steps.push(Lowered {
            operation,
            a,
            b,
            at,
        });
        Ok(self.steps.len() as u32 - 1)
    }

    fn leaf(&mut self, code: u16, point: u32, params: &[f64]) -> Result<u32, CompileError> {
        self.emit(Operation::Leaf(code), point, point, params)
    }

    fn warp(&mut self, code: u16, point: u32, params: &[f64]) -> Result<u32, CompileError> {
        self.emit(Operation::Warp(code), point, point, params)
    }

    fn change(
        &mut self,
        code: u16,
        value: u32,
        point: u32,
        params: &[f64],
    ) -> Result<u32, CompileError> {
        // a point that is not read would keep its register up to here: one a step in a chain of moves and roundings
        let point = if reads_point(code) { point } else { INPUT };
        self.emit(Operation::Change(code), value, point, params)
    }

    fn pair(&mut self, code: u16, x: u32, y: u32, params: &[f64]) -> Result<u32, CompileError> {
        // an instruction needs operands in different registers
        let y = if x == y {
            self.change(code::SCALE, y, INPUT, &[1.0])?
        } else {
            y
        };
        self.emit(Operation::Pair(code), x, y, params)
    }

    /// The value of a field at a point, with the slope that its facts state.
    fn field(&mut self, field: &Field, point: u32) -> Result<u32, CompileError> {
        if let Some(&value) = self.known.get(&(field.key(), point)) {
            return Ok(value);
        }
        let value = match field.node() {
            Node::Primitive { entry, params } => self.primitive(entry, [0.0; 3], params, point)?,
            Node::Map {
                entry,
                params,
                shape,
            } => {
                let stretch = (entry.stretch)(params, &field.facts().bounds);
                if let Ok(Stretch::Within(within, _)) = stretch {
                    let sides = sides(&within);
                    let inside = self.warp(code::CLAMP, point, &sides)?;
                    let mapped = self.warp(entry.code, inside, params)?;
                    let value = self.field(shape, mapped)?;
                    let slope = [field.facts().slope];
                    self.change(code::CONTINUE, value, point, &[&sides[..], &slope].concat())?
                } else {
                    let mapped = self.warp(entry.code, point, params)?;
                    self.field(shape, mapped)?
                }
            }
            Node::Modify {
                entry,
                params,
                shape,
            } => {
                let value = self.field(shape, point)?;
                self.change(entry.code, value, point, params)?
            }
            Node::Join {
                entry,
                params,
                shapes,
            } => {
                let operand = &mut |l: &mut Self, k: usize| {
                    let value = l.field(&shapes[k], point)?;
                    if entry.sharp {
                        l.unit(&shapes[k], value)
                    } else {
                        Ok(value)
                    }
                };
                if entry.associative {
                    self.balanced(entry.code, 0..shapes.len(), operand)?
                } else {
                    let mut joined = operand(self, 0)?;
                    for k in 1..shapes.len() {
                        let value = operand(self, k)?;
                        joined = self.pair(entry.code, joined, value, params)?;
                    }
                    joined
                }
            }
            Node::Place { placement, shape } => self.place(placement, shape, point)?,
            Node::Repeat { repetition, shape } => self.repeat(repetition, shape, point)?,
            Node::Polar { polar, shape } => self.polar(polar, shape, point)?,
            Node::Formula(formula) => self.formula(formula, point)?,
            Node::Sampled(sampled) => self.sampled(sampled, point)?,
            Node::Paint { paint, shape } => {
                let value = self.field(shape, point)?;
                self.mark(*paint, value, point)?
            }
            Node::Sided(shape) => {
                let value = self.field(shape, point)?;
                self.sides.push(self.params.len() as u32);
                self.change(code::SCALE, value, INPUT, &[1.0])?
            }
        };
        self.known.insert((field.key(), point), value);
        Ok(value)
    }

    /// Joins operands by an associative operation without parameters, as a tree that is as low as can be. They stay in their order, so
    /// the last of equal values wins as it would one after the other.
    fn balanced(
        &mut self,
        code: u16,
        range: Range<usize>,
        operand: &mut dyn FnMut(&mut Self, usize) -> Result<u32, CompileError>,
    ) -> Result<u32, CompileError> {
        if range.len() == 1 {
            return operand(self, range.start);
        }
        let middle = range.start + range.len().div_ceil(2);
        let x = self.balanced(code, range.start..middle, operand)?;
        let y = self.balanced(code, middle..range.end, operand)?;
        self.pair(code, x, y, &[])
    }

    fn mark(&mut self, paint: Paint, value: u32, point: u32) -> Result<u32, CompileError> {
        let mark = match paint {
            Paint::Material(number) => Operation::Mark(0, self.coat(number, point)?),
            Paint::Object(number) => Operation::Mark(1, number),
        };
        self.emit(mark, value, INPUT, &[])
    }

    /// The number that marks a material at a point of its own space.
    fn coat(&mut self, material: u16, point: u32) -> Result<u16, CompileError> {
        let is_spatial = self.spatial.get(usize::from(material)) == Some(&true);
        if !is_spatial || point == INPUT {
            return Ok(material);
        }
        let known = self.coats.iter().position(|c| *c == (material, point));
        let coat = known.unwrap_or_else(|| {
            self.coats.push((material, point));
            self.coats.len() - 1
        });
        u16::try_from(self.spatial.len() + coat).map_err(|_| CompileError::Coats {
            limit: usize::from(u16::MAX) - self.spatial.len(),
        })
    }

    /// The value of a field, divided by its slope.
    fn unit(&mut self, field: &Field, value: u32) -> Result<u32, CompileError> {
        let facts = field.facts();
        if !facts.steep {
            return Ok(value);
        }
        self.steep = true;
        // that of what has none says how values are scaled, and nothing of how far they are from distances
        if !facts.unbounded {
            self.slope = self.slope.max(facts.slope);
        }
        // a hair less, for the rounding to single precision
        let scale = if facts.slope > 0.0 {
            (1.0 - 1e-6) / facts.slope
        } else {
            1.0
        };
        self.change(code::SCALE, value, INPUT, &[scale])
    }

    /// A primitive around a centre. Contours of many pieces become trees of them, with the same distances.
    fn primitive(
        &mut self,
        entry: &PrimitiveEntry,
        centre: [f64; 3],
        params: &[f64],
        point: u32,
    ) -> Result<u32, CompileError> {
        match strips(entry.info.name, params) {
            Some(trees) => self.leaf(code::STRIPS, point, &centred(centre, &trees)),
            None => self.leaf(entry.code, point, &centred(centre, params)),
        }
    }

    fn place(
        &mut self,
        placement: &Placement,
        shape: &Field,
        point: u32,
    ) -> Result<u32, CompileError> {
        let mut value = match shape.node() {
            _ if placement.turns || placement.scales => {
                let placed = self.warp(code::RIGID, point, &inverse(placement))?;
                self.field(shape, placed)?
            }
            Node::Primitive { entry, params } => {
                self.primitive(entry, placement.offset, params, point)?
            }
            _ => {
                let placed = self.warp(code::OFFSET, point, &placement.offset)?;
                self.field(shape, placed)?
            }
        };
        if placement.scales {
            value = self.change(code::SCALE, value, INPUT, &[placement.scale])?;
        }
        Ok(value)
    }

    /// The value of a repeated shape: at least the distance to its box, which the walls of repetitions count on. (A distance
    /// bound may be less, and would jump where the copy enters the search.)
    fn copy(&mut self, shape: &Field, cell: u32) -> Result<u32, CompileError> {
        let value = self.field(shape, cell)?;
        let value = self.unit(shape, value)?;
        let facts = shape.facts();
        if facts.exactness <= Exactness::Outside || facts.bounds.is_empty() {
            return Ok(value);
        }
        let cuboid = catalogue()
            .primitive("box")
            .expect("the catalogue has a box");
        let sides = facts.bounds.half().map(|h| (2.0 * h).min(FAR));
        let params = centred(facts.bounds.centre(), &sides);
        let around = self.leaf(cuboid.code, cell, &params)?;
        self.pair(code::binary(Binary::Max), value, around, &[])
    }

    fn repeat(
        &mut self,
        repetition: &Repetition,
        shape: &Field,
        point: u32,
    ) -> Result<u32, CompileError> {
        let bounds = shape.facts().bounds;
        let grid = grid(repetition);
        let on: [bool; 3] = std::array::from_fn(|k| repetition.repeats(k));
        let bit = |copy: usize, k: usize| copy >> k & 1;
        let copies: Vec<usize> = (0..8)
            .filter(|&copy| (0..3).all(|k| on[k] || bit(copy, k) == 0))
            .collect();
        let seed = [f64::from(repetition.seed % 289)];
        let nearest = self.balanced(code::MIN, 0..copies.len(), &mut |l, i| {
            let bits: [f64; 3] = std::array::from_fn(|k| bit(copies[i], k) as f64);
            let params = [&bits[..], &repetition.vary, &seed, &grid].concat();
            let cell = l.warp(code::REPEAT_CELL, point, &params)?;
            l.copy(shape, cell)
        })?;
        let (low, high): (Vec<f64>, Vec<f64>) =
            (0..3).map(|k| repetition.extent(&bounds, k)).unzip();
        self.change(
            code::REPEAT_WALL,
            nearest,
            point,
            &[low, high, grid].concat(),
        )
    }

    fn polar(&mut self, polar: &Polar, shape: &Field, point: u32) -> Result<u32, CompileError> {
        let mut bounds = shape.facts().bounds;
        // a plane shape's copies go around z: as around y, with y and z exchanged before and after
        let plane = shape.facts().dimension == Dimension::Two;
        let upright = inverse(&Placement::UPRIGHT);
        if plane {
            bounds = Polar::upright(&bounds);
        }
        let narrow = polar.is_narrow(&bounds);
        let around = if plane && narrow {
            self.warp(code::RIGID, point, &upright)?
        } else {
            point
        };
        let copies = if narrow { 2 } else { polar.count as usize };
        let nearest = self.balanced(code::MIN, 0..copies, &mut |l, copy| {
            let cell = if narrow {
                let params = [copy as f64, polar.sector()];
                let cell = l.warp(code::POLAR_CELL, around, &params)?;
                if plane {
                    l.warp(code::RIGID, cell, &upright)?
                } else {
                    cell
                }
            } else {
                let axis = if plane {
                    [0.0, 0.0, 1.0]
                } else {
                    [0.0, 1.0, 0.0]
                };
                let turn = Placement::turned(axis, -(copy as f64) * polar.sector());
                l.warp(code::RIGID, point, &inverse(&turn))?
            };
            l.copy(shape, cell)
        })?;
        let Some((low, high)) = Polar::angles(&bounds).filter(|_| narrow) else {
            return Ok(nearest);
        };
        let inner = bounds.min[0].hypot(bounds.min[2].max(-bounds.max[2]).max(0.0));
        let wall = [
            polar.sector(),
            low,
            high,
            inner,
            bounds.min[1],
            bounds.max[1],
        ];
        self.change(code::POLAR_WALL, nearest, around, &wall)
    }

    fn formula(&mut self, formula: &Formula, point: u32) -> Result<u32, CompileError> {
        let sides = sides(&formula.bounds());
        let inside = self.warp(code::CLAMP, point, &sides)?;
        let values = self.formula_steps(formula.steps(), formula.fields(), inside)?;
        let value = values
            .last()
            .copied()
            .expect("Formula refuses formulas of nothing");
        let value = self.change(
            code::CONTINUE,
            value,
            point,
            &[&sides[..], &[formula.slope()]].concat(),
        )?;
        match formula.guide().filter(|_| self.guided) {
            Some(guide) => self.guided(guide, formula.slope(), value, point),
            None => Ok(value),
        }
    }

    /// The values of all steps of a formula at a point.
    fn formula_steps(
        &mut self,
        steps: &[FormulaStep],
        fields: &[Inner],
        inside: u32,
    ) -> Result<Vec<u32>, CompileError> {
        let mut values: Vec<u32> = Vec::with_capacity(steps.len());
        // values that depend on a painted field, whose marks they keep
        let mut painted: Vec<bool> = Vec::with_capacity(steps.len());
        for step in steps {
            let depends = step.operands().any(|i| painted[i as usize]);
            painted.push(match *step {
                FormulaStep::Field(i, _) => fields[i as usize].field().facts().materials > 0,
                _ => depends,
            });
            values.push(match *step {
                FormulaStep::Coordinate(k) => {
                    self.leaf(code::COORDINATE + u16::from(k), inside, &[])?
                }
                FormulaStep::Constant(c) => self.leaf(code::CONSTANT, inside, &[c])?,
                FormulaStep::Unary(f, x) => {
                    self.change(code::unary(f), values[x as usize], inside, &[])?
                }
                FormulaStep::Binary(f, x, y) => {
                    let value =
                        self.pair(code::binary(f), values[x as usize], values[y as usize], &[])?;
                    match (painted[x as usize], painted[y as usize]) {
                        (true, false) => self.replaced(values[x as usize], value, inside)?,
                        (false, true) => self.replaced(values[y as usize], value, inside)?,
                        _ => value,
                    }
                }
                FormulaStep::Noise(kind, q) => {
                    let q = self.point(steps, q, &values, inside)?;
                    self.leaf(code::noise(kind), q, &[])?
                }
                FormulaStep::Field(i, q) => {
                    let q = self.point(steps, q, &values, inside)?;
                    self.field(fields[i as usize].field(), q)?
                }
            });
        }
        Ok(values)
    }

    /// A value whose sign is right, made about as large as the distance: no larger than what a guide and its slack leave open, and no smaller as
    /// long as that is not [`RAISED`] times as much. Its sign stays, whatever the guide says; so does its zero set.
    fn guided(
        &mut self,
        guide: &Guide,
        slope: f64,
        value: u32,
        point: u32,
    ) -> Result<u32, CompileError> {
        let [min, max] = [Binary::Min, Binary::Max].map(code::binary);
        let distance = self.grid_of(&guide.distances, point, 1.0)?;
        let distance = self.change(code::SCALE, distance, INPUT, &[slope])?;
        let slack = self.leaf(code::CONSTANT, point, &[slope * guide.slack])?;
        let below = self.leaf(code::CONSTANT, point, &[-slope * guide.slack])?;
        let low = self.pair(code::binary(Binary::Add), distance, below, &[])?;
        let high = self.pair(code::binary(Binary::Add), distance, slack, &[])?;
        // raised where it is small far away, on either side
        let raised = self.change(code::SCALE, value, INPUT, &[RAISED])?;
        let raised = self.pair(min, low, raised, &[])?;
        let value = self.pair(max, value, raised, &[])?;
        let raised = self.change(code::SCALE, value, INPUT, &[RAISED])?;
        let raised = self.pair(max, high, raised, &[])?;
        let value = self.pair(min, value, raised, &[])?;
        // and no larger than it can be
        let low = self.pair(min, low, below, &[])?;
        let high = self.pair(max, high, slack, &[])?;
        let value = self.pair(max, value, low, &[])?;
        self.pair(min, value, high, &[])
    }

    /// The point that three steps of a formula are; `inside` is where the formula is evaluated.
    fn point(
        &mut self,
        steps: &[FormulaStep],
        q: [u32; 3],
        values: &[u32],
        inside: u32,
    ) -> Result<u32, CompileError> {
        let mut point = inside;
        for (k, step) in (0..3).zip(q) {
            if steps[step as usize] != FormulaStep::Coordinate(k as u8) {
                let value = values[step as usize];
                point = self.emit(Operation::Put(k), value, point, &[])?;
            }
        }
        Ok(point)
    }

    /// A value with the marks of another one.
    fn replaced(&mut self, marked: u32, value: u32, inside: u32) -> Result<u32, CompileError> {
        let point = self.emit(Operation::Put(0), value, inside, &[])?;
        self.change(code::REPLACED, marked, point, &[])
    }

    fn sampled(&mut self, sampled: &Sampled, point: u32) -> Result<u32, CompileError> {
        self.grid_of(sampled, point, sampled.slope())
    }

    /// Samples, continued beyond their box with a slope.
    fn grid_of(&mut self, sampled: &Sampled, point: u32, slope: f64) -> Result<u32, CompileError> {
        let (sides, grid) = (sides(&sampled.bounds()), sampled.grid());
        let number = match self.grids.iter().position(|g| Arc::ptr_eq(g, grid)) {
            Some(number) => number,
            None => {
                self.grids.push(Arc::clone(grid));
                self.grids.len() - 1
            }
        };
        let place = [sampled.bounds().min, sampled.density()].concat();
        let nodes = grid.nodes().map(f64::from);
        let params = [&place[..], &[number as f64], &nodes].concat();
        let inside = self.warp(code::CLAMP, point, &sides)?;
        let value = self.leaf(code::SAMPLED, inside, &params)?;
        self.change(
            code::CONTINUE,
            value,
            point,
            &[&sides[..], &[slope]].concat(),
        )
    }
}

/// A primitive's parameters behind its centre.
fn centred(centre: [f64; 3], params: &[f64]) -> Vec<f64> {
    [&centre[..], params].concat()
}

fn sides(b: &Aabb) -> [f64; 6] {
    [b.min[0], b.min[1], b.min[2], b.max[0], b.max[1], b.max[2]]
}

/// Rows and offset of the motion from where a shape is seen to its own space.
fn inverse(placement: &Placement) -> [f64; 12] {
    let mut m = [0.0; 12];
    let origin = placement.invert([0.0; 3]);
    for i in 0..3 {
        for k in 0..3 {
            m[3 * i + k] = placement.rotation[k][i] / placement.scale;
        }
        m[9 + i] = origin[i];
    }
    m
}

/// The grid of a repetition as [`RepeatCell`](zeroset_catalogue::op::domain::RepeatCell) takes it.
fn grid(r: &Repetition) -> Vec<f64> {
    // cells without end: as many as single precision tells apart
    let endless = 4_000_000.0;
    let count = |k: usize| f64::from(r.count[k]);
    let axis = |k: usize| {
        if !r.repeats(k) {
            [0.0, 1.0, 0.0, 0.0, 1.0]
        } else if r.count[k] == 0 {
            [1.0, r.spacing[k], 0.0, -endless, endless]
        } else {
            let shift = if r.count[k].is_multiple_of(2) {
                0.5
            } else {
                0.0
            };
            let first = -(count(k) / 2.0).floor();
            [1.0, r.spacing[k], shift, first, first + count(k) - 1.0]
        }
    };
    let axes = [axis(0), axis(1), axis(2)];
    (0..5).flat_map(|i| axes.map(|a| a[i])).collect()
}

/// What leads to the spaces of coats.
fn places(steps: &[Lowered], coats: &[(u16, u32)]) -> Result<(Code, Vec<Coat>), CompileError> {
    let points: Vec<u32> = coats.iter().map(|(_, point)| *point).collect();
    let (code, places) = registers(steps, &points, false)?;
    let coats = (coats.iter().zip(places))
        .map(|(&(material, _), place)| Coat { material, place })
        .collect();
    Ok((code, coats))
}

/// Keeps what the results need and gives every value a register, the same one to values that are never needed together. The registers of the
/// results come with the code, whose result is the last of them.
fn registers(
    steps: &[Lowered],
    results: &[u32],
    marks: bool,
) -> Result<(Code, Vec<u16>), CompileError> {
    // without marks, a mark is the value that it marks
    let mut same: Vec<u32> = (0..steps.len() as u32).collect();
    if !marks {
        for (i, step) in steps.iter().enumerate() {
            if matches!(step.operation, Operation::Mark(..)) {
                same[i] = same[step.a as usize];
            }
        }
    }
    let actual = |i: u32| if i == INPUT { INPUT } else { same[i as usize] };
    let results: Vec<u32> = results.iter().map(|&result| actual(result)).collect();
    let operands = |step: &Lowered| [actual(step.a), actual(step.b)];

    let mut last_use = vec![None; steps.len()];
    for &result in results.iter().filter(|r| **r != INPUT) {
        last_use[result as usize] = Some(steps.len());
    }
    for (i, step) in steps.iter().enumerate().rev() {
        if last_use[i].is_some() {
            for operand in operands(step) {
                if operand != INPUT && last_use[operand as usize].is_none() {
                    last_use[operand as usize] = Some(i);
                }
            }
        }
    }

    // slots: points and values apart, numbered from zero
    let mut slot = vec![0_usize; steps.len()];
    let mut free: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
    let mut used = [0_usize; 2];
    for (i, step) in steps.iter().enumerate() {
        if last_use[i].is_none() {
            continue;
        }
        let kind = usize::from(step.gives_point());
        slot[i] = free[kind].pop().unwrap_or_else(|| {
            used[kind] += 1;
            used[kind] - 1
        });
        let [a, b] = operands(step);
        for operand in [Some(a), (a != b).then_some(b)].into_iter().flatten() {
            if operand != INPUT && last_use[operand as usize] == Some(i) {
                free[usize::from(steps[operand as usize].gives_point())]
                    .push(slot[operand as usize]);
            }
        }
    }

    let points = 3 * (used[1] + 1);
    let needed = points + used[0];
    let limit = usize::from(u16::MAX) / 4;
    if needed > limit {
        return Err(CompileError::Registers { needed, limit });
    }
    let number = |i: u32| match i {
        INPUT => 0,
        i if steps[i as usize].gives_point() => 3 * (slot[i as usize] + 1),
        i => points + slot[i as usize],
    } as u16;
    let instructions = (steps.iter().enumerate())
        .filter(|(i, _)| last_use[*i].is_some())
        .map(|(i, step)| {
            let [a, b] = operands(step).map(number);
            Instruction {
                operation: step.operation,
                out: number(i as u32),
                a,
                b,
                at: step.at,
            }
        })
        .collect();
    let results: Vec<u16> = results.into_iter().map(number).collect();
    let code = Code {
        instructions,
        registers: needed as u16,
        result: results.last().copied().unwrap_or(0),
    };
    Ok((code, results))
}
