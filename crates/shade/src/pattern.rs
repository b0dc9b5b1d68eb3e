//! What colour a surface has where: patterns, averaged over the footprint of a pixel.

use crate::light::luminance_of;
use crate::sampling::basis;
use crate::{each, parameters};
use fearless_simd::{Level, Simd, prelude::*};
use std::cell::RefCell;
use zeroset_catalogue::noise::gradient_noise;
use zeroset_catalogue::tape::{Code, Tape};
use zeroset_eval::Workspace;
use zeroset_field::formula::ColourFormula;
use zeroset_number::{Data, Lanes, Ops, Real, Vec2, Vec3, v2, v3};
use zeroset_scene::material::{Image, Ink, Pattern};

/// A place on a surface, as far as its colour depends on it.
#[derive(Clone, Copy, Debug)]
pub struct Place<R> {
    /// Where it is.
    pub point: Vec3<R>,
    /// The unit normal.
    pub normal: Vec3<R>,
    /// How wide a pixel is there, across the ray.
    pub width: R,
    /// How much longer than wide a pixel is on the surface, along the view.
    pub stretch: Vec3<R>,
    /// How near the orbit of a fractal came to its traps.
    pub orbit: [R; 4],
}

impl<R: Real> Place<R> {
    /// The place where a ray of direction `d` and width `pixel` meets a surface.
    #[inline(always)]
    pub fn new(point: Vec3<R>, normal: Vec3<R>, d: Vec3<R>, pixel: R) -> Self {
        Place {
            point,
            normal,
            width: pixel,
            stretch: stretch(normal, d, pixel),
            orbit: [pixel.lit(0.0); 4],
        }
    }

    /// The same place with the orbit of a fractal.
    #[inline(always)]
    pub fn with_orbit(self, orbit: [R; 4]) -> Self {
        Place { orbit, ..self }
    }

    /// How far the point moves along each axis from one ray to the next, at most.
    #[inline(always)]
    pub fn footprint(&self) -> Vec3<R> {
        footprint(self.normal, self.width, self.stretch)
    }

    /// The same place in another space, in which it is at `point`. `rows` say how that changes with where it is: of each of its
    /// coordinates the derivatives.
    #[inline(always)]
    pub fn mapped(self, point: Vec3<R>, rows: [Vec3<R>; 3]) -> Self {
        let rows = rows.map(
            #[inline(always)]
            |row| tame(row),
        );
        Place {
            point,
            normal: mapped_normal(self.normal, rows),
            width: self.width * mapped_scale(rows),
            stretch: times(rows, self.stretch),
            orbit: self.orbit,
        }
    }
}

/// Derivatives that are numbers: a map may have none at a place, and what has no end says nothing of how wide a pixel is.
#[inline(always)]
pub fn tame<R: Real>(row: Vec3<R>) -> Vec3<R> {
    row.map(
        #[inline(always)]
        |x| R::choose(x.abs().below(STEEPEST_MAP), x, x.lit(0.0)),
    )
}

/// The largest derivative of a map that counts.
const STEEPEST_MAP: f32 = 1e12;

/// The product of a matrix of these rows with a vector.
#[inline(always)]
pub fn times<R: Real>(rows: [Vec3<R>; 3], v: Vec3<R>) -> Vec3<R> {
    each(
        #[inline(always)]
        |k| rows[k].dot(v),
    )
}

/// The unit normal of a surface after a map whose derivatives these are: planes go by the cofactors of the matrix.
#[inline(always)]
pub fn mapped_normal<R: Real>(normal: Vec3<R>, rows: [Vec3<R>; 3]) -> Vec3<R> {
    let [x, y, z] = rows;
    let cofactors = [y.cross(z), z.cross(x), x.cross(y)];
    let turned = times(cofactors, normal);
    let length = turned.length();
    // a mirror turns the cofactors' side
    let side = R::choose(
        x.dot(cofactors[0]).negative(),
        length.lit(-1.0),
        length.lit(1.0),
    );
    let known = length.above(f32::MIN_POSITIVE);
    let mapped = turned * (side / length.max(f32::MIN_POSITIVE));
    let (n, m) = (normal.array(), mapped.array());
    each(
        #[inline(always)]
        |k| R::choose(known, m[k], n[k]),
    )
}

