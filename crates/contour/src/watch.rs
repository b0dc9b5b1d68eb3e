//! Who looks on.

/// Hears how far a contour is, and may end it.
pub trait Watch: Sync {
    /// So much of all is done, 0 to 1.
    fn advance(&self, _share: f64) {}
    /// Whether to stop.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Nobody looks on.
#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl Watch for Alone {}
