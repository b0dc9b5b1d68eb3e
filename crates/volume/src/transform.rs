//! Distance transforms: how far each cell of a binary picture or volume is from what is marked.
//!
//! Cells are squares or cubes of side 1, and a distance is from the middle of one to the middle of another. The exact Euclidean
//! transform is that of Felzenszwalb and Huttenlocher (2012) and takes time in proportion to the cells; the older ones are here to be
//! compared with, as in Evans (2006).

use rayon::prelude::*;

/// What is near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Metric {
    /// The root of the sum of squares.
    #[default]
    Euclidean,
    /// The sum: steps along the axes.
    CityBlock,
    /// The largest: steps of a king.
    Chessboard,
}

impl Metric {
    /// All, by name.
    pub const ALL: [(&'static str, Metric); 3] = [
        ("euclidean", Metric::Euclidean),
        ("city-block", Metric::CityBlock),
        ("chessboard", Metric::Chessboard),
    ];
}

/// How a transform is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Along one axis after the other: exact in every metric, in time that grows with the cells (Felzenszwalb and Huttenlocher 2012
    /// for the Euclidean metric).
    #[default]
    Exact,
    /// Every cell with every marked one: exact, and slow (Evans 2006, listing 2).
    Brute,
    /// Sums of whole steps, 3 to a neighbour, 4 across a corner, 5 across that of a cube, over 3 (Borgefors 1986). Euclidean only, and
    /// off by up to a tenth.
    Chamfer,
    /// Two passes that hand on which marked cell is near, and measure to it (Grevera 2004). Euclidean only, and nearly always exact.
    DeadReckoning,
}

impl Method {
    /// All, by name.
    pub const ALL: [(&'static str, Method); 4] = [
        ("exact", Method::Exact),
        ("brute", Method::Brute),
        ("chamfer", Method::Chamfer),
        ("dead-reckoning", Method::DeadReckoning),
    ];
}

/// Why there is no transform.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TransformError {
    /// Not one mark a cell.
    #[error("{}x{}x{} cells and {marks} marks", .size[0], .size[1], .size[2])]
    Count {
        /// Cells along each axis.
        size: [usize; 3],
        /// Marks.
        marks: usize,
    },
    /// So many cells along an axis that their squares are not exact in single precision.
    #[error("{}x{}x{} cells: allowed are 1 to 4096 along each axis", .0[0], .0[1], .0[2])]
    Size([usize; 3]),
    /// Chamfers and dead reckoning stand for the Euclidean metric.
    #[error("this method measures in the Euclidean metric only")]
    Metric,
}

/// The most cells along an axis.
const MOST: usize = 4096;
/// Farther than anything is.
const FAR: f32 = 1e9;

/// The distance of each cell from the nearest marked one, x fastest; infinite where none is marked. A picture has one layer.
///
/// # Errors
/// Too many cells, not one mark for each, a method that does not know the metric.
pub fn distances(
    size: [usize; 3],
    marked: &[bool],
    metric: Metric,
    method: Method,
) -> Result<Vec<f32>, TransformError> {
    if !size.iter().all(|n| (1..=MOST).contains(n)) {
        return Err(TransformError::Size(size));
    }
    if size.iter().product::<usize>() != marked.len() {
        let marks = marked.len();
        return Err(TransformError::Count { size, marks });
    }
    if metric != Metric::Euclidean && matches!(method, Method::Chamfer | Method::DeadReckoning) {
        return Err(TransformError::Metric);
    }
    if !marked.contains(&true) {
        return Ok(vec![f32::INFINITY; marked.len()]);
    }
    Ok(match method {
        Method::Brute => brute(size, marked, metric),
        Method::Chamfer => chamfer(size, marked),
        Method::DeadReckoning => dead_reckoning(size, marked),
        Method::Exact => exact(size, marked, metric),
    })
}

/// Signed distances to the boundary between marked cells and others, negative within the marked ones: the distance to the nearest cell of
/// the other kind, less the half cell that lies between its middle and the boundary. Where all cells are of one kind there is no
/// boundary, and what is given is infinite.
///
/// # Errors
/// As [`distances`].
pub fn signed(
    size: [usize; 3],
    marked: &[bool],
    metric: Metric,
    method: Method,
) -> Result<Vec<f32>, TransformError> {
    let outside = distances(size, marked, metric, method)?;
    let others: Vec<bool> = marked.iter().map(|m| !m).collect();
    let inside = distances(size, &others, metric, method)?;
    let cell = |(out, within): (&f32, &f32)| if *out > 0.0 { out - 0.5 } else { 0.5 - within };
    Ok(outside.iter().zip(&inside).map(cell).collect())
}

fn place(i: usize, size: [usize; 3]) -> [i64; 3] {
    [
        (i % size[0]) as i64,
        (i / size[0] % size[1]) as i64,
        (i / (size[0] * size[1])) as i64,
    ]
}