/// How much longer than before lengths are after a map, in the mean over all directions.
#[inline(always)]
pub fn mapped_scale<R: Real>([x, y, z]: [Vec3<R>; 3]) -> R {
    ((x.length_squared() + y.length_squared() + z.length_squared()) * (1.0 / 3.0)).sqrt()
}

/// How much longer than wide a pixel is on a surface, along the view: longer by the cosine.
#[inline(always)]
pub fn stretch<R: Real>(normal: Vec3<R>, d: Vec3<R>, pixel: R) -> Vec3<R> {
    let facing = normal.dot(d);
    let cosine = facing.abs().max(0.05);
    let along = d - normal * facing;
    let along = along / along.length().max(1e-6);
    along * ((cosine.recip() - 1.0) * pixel)
}

/// How far the point moves along each axis from one ray to the next, at most: a pixel is an ellipse on the surface, as wide as the ray
/// across, and longer along the view.
#[inline(always)]
pub fn footprint<R: Real>(normal: Vec3<R>, width: R, stretch: Vec3<R>) -> Vec3<R> {
    let (n, along) = (normal.array(), stretch.array());
    each(
        #[inline(always)]
        |k| width * n[k].sq().one_minus().max(0.0).sqrt() + along[k].abs(),
    )
}

/// Share of a feature's size that a point is moved into the surface: the faces of solids like to lie on the borders of
/// cubes and bands.
const INWARDS: f32 = 1e-3;

/// Distance to an orbit trap within which nearer makes little difference.
const TRAP: f32 = 0.08;

/// Most octaves of noise.
pub const OCTAVES: u32 = 8;

/// Cubes of side `size`: the share of the second of two inks.
#[inline(always)]
pub fn checker<R: Real>(at: &Place<R>, size: R::Scalar) -> R {
    let p = (at.point - at.normal * (size * INWARDS)) / size;
    let w = at.footprint() / size;
    let even = square_wave(p.x, w.x) * square_wave(p.y, w.y) * square_wave(p.z, w.z);
    even * 0.5 + 0.5
}

/// Bands across a `direction`, as wide as `size`: the share of the second of two inks.
#[inline(always)]
pub fn stripes<R: Real>(at: &Place<R>, direction: Vec3<R::Scalar>, size: R::Scalar) -> R {
    let p = (at.point - at.normal * (size * INWARDS)).dot(direction) / size;
    let w = at.footprint().dot(direction.abs()) / size;
    square_wave(p, w) * 0.5 + 0.5
}

/// Fractal noise as the share of the second of two inks: `octaves` of gradient noise (at least 1, at most [`OCTAVES`]), each of half the size and
/// half the strength of the one before. Features finer than a pixel fade to their mean, which is zero.
#[inline(always)]
pub fn noise<R: Real>(at: &Place<R>, size: R::Scalar, octaves: R::Scalar) -> R {
    let x = at.point.x;
    let octaves = octaves.max(1.0);
    let first = (
        x.lit(0.0),
        at.point / size,
        at.footprint().length() / size,
        x.lit(1.0),
        x.lit(0.0),
        x.lit(0.0),
    );
    let (sum, _, _, _, total, _) = R::repeat_while(
        R::constant(f64::from(OCTAVES)),
        first,
        #[inline(always)]
        |(_, _, _, _, _, octave): (R, Vec3<R>, R, R, R, R)| octave.below(octaves),
        #[inline(always)]
        |(sum, p, w, share, total, octave)| {
            let seen = (w * 2.0).one_minus().clamp01();
            let sum = sum + gradient_noise(p) * seen * share;
            // turned and moved, so that the lattices of the octaves do not meet
            let turned = v3(p.y * 0.8 + p.z * 0.6, p.x, p.y * 0.6 - p.z * 0.8) * 2.0;
            let p = v3(turned.x + 0.37, turned.y + 0.61, turned.z + (octave + 0.13));
            (sum, p, w * 2.0, share * 0.5, total + share, octave + 1.0)
        },
    );
    (sum * (x.lit(0.8) / total) + 0.5).clamp01()
}

