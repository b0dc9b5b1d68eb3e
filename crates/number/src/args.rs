//! An instruction's window into the parameter array.

use super::real::{Ends, Real, State};
use super::vector::{Vec2, Vec3, v2, v3};

/// An instruction's parameters: a window into the parameter array that begins at `at`.
pub struct Args<'a, R: Real> {
    /// What parameters are read from.
    pub store: &'a R::Store,
    /// Where the window begins.
    pub at: usize,
}

impl<R: Real> Clone for Args<'_, R> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<R: Real> Copy for Args<'_, R> {}

impl<'a, R: Real> Args<'a, R> {
    /// The whole of `store`.
    #[inline(always)]
    pub fn new(store: &'a R::Store) -> Self {
        Args { store, at: 0 }
    }

    /// Parameter `i`.
    #[inline(always)]
    pub fn get(self, i: usize) -> R::Scalar {
        R::param(self.store, self.at + i)
    }

    /// Parameter `i`.
    #[inline(always)]
    pub fn number(self, i: usize) -> R::Scalar {
        self.get(i)
    }

    /// Parameters `i` and `i + 1`.
    #[inline(always)]
    pub fn vec2(self, i: usize) -> Vec2<R::Scalar> {
        v2(self.get(i), self.get(i + 1))
    }

    /// Parameters `i` to `i + 2`.
    #[inline(always)]
    pub fn vec3(self, i: usize) -> Vec3<R::Scalar> {
        v3(self.get(i), self.get(i + 1), self.get(i + 2))
    }

    /// The window that begins `i` numbers later: for a list (its count at `i`), or for a part's own parameters.
    #[inline(always)]
    pub fn list(self, i: usize) -> Self {
        Args {
            store: self.store,
            at: self.at + i,
        }
    }

    /// A grid, interpolated at `p` (in nodes): its number is parameter `i`, its numbers of nodes along x, y and z are the next
    /// three.
    #[inline(always)]
    pub fn sample(self, i: usize, p: Vec3<R>) -> R {
        R::sample(self.store, self.get(i), self.vec3(i + 1), p)
    }

    /// The number of items of the list that the window begins with.
    #[inline(always)]
    pub fn count(self) -> R::Scalar {
        self.get(0)
    }

    /// For each item of the list that the window begins with, and its successor: `s = step(s, item, next)`.
    #[inline(always)]
    pub fn fold<const W: usize, T: State<R::Base>>(
        self,
        ends: Ends,
        init: T,
        step: impl Fn(T, [R::Scalar; W], [R::Scalar; W]) -> T,
    ) -> T {
        R::fold(self.store, self.at, ends, init, step)
    }

    /// For each item of the list that the window begins with: `s = step(s, item)`. (The order is that of the list, but it
    /// begins with the last item.)
    #[inline(always)]
    pub fn each<const W: usize, T: State<R::Base>>(
        self,
        init: T,
        step: impl Fn(T, [R::Scalar; W]) -> T,
    ) -> T {
        R::fold(
            self.store,
            self.at,
            Ends::Ring,
            init,
            #[inline(always)]
            |s, item, _next| step(s, item),
        )
    }

    /// Goes through the trees of the list that the window begins with: see [`Real::walk`].
    #[inline(always)]
    pub fn walk<const W: usize, const V: usize, T: State<R::Base>>(
        self,
        init: T,
        look: impl Fn(T, [R::Scalar; W]) -> (T, T, R::Mask),
        take: impl Fn(T, [R::Scalar; V]) -> T,
    ) -> T {
        R::walk(self.store, self.at, init, look, take)
    }
}
