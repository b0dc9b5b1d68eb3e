//! Whether two films show the same, other than beside silhouettes.

use zeroset_scene::film::Film;
use zeroset_scene::scene::Scene;
use zeroset_testkit::conform::{self, BUDGETS, Difference};

pub use zeroset_testkit::conform::beside_edge;

/// The planes that differ by more than is allowed.
pub fn differing(scene: &Scene, a: &Film, b: &Film) -> Vec<Difference> {
    let compared = conform::compare(scene, a, b, &BUDGETS[0]).compared as f64;
    assert!(
        compared > 0.3 * f64::from(a.width() * a.height()),
        "hardly anything is compared"
    );
    conform::differing(scene, a, b, &BUDGETS)
}

#[track_caller]
pub fn same(scene: &Scene, a: &Film, b: &Film, what: &str) {
    let off = differing(scene, a, b);
    assert!(off.is_empty(), "{what}: {off:?}");
}