/// From one of two inks to the other between two points: the share of the second.
#[inline(always)]
pub fn gradient<R: Real>(at: &Place<R>, from: Vec3<R::Scalar>, to: Vec3<R::Scalar>) -> R {
    let way = to - from;
    let t = (at.point - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
    t.clamp01()
}

/// Shares of four inks by the orbit of a fractal: the nearer a trap, the more its ink counts.
#[inline(always)]
pub fn orbit<R: Real>(at: &Place<R>) -> [R; 4] {
    let mut weights = at.orbit;
    for weight in &mut weights {
        *weight = (weight.sq() + TRAP * TRAP).recip();
    }
    let total = weights[0] + weights[1] + weights[2] + weights[3];
    for weight in &mut weights {
        *weight = *weight / total;
    }
    weights
}

/// The normal of a surface with heights that rise by `rise` along two directions, which are at right angles to it and each other (Blinn
/// 1978). What is seen from direction `d` stays in sight.
#[inline(always)]
pub fn bumped<R: Real>(normal: Vec3<R>, across: [Vec3<R>; 2], rise: [R; 2], d: Vec3<R>) -> Vec3<R> {
    let [a, b] = rise.map(
        #[inline(always)]
        |rise| rise.clamp(-STEEPEST_BUMP, STEEPEST_BUMP),
    );
    let turned = normal - across[0] * a - across[1] * b;
    let turned = turned / turned.length();
    // what would face away is seen edge-on, nearly
    let away = (turned.dot(d) + GRAZING).max(0.0);
    let turned = turned - d * away;
    turned / turned.length()
}

/// The steepest that a height is taken for: the square of what is steeper may be no number.
const STEEPEST_BUMP: f32 = 1e6;

/// Cosine at which bumps are seen at least.
const GRAZING: f32 = 0.02;

/// Share of its finest feature over which the slope of a height is taken, at least.
pub const BUMP_STEP: f32 = 0.05;

/// Projections that weigh less than this are left out.
pub const LEAST_WEIGHT: f32 = 1e-4;

/// How much the projections of an image along the three axes count, not yet divided by their sum. Relative to the largest part
/// of the normal: high powers of all three may be too small for a number.
#[inline(always)]
pub fn projection_weights<R: Real>(normal: Vec3<R>, sharpness: R::Scalar) -> Vec3<R> {
    let n = normal.abs();
    let steepest = n.x.max(n.y).max(n.z).max(f32::MIN_POSITIVE);
    n.map(
        #[inline(always)]
        |c| (c / steepest).powf(sharpness),
    )
}

/// Where in the image a point lies, projected along an axis (0, 1 or 2): across and down, as they are seen from outside.
#[inline(always)]
pub fn projection<R: Real>(p: Vec3<R>, normal: Vec3<R>, axis: R, size: R::Scalar) -> Vec2<R> {
    let side = normal.map(
        #[inline(always)]
        |c| R::choose(c.negative(), c.lit(-1.0), c.lit(1.0)),
    );
    let (second, third) = (axis.above(0.5), axis.above(1.5));
    let u = R::choose(second, p.x, -p.z * side.x);
    let u = R::choose(third, p.x * side.z, u);
    let v = R::choose(second & !third, p.z * side.y, -p.y);
    v2(u / size, v / size)
}

/// 1 in even cells of size 1 and -1 in odd ones, averaged over `w` around `x` (the difference of two values of its integral,
/// a triangle wave).
#[inline(always)]
fn square_wave<R: Real>(x: R, w: R) -> R {
    let w = w.max(1e-4);
    let mean = (triangle_wave(x - w * 0.5) - triangle_wave(x + w * 0.5)) * 2.0 / w;
    mean.clamp(-1.0, 1.0)
}

#[inline(always)]
fn triangle_wave<R: Real>(x: R) -> R {
    ((x * 0.5).fract() - 0.5).abs()
}

/// Numbers of which each can be treated on its own.
pub trait PerLane: Real<Scalar = f32> {
    /// `f` of every lane.
    fn each(
        point: Vec3<Self>,
        normal: Vec3<Self>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<Self>;

    /// Red, green and blue of a formula, as it gives them.
    fn formula(point: Vec3<Self>, formula: &ColourFormula) -> Vec3<Self>;
}

/// The most numbers that are treated at once.
const WIDEST: usize = 16;

thread_local! {
    /// Registers of formulas.
    static REGISTERS: RefCell<Workspace> = {
        let code = Code { instructions: Vec::new(), registers: 3, result: 0 };
        let tape = Tape { code: &code, data: &Data::default() };
        RefCell::new(Workspace::new(tape, tape))
    };
}

/// What a formula gives at points, a row for each coordinate, written over them.
fn run_formula(formula: &ColourFormula, rows: &mut [[f32; WIDEST]; 3]) {
    let tape = formula.tape();
    REGISTERS.with_borrow_mut(|work| {
        work.make_room(tape);
        for (lane, row) in work.points_mut().iter_mut().zip(&*rows) {
            lane.0[..WIDEST].copy_from_slice(row);
        }
        zeroset_number::at_level!(Level::new(), s => zeroset_eval::values(s, tape, work, WIDEST));
        for (lane, row) in work.points().iter().zip(rows) {
            row.copy_from_slice(&lane.0[..WIDEST]);
        }
    });
}

/// What is shown of a formula, as a colour or as a height. Where it has no value, that is magenta.
#[inline(always)]
pub(crate) fn formula_shown<R: PerLane>(
    formula: &ColourFormula,
    point: Vec3<R>,
    heights: bool,
) -> Vec3<R> {
    let seen = R::formula(point, formula);
    let [x, y, z] = seen.array().map(
        #[inline(always)]
        |c| c.abs().below(LARGEST_VALUE),
    );
    let known = x & y & z;
    let (low, high) = if heights {
        (-HIGHEST, HIGHEST)
    } else {
        (0.0, 1.0)
    };
    let (seen, unknown) = (seen.array(), UNKNOWN);
    each(
        #[inline(always)]
        |k| R::choose(known, seen[k], seen[k].lit(unknown[k])).clamp(low, high),
    )
}

/// What is shown where a formula has no value.
pub const UNKNOWN: [f32; 3] = [1.0, 0.0, 1.0];

/// Values of formulas from here on are none: infinity is one of them.
pub const LARGEST_VALUE: f32 = 1e30;

/// The largest height.
pub const HIGHEST: f32 = 1e6;

/// How fine the details of a formula are taken to be for the slopes of its heights, scene units: with [`BUMP_STEP`], the least step over
/// which single precision still sees a slope.
const FORMULA_DETAIL: f32 = 2e-3;

impl PerLane for f32 {
    #[inline(always)]
    fn each(
        point: Vec3<f32>,
        normal: Vec3<f32>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<f32> {
        let c = f(point.array(), normal.array());
        v3(c[0], c[1], c[2])
    }

    fn formula(point: Vec3<f32>, formula: &ColourFormula) -> Vec3<f32> {
        let mut rows = point.array().map(|x| [x; WIDEST]);
        run_formula(formula, &mut rows);
        v3(rows[0][0], rows[1][0], rows[2][0])
    }
}

impl<S: Simd> PerLane for Lanes<S> {
    #[inline(always)]
    fn each(
        point: Vec3<Self>,
        normal: Vec3<Self>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<Self> {
        let mut out = Vec3::splat(point.x.lit(0.0));
        let (p, n) = (point.array(), normal.array());
        for i in 0..S::f32s::LEN {
            let c = f(
                [p[0].0[i], p[1].0[i], p[2].0[i]],
                [n[0].0[i], n[1].0[i], n[2].0[i]],
            );
            (out.x.0[i], out.y.0[i], out.z.0[i]) = (c[0], c[1], c[2]);
        }
        out
    }

    #[inline(always)]
    fn formula(point: Vec3<Self>, formula: &ColourFormula) -> Vec3<Self> {
        let mut rows = [[0.0; WIDEST]; 3];
        for (row, x) in rows.iter_mut().zip(point.array()) {
            let (first, rest) = row.split_at_mut(S::f32s::LEN);
            x.0.store_slice(first);
            rest.fill(first[0]);
        }
        run_formula(formula, &mut rows);
        let mut out = point;
        for i in 0..S::f32s::LEN {
            (out.x.0[i], out.y.0[i], out.z.0[i]) = (rows[0][i], rows[1][i], rows[2][i]);
        }
        out
    }
}

/// A pattern, flattened: parts, each before those that it shows. Asked as it is asked at a million places.
#[derive(Clone, Debug)]
pub struct Texture {
    parts: Vec<Part>,
    /// Size of the finest thing to be seen on it.
    finest: f32,
}

/// A part of a texture.
#[derive(Clone, Debug)]
pub struct Part {
    /// What it is; its inks are not looked at.
    pub pattern: Pattern,
    /// What its inks are.
    pub inks: [PartInk; 4],
    /// Where it lies, if not where the whole texture does.
    pub frame: Option<Frame>,
}

/// What a part shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PartInk {
    /// A colour.
    Colour(glam::Vec3),
    /// Another part, by number.
    Part(usize),
}

/// From a point of a texture to one of a part of it: the product with the rows, and the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Rows of the matrix.
    pub rows: [glam::Vec3; 3],
    /// Added to the product.
    pub offset: glam::Vec3,
}

impl Frame {
    const NONE: Frame = Frame {
        rows: [glam::Vec3::X, glam::Vec3::Y, glam::Vec3::Z],
        offset: glam::Vec3::ZERO,
    };

    /// This map, and then another.
    fn then(&self, rows: &[glam::Vec3; 3], offset: glam::Vec3) -> Frame {
        let columns = [0, 1, 2].map(|k| glam::Vec3::from(self.rows.map(|row| row[k])));
        let product = rows.map(|row| glam::Vec3::from(columns.map(|column| row.dot(column))));
        let moved = glam::Vec3::from(rows.map(|row| row.dot(self.offset)));
        Frame {
            rows: product,
            offset: moved + offset,
        }
    }
}

impl Texture {
    /// Of a pattern.
    pub fn new(pattern: &Pattern) -> Texture {
        let mut texture = Texture {
            parts: Vec::new(),
            finest: f32::INFINITY,
        };
        texture.push(pattern, Frame::NONE);
        texture
    }

    /// Its parts. The first is what it shows.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Whether it is one colour.
    pub fn is_solid(&self) -> bool {
        matches!(
            self.parts[..],
            [Part {
                pattern: Pattern::Solid { .. },
                ..
            }]
        )
    }

    /// Size of the finest thing to be seen on it; infinite where it is one colour.
    pub fn finest(&self) -> f32 {
        self.finest
    }

    fn push(&mut self, pattern: &Pattern, frame: Frame) -> usize {
        if let Pattern::Placed {
            pattern,
            rows,
            offset,
        } = pattern
        {
            return self.push(pattern, frame.then(rows, *offset));
        }
        let finest = match pattern {
            Pattern::Checker { size, .. } | Pattern::Stripes { size, .. } => *size,
            Pattern::Noise { size, octaves, .. } => *size / (*octaves as f32 - 1.0).exp2(),
            Pattern::Gradient { from, to, .. } => from.distance(*to),
            Pattern::Triplanar { size, image, .. } => {
                *size / image.width.max(image.height).max(1) as f32
            }
            Pattern::Formula { .. } => FORMULA_DETAIL,
            Pattern::Solid { .. } | Pattern::Orbit { .. } | Pattern::Placed { .. } => f32::INFINITY,
        };
        let longer = mapped_scale(frame.rows.map(parameters));
        self.finest = self.finest.min(finest / longer.max(f32::MIN_POSITIVE));
        let number = self.parts.len();
        self.parts.push(Part {
            pattern: pattern.clone(),
            inks: [PartInk::Colour(glam::Vec3::ZERO); 4],
            frame: (frame != Frame::NONE).then_some(frame),
        });
        if let Pattern::Solid { colour } = pattern {
            self.parts[number].inks[0] = PartInk::Colour(*colour);
        }
        for (k, ink) in pattern.inks().iter().enumerate() {
            self.parts[number].inks[k] = match ink {
                Ink::Colour(colour) => PartInk::Colour(*colour),
                Ink::Pattern(inner) => PartInk::Part(self.push(inner, frame)),
            };
        }
        number
    }

    /// The linear colour at a place.
    #[inline(always)]
    pub fn colour<R: PerLane>(&self, at: &Place<R>) -> Vec3<R> {
        self.shown(at, false)
    }

    /// What it shows at a place, as a colour or as a height, which formulas may give any value.
    #[inline(always)]
    fn shown<R: PerLane>(&self, at: &Place<R>, heights: bool) -> Vec3<R> {
        let (zero, one) = (at.width.lit(0.0), at.width.lit(1.0));
        if let [
            Part {
                pattern: Pattern::Solid { colour },
                ..
            },
        ] = self.parts[..]
        {
            return at.point.like(parameters(colour));
        }
        let mut shares = [zero; Pattern::MOST];
        shares[0] = one;
        let mut sum = Vec3::splat(zero);
        for (number, part) in self.parts.iter().take(Pattern::MOST).enumerate() {
            let share = shares[number];
            let here = match &part.frame {
                None => *at,
                Some(frame) => {
                    let rows = frame.rows.map(
                        #[inline(always)]
                        |row| at.point.like(parameters(row)),
                    );
                    let point = times(rows, at.point) + parameters(frame.offset);
                    at.mapped(point, rows)
                }
            };
            if let Pattern::Triplanar {
                image,
                size,
                sharpness,
            } = &part.pattern
            {
                let seen = R::each(
                    here.point,
                    here.normal,
                    #[inline(always)]
                    |p, n| triplanar(image, *size, *sharpness, p, n),
                );
                sum = sum + seen * share;
                continue;
            }
            if let Pattern::Formula { formula } = &part.pattern {
                sum = sum + formula_shown(formula, here.point, heights) * share;
                continue;
            }
            let of_inks = shares_of(&part.pattern, &here);
            for (ink, of_ink) in part.inks.iter().zip(of_inks) {
                let share = share * of_ink;
                match ink {
                    PartInk::Colour(colour) => {
                        sum = sum + at.point.like(parameters(*colour)) * share
                    }
                    PartInk::Part(number) => shares[*number] = share,
                }
            }
        }
        sum
    }

    /// What it means as a number: its luminance, 0 to 1.
    #[inline(always)]
    pub fn number<R: PerLane>(&self, at: &Place<R>) -> R {
        luminance_of(self.colour(at)).clamp01()
    }

    /// The unit normal at a place of the world whose heights this texture is, `depth` high where it is white; seen from direction `d`. `here` is
    /// the same place in the space of the texture, and `rows` how it changes with the place.
    #[inline(always)]
    pub fn bump<R: PerLane>(
        &self,
        depth: f32,
        at: &Place<R>,
        here: &Place<R>,
        rows: [Vec3<R>; 3],
        d: Vec3<R>,
    ) -> Vec3<R> {
        let scale = mapped_scale(rows).max(f32::MIN_POSITIVE);
        let step = here.width.max(self.finest.min(f32::MAX) * BUMP_STEP) / scale;
        let across = basis(at.normal);
        // in a loop, so that all that colours take is compiled once
        let zero = step.lit(0.0);
        let beside = [
            Vec3::splat(zero),
            times(rows, across[0] * step),
            times(rows, across[1] * step),
        ];
        let mut heights = [zero; 3];
        for (height, by) in heights.iter_mut().zip(beside) {
            let place = Place {
                point: here.point + by,
                ..*here
            };
            *height = luminance_of(self.shown(&place, true));
        }
        let [height, right, up] = heights;
        let run = step * scale;
        let rise = [(right - height) * depth / run, (up - height) * depth / run];
        bumped(at.normal, across, rise, d)
    }
}

/// How much of each of its inks a pattern shows at a place.
#[inline(always)]
fn shares_of<R: PerLane>(pattern: &Pattern, at: &Place<R>) -> [R; 4] {
    let (zero, one) = (at.width.lit(0.0), at.width.lit(1.0));
    let second = match pattern {
        Pattern::Checker { size, .. } => checker(at, *size),
        Pattern::Stripes {
            direction, size, ..
        } => stripes(at, parameters(*direction), *size),
        Pattern::Noise { size, octaves, .. } => noise(at, *size, *octaves as f32),
        Pattern::Gradient { from, to, .. } => gradient(at, parameters(*from), parameters(*to)),
        Pattern::Orbit { .. } => return orbit(at),
        Pattern::Solid { .. }
        | Pattern::Triplanar { .. }
        | Pattern::Formula { .. }
        | Pattern::Placed { .. } => {
            return [one, zero, zero, zero];
        }
    };
    [second.one_minus(), second, zero, zero]
}

/// The image along the three axes, weighted by the normal.
fn triplanar(image: &Image, size: f32, sharpness: f32, p: [f32; 3], n: [f32; 3]) -> [f32; 3] {
    let (p, n) = (v3(p[0], p[1], p[2]), v3(n[0], n[1], n[2]));
    let (mut sum, mut weights) = (glam::Vec3::ZERO, 0.0);
    for (axis, weight) in [0.0, 1.0, 2.0]
        .into_iter()
        .zip(projection_weights(n, sharpness).array())
    {
        if weight < LEAST_WEIGHT {
            continue;
        }
        let place = projection(p, n, axis, size);
        sum += texel(image, place.x, place.y) * weight;
        weights += weight;
    }
    (sum / weights.max(f32::MIN_POSITIVE)).to_array()
}

/// The colour of an endlessly repeated image, between its four nearest pixels.
fn texel(image: &Image, u: f32, v: f32) -> glam::Vec3 {
    let (width, height) = (image.width as usize, image.height as usize);
    if width == 0 || height == 0 || image.pixels.len() < width * height {
        return glam::Vec3::ZERO;
    }
    let (x, y) = (
        (u - u.floor()) * width as f32 - 0.5,
        (v - v.floor()) * height as f32 - 0.5,
    );
    let (i, j) = (x.floor(), y.floor());
    let at = |dx: f32, dy: f32| {
        let x = (i + dx).rem_euclid(width as f32) as usize;
        let y = (j + dy).rem_euclid(height as f32) as usize;
        image.pixels[y.min(height - 1) * width + x.min(width - 1)]
    };
    let (a, b) = (
        at(0.0, 0.0).lerp(at(1.0, 0.0), x - i),
        at(0.0, 1.0).lerp(at(1.0, 1.0), x - i),
    );
    a.lerp(b, y - j)
}