fn brute(size: [usize; 3], marked: &[bool], metric: Metric) -> Vec<f32> {
    let places: Vec<[i64; 3]> = (marked.iter().enumerate())
        .filter(|(_, m)| **m)
        .map(|(i, _)| place(i, size))
        .collect();
    (0..marked.len())
        .into_par_iter()
        .map(|i| {
            let p = place(i, size);
            let mut least = i64::MAX;
            for q in &places {
                let d = [
                    (p[0] - q[0]).abs(),
                    (p[1] - q[1]).abs(),
                    (p[2] - q[2]).abs(),
                ];
                least = least.min(match metric {
                    Metric::Euclidean => d[0] * d[0] + d[1] * d[1] + d[2] * d[2],
                    Metric::CityBlock => d[0] + d[1] + d[2],
                    Metric::Chessboard => d[0].max(d[1]).max(d[2]),
                });
            }
            match metric {
                Metric::Euclidean => (least as f64).sqrt() as f32,
                _ => least as f32,
            }
        })
        .collect()
}

/// Lines along x one by one, along y and z many side by side.
fn exact(size: [usize; 3], marked: &[bool], metric: Metric) -> Vec<f32> {
    let [nx, ny, nz] = size;
    // how far the nearest mark of the line along x is
    let mut values = vec![0.0_f32; marked.len()];
    values
        .par_chunks_mut(nx)
        .zip(marked.par_chunks(nx))
        .for_each(|(line, marks)| {
            let mut far = FAR;
            for (x, mark) in line.iter_mut().zip(marks) {
                far = if *mark { 0.0 } else { (far + 1.0).min(FAR) };
                *x = far;
            }
            far = FAR;
            for x in line.iter_mut().rev() {
                far = if *x == 0.0 { 0.0 } else { (far + 1.0).min(*x) };
                *x = far;
            }
        });
    if metric == Metric::Euclidean {
        values.par_iter_mut().for_each(|x| *x *= *x);
    }
    if ny > 1 {
        // layers by themselves
        values
            .par_chunks_mut(nx * ny)
            .for_each(|layer| across(layer, nx, ny, metric));
    }
    if nz > 1 {
        // of each row of cells that share y, what lies behind each other in z: gathered, worked on, put back
        let rows: Vec<Vec<f32>> = (0..ny)
            .into_par_iter()
            .map(|y| {
                let mut sheet = Vec::with_capacity(nx * nz);
                for z in 0..nz {
                    sheet.extend_from_slice(&values[nx * (y + ny * z)..][..nx]);
                }
                across(&mut sheet, nx, nz, metric);
                sheet
            })
            .collect();
        values
            .par_chunks_mut(nx * ny)
            .enumerate()
            .for_each(|(z, layer)| {
                for (y, row) in rows.iter().enumerate() {
                    layer[nx * y..][..nx].copy_from_slice(&row[nx * z..][..nx]);
                }
            });
    }
    if metric == Metric::Euclidean {
        values.par_iter_mut().for_each(|x| *x = x.sqrt());
    }
    values
}

/// Columns that are worked on side by side: what they have of a row lies together.
const COLUMNS: usize = 16;

/// Combines what is known along x with the other axis of a sheet of `lines` rows: the least of `value(there) + cost(apart)`.
fn across(sheet: &mut [f32], nx: usize, lines: usize, metric: Metric) {
    match metric {
        Metric::Euclidean => {
            let mut column = vec![0.0; COLUMNS * lines];
            let mut hull = Hull::new(lines);
            for first in (0..nx).step_by(COLUMNS) {
                let wide = COLUMNS.min(nx - first);
                for n in 0..lines {
                    for c in 0..wide {
                        column[c * lines + n] = sheet[nx * n + first + c];
                    }
                }
                for c in 0..wide {
                    hull.sweep(&mut column[c * lines..(c + 1) * lines]);
                }
                for n in 0..lines {
                    for c in 0..wide {
                        sheet[nx * n + first + c] = column[c * lines + n];
                    }
                }
            }
        }
        // a step to the next row costs 1
        Metric::CityBlock => {
            for n in 1..lines {
                let (before, row) = sheet[nx * (n - 1)..nx * (n + 1)].split_at_mut(nx);
                (row.iter_mut().zip(&*before)).for_each(|(x, b)| *x = x.min(b + 1.0));
            }
            for n in (1..lines).rev() {
                let (row, behind) = sheet[nx * (n - 1)..nx * (n + 1)].split_at_mut(nx);
                (row.iter_mut().zip(&*behind)).for_each(|(x, b)| *x = x.min(b + 1.0));
            }
        }
        Metric::Chessboard => chessboard(sheet, nx, lines),
    }
}

