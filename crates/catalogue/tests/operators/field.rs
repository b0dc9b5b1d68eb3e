//! Proofs for a field in space.

use zeroset_catalogue::bounds::Exactness;

use crate::shapes::{Point, Random, along, gradient, length};
use crate::statement::{Common, Failure, Params};

/// A field in space, and whom to blame for it.
pub struct Field<'a> {
    pub common: &'a Common,
    pub params: &'a Params,
    pub value: &'a dyn Fn(Point) -> f64,
    pub what: String,
}

impl Field<'_> {
    fn fail(&self, proof: &'static str, what: String) -> Failure {
        self.common
            .fail(proof, self.params, format!("{what}, for {}", self.what))
    }
}

/// The slope over ways from tiny to long is at most the constant.
pub fn prove_slope(f: &Field<'_>, limit: f64, places: &[Point]) -> Result<(), Failure> {
    let mut random = Random::new(f.common.info.name, &f.params.exact, 30);
    for &p in places {
        for _ in 0..4 {
            let h = random.scale(1e-6, 1.0);
            let q = along(p, random.direction(), h);
            let (v, w) = ((f.value)(p), (f.value)(q));
            if !((v - w).abs() <= limit * h * (1.0 + 1e-6) + 1e-13) {
                return Err(f.fail(
                    "slope",
                    format!("{v} at {p:?}, {w} at {q:?}, {limit} is stated"),
                ));
            }
        }
    }
    Ok(())
}

/// No change of sign within the distance that the divided value promises.
pub fn prove_balls(f: &Field<'_>, limit: f64, places: &[Point]) -> Result<(), Failure> {
    let mut random = Random::new(f.common.info.name, &f.params.exact, 31);
    for &p in places {
        let v = (f.value)(p);
        let r = v.abs() / limit;
        for _ in 0..8 {
            let q = along(
                p,
                random.direction(),
                r * (1.0 - 1e-9) * random.unit().sqrt(),
            );
            let w = (f.value)(q);
            if (w > 0.0) != (v > 0.0) && w.abs() > 1e-12 && v.abs() > 1e-12 {
                return Err(f.fail("empty ball", format!("{v} at {p:?}, but {w} at {q:?}")));
            }
        }
    }
    Ok(())
}

/// Where the value is the distance, going that far down the gradient ends on the surface.
pub fn prove_exactness(f: &Field<'_>, claim: Exactness, places: &[Point]) -> Result<(), Failure> {
    if claim > Exactness::Outside {
        return Ok(());
    }
    let (mut reached, mut tried) = (0, 0);
    for &p in places {
        let v = (f.value)(p);
        if v.abs() < 1e-3 || (claim == Exactness::Outside && v < 0.0) {
            continue;
        }
        tried += 1;
        let g = gradient(f.value, p);
        let steep = length(g);
        // an edge of the field, where there are two nearest points, is rarely met
        if (steep - 1.0).abs() < 1e-5 {
            let q = along(p, g, -v / (steep * steep));
            let rest = (f.value)(q);
            if rest.abs() > 1e-4 * (1.0 + v.abs()) {
                return Err(f.fail(
                    "exactness",
                    format!("{claim:?}, {v} at {p:?}, but {rest} at {q:?}"),
                ));
            }
            reached += 1;
        }
    }
    if reached * 10 < tried * 9 {
        return Err(f.fail(
            "exactness",
            format!("{claim:?}, but of slope 1 at only {reached} of {tried} places"),
        ));
    }
    Ok(())
}
