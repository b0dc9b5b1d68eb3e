//! The smallest value of a function of a few numbers, without its slope (Nelder and Mead 1965, with the steps of Lagarias, Reeds, Wright
//! and Wright 1998).

/// How much longer than a reflected step an expanded one is.
const EXPAND: f64 = 2.0;
/// The same of a contracted one.
const CONTRACT: f64 = 0.5;
/// What is left of the distances to the best corner where nothing else helps.
const SHRINK: f64 = 0.5;

/// Where `value` is least near `start`, and what it is there. `size` is how far the first steps go, `most` how often `value` is asked at
/// most. What is no number counts as large.
///
/// # Errors
/// What `value` says.
pub(crate) fn minimum<E>(
    start: &[f64],
    size: f64,
    most: usize,
    mut value: impl FnMut(&[f64]) -> Result<f64, E>,
) -> Result<(Vec<f64>, f64), E> {
    let n = start.len();
    let mut asked = 0;
    let mut ask = |x: &[f64]| {
        asked += 1;
        let y = value(x)?;
        Ok((if y.is_nan() { f64::INFINITY } else { y }, asked))
    };
    let mut corners: Vec<(Vec<f64>, f64)> = Vec::with_capacity(n + 1);
    for k in 0..=n {
        let mut x = start.to_vec();
        if let Some(x) = k.checked_sub(1).and_then(|k| x.get_mut(k)) {
            *x += size;
        }
        let (y, _) = ask(&x)?;
        corners.push((x, y));
    }
    loop {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (best, worst) = (corners[0].1, corners[n].1);
        if n == 0 || worst - best <= 1e-7 * best.abs() {
            break;
        }
        // the middle of all corners but the worst
        let middle: Vec<f64> = (0..n)
            .map(|k| corners[..n].iter().map(|(x, _)| x[k]).sum::<f64>() / n as f64)
            .collect();
        let from_worst = |share: f64| -> Vec<f64> {
            let pairs = middle.iter().zip(&corners[n].0);
            pairs.map(|(m, w)| m + share * (m - w)).collect()
        };
        let reflected = from_worst(1.0);
        let (y, used) = ask(&reflected)?;
        if used >= most {
            if y < worst {
                corners[n] = (reflected, y);
            }
            break;
        }
        let (other, share) = if y < best {
            (Some(EXPAND), y)
        } else if y < corners[n - 1].1 {
            (None, y)
        } else if y < worst {
            (Some(CONTRACT), y)
        } else {
            (Some(-CONTRACT), worst)
        };
        match other {
            None => corners[n] = (reflected, y),
            Some(step) => {
                let tried = from_worst(step);
                let (found, _) = ask(&tried)?;
                if found < share {
                    corners[n] = (tried, found);
                } else if y < worst && step > 0.0 {
                    corners[n] = (reflected, y);
                } else {
                    let best = corners[0].0.clone();
                    for (x, y) in &mut corners[1..] {
                        for (x, b) in x.iter_mut().zip(&best) {
                            *x = b + SHRINK * (*x - b);
                        }
                        *y = ask(x)?.0;
                    }
                }
            }
        }
    }
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ok(corners.swap_remove(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(start: &[f64], f: impl Fn(&[f64]) -> f64) -> (Vec<f64>, f64) {
        minimum::<()>(start, 0.5, 2000, |x| Ok(f(x))).unwrap()
    }

    /// The valley of Rosenbrock (1960), a bowl, and a function of nothing.
    #[test]
    fn known_places_are_found() {
        let valley = |x: &[f64]| 100.0 * (x[1] - x[0] * x[0]).powi(2) + (1.0 - x[0]).powi(2);
        let (x, y) = found(&[-1.2, 1.0], valley);
        assert!(
            (x[0] - 1.0).abs() < 1e-3 && (x[1] - 1.0).abs() < 1e-3,
            "{x:?}"
        );
        assert!(y < 1e-6);
        let bowl = |x: &[f64]| {
            let squares = x.iter().zip([3.0, -2.0, 0.5]).map(|(x, c)| (x - c).powi(2));
            1.0 + squares.sum::<f64>()
        };
        let (x, y) = found(&[0.0; 3], bowl);
        assert!(
            (x[0] - 3.0).abs() < 1e-2 && (x[2] - 0.5).abs() < 1e-2,
            "{x:?}"
        );
        assert!((y - 1.0).abs() < 1e-4);
        assert_eq!(found(&[], |_| 7.0), (vec![], 7.0));
    }

    #[test]
    fn it_ends_and_passes_errors_on() {
        let mut asked = 0;
        let noisy = |_: &[f64]| {
            asked += 1;
            Ok::<f64, ()>(if asked % 3 == 0 {
                f64::NAN
            } else {
                f64::from(asked % 7)
            })
        };
        minimum(&[0.0, 0.0], 1.0, 50, noisy).unwrap();
        assert!(asked < 60, "{asked}");
        let failing = minimum(&[0.0], 1.0, 50, |_| Err("no"));
        assert_eq!(failing, Err("no"));
    }
}