/// The largest of both axes: `min over m of max(g(m), |n - m|)`. As the search goes away from a row, what may still come is no nearer than
/// how far it went, so it ends at the distance that it finds.
fn chessboard(sheet: &mut [f32], nx: usize, lines: usize) {
    let known = sheet.to_vec();
    for n in 0..lines {
        for x in 0..nx {
            let mut least = known[nx * n + x];
            let mut away = 1;
            while (away as f32) < least && away < lines {
                if n >= away {
                    least = least.min(known[nx * (n - away) + x].max(away as f32));
                }
                if n + away < lines {
                    least = least.min(known[nx * (n + away) + x].max(away as f32));
                }
                away += 1;
            }
            sheet[nx * n + x] = least;
        }
    }
}

/// The lower hull of parabolas of equal width.
struct Hull {
    /// Where the parabolas stand, and how high.
    places: Vec<(f32, f32)>,
    /// From where on each is the lowest.
    starts: Vec<f64>,
}

impl Hull {
    fn new(lines: usize) -> Hull {
        Hull {
            places: Vec::with_capacity(lines),
            starts: Vec::with_capacity(lines),
        }
    }

    /// The least of `f(m) + (n - m)^2` for each n. Squares up to 3 (4096)^2 need 26 bits: the places where parabolas cross are found in
    /// double precision, so that whole numbers stay exact.
    fn sweep(&mut self, line: &mut [f32]) {
        const NONE: f32 = FAR * FAR * 0.5;
        self.places.clear();
        self.starts.clear();
        for (n, height) in line.iter().enumerate() {
            if *height >= NONE {
                continue;
            }
            let (place, height) = (n as f32, *height);
            let mut start = f64::NEG_INFINITY;
            while let Some(&(other, low)) = self.places.last() {
                let (p, q) = (f64::from(place), f64::from(other));
                let apart = f64::from(height) + p * p - (f64::from(low) + q * q);
                start = apart / (2.0 * (p - q));
                if start > *self.starts.last().unwrap_or(&f64::NEG_INFINITY) {
                    break;
                }
                self.places.pop();
                self.starts.pop();
                start = f64::NEG_INFINITY;
            }
            self.places.push((place, height));
            self.starts.push(start);
        }
        if self.places.is_empty() {
            return;
        }
        let mut at = 0;
        for (n, x) in line.iter_mut().enumerate() {
            while self.starts.get(at + 1).is_some_and(|s| *s < n as f64) {
                at += 1;
            }
            let (place, height) = self.places[at];
            let apart = n as f32 - place;
            *x = height + apart * apart;
        }
    }
}

/// Neighbours that come before a cell, with how many axes they differ in.
fn before() -> Vec<([i64; 3], usize)> {
    let mut out = Vec::new();
    for z in -1..=0_i64 {
        for y in -1..=1_i64 {
            for x in -1..=1_i64 {
                if (z, y, x) < (0, 0, 0) {
                    let axes = [x, y, z].iter().filter(|d| **d != 0).count();
                    out.push(([x, y, z], axes));
                }
            }
        }
    }
    out
}

/// Visits all cells forwards with the neighbours before them, then backwards with those behind.
fn two_passes(size: [usize; 3], mut visit: impl FnMut(usize, usize, usize)) {
    let count: usize = size.iter().product();
    let neighbours = before();
    for backwards in [false, true] {
        for step in 0..count {
            let i = if backwards { count - 1 - step } else { step };
            let p = place(i, size);
            for (off, axes) in &neighbours {
                let sign = if backwards { -1 } else { 1 };
                let q = [
                    p[0] + sign * off[0],
                    p[1] + sign * off[1],
                    p[2] + sign * off[2],
                ];
                if (0..3).all(|k| (0..size[k] as i64).contains(&q[k])) {
                    let j = q[0] as usize + size[0] * (q[1] as usize + size[1] * q[2] as usize);
                    visit(i, j, *axes);
                }
            }
        }
    }
}

fn chamfer(size: [usize; 3], marked: &[bool]) -> Vec<f32> {
    let mut steps: Vec<u32> = marked
        .iter()
        .map(|m| if *m { 0 } else { u32::MAX / 2 })
        .collect();
    two_passes(size, |i, j, axes| {
        steps[i] = steps[i].min(steps[j] + [0, 3, 4, 5][axes]);
    });
    steps.iter().map(|s| *s as f32 / 3.0).collect()
}

fn dead_reckoning(size: [usize; 3], marked: &[bool]) -> Vec<f32> {
    let mut nearest: Vec<usize> = (marked.iter().enumerate())
        .map(|(i, m)| if *m { i } else { usize::MAX })
        .collect();
    let mut far: Vec<f32> = marked.iter().map(|m| if *m { 0.0 } else { FAR }).collect();
    two_passes(size, |i, j, axes| {
        if nearest[j] != usize::MAX && far[j] + (axes as f32).sqrt() < far[i] {
            let (p, q) = (place(i, size), place(nearest[j], size));
            let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            nearest[i] = nearest[j];
            far[i] = ((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) as f32).sqrt();
        }
    });
    far
}
