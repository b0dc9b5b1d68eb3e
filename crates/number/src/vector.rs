//! Vectors of numbers. The right-hand side of an operation may hold numbers, parameters or literals.

use super::real::{Ops, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A vector of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec2<R> {
    /// First component.
    pub x: R,
    /// Second component.
    pub y: R,
}

/// A vector of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<R> {
    /// First component.
    pub x: R,
    /// Second component.
    pub y: R,
    /// Third component.
    pub z: R,
}

/// A vector of the plane from its components.
#[inline(always)]
pub fn v2<R>(x: R, y: R) -> Vec2<R> {
    Vec2 { x, y }
}

/// A vector of space from its components.
#[inline(always)]
pub fn v3<R>(x: R, y: R, z: R) -> Vec3<R> {
    Vec3 { x, y, z }
}

macro_rules! vector {
    ($v:ident, $n:literal, $($c:ident),*) => {
        impl<R: Ops<T>, T> Add<$v<T>> for $v<R> {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: $v<T>) -> Self {
                $v { $($c: self.$c + o.$c),* }
            }
        }

        impl<R: Ops<T>, T> Sub<$v<T>> for $v<R> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: $v<T>) -> Self {
                $v { $($c: self.$c - o.$c),* }
            }
        }

        impl<R: Ops<T>, T: Copy> Mul<T> for $v<R> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: T) -> Self {
                $v { $($c: self.$c * o),* }
            }
        }

        impl<R: Ops<T>, T: Copy> Div<T> for $v<R> {
            type Output = Self;
            #[inline(always)]
            fn div(self, o: T) -> Self {
                $v { $($c: self.$c / o),* }
            }
        }

        impl<R: Neg<Output = R>> Neg for $v<R> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                $v { $($c: -self.$c),* }
            }
        }

        impl<R> $v<R> {
            /// All components the same.
            #[inline(always)]
            pub fn splat(c: R) -> Self
            where
                R: Copy,
            {
                $v { $($c: c),* }
            }

            /// `f` of every component.
            #[inline(always)]
            pub fn map<T>(self, f: impl Fn(R) -> T) -> $v<T> {
                $v { $($c: f(self.$c)),* }
            }

            /// The components in their order.
            #[inline(always)]
            pub fn array(self) -> [R; $n] {
                [$(self.$c),*]
            }

            /// `self - c`, by component.
            #[inline(always)]
            pub fn less<T>(self, c: $v<T>) -> Self
            where
                R: Ops<T>,
            {
                self - c
            }

            /// `self * c`, by component.
            #[inline(always)]
            pub fn times<T>(self, c: $v<T>) -> Self
            where
                R: Ops<T>,
            {
                $v { $($c: self.$c * c.$c),* }
            }

            /// `self / c`, by component.
            #[inline(always)]
            pub fn over<T>(self, c: $v<T>) -> Self
            where
                R: Ops<T>,
            {
                $v { $($c: self.$c / c.$c),* }
            }

            /// Every component times `c`.
            #[inline(always)]
            pub fn scale<T: Copy>(self, c: T) -> Self
            where
                R: Ops<T>,
            {
                self * c
            }

            /// The smaller, by component.
            #[inline(always)]
            pub fn min<T>(self, o: $v<T>) -> Self
            where
                R: Ops<T>,
            {
                $v { $($c: self.$c.min(o.$c)),* }
            }

            /// The larger, by component.
            #[inline(always)]
            pub fn max<T>(self, o: $v<T>) -> Self
            where
                R: Ops<T>,
            {
                $v { $($c: self.$c.max(o.$c)),* }
            }
        }

        impl<R: Real> $v<R> {
            /// Euclidean length.
            #[inline(always)]
            pub fn length(self) -> R {
                R::norm(self.array())
            }

            /// Square of the Euclidean length.
            #[inline(always)]
            pub fn length_squared(self) -> R {
                let [first, rest @ ..] = self.array();
                let mut s = first.sq();
                for c in rest {
                    s = s + c.sq();
                }
                s
            }

            /// The vector of length one in the same direction; zero stays zero.
            #[inline(always)]
            pub fn normalize(self) -> Self {
                let n = self.length();
                $v { $($c: self.$c.unit(n)),* }
            }

            /// Absolute values.
            #[inline(always)]
            pub fn abs(self) -> Self {
                $v { $($c: self.$c.abs()),* }
            }

            /// Largest integers not above the components.
            #[inline(always)]
            pub fn floor(self) -> Self {
                $v { $($c: self.$c.floor()),* }
            }

            /// Nearest integers.
            #[inline(always)]
            pub fn round(self) -> Self {
                $v { $($c: self.$c.round()),* }
            }

            /// Components below zero become zero.
            #[inline(always)]
            pub fn max0(self) -> Self {
                $v { $($c: self.$c.max(0.0)),* }
            }

            /// Every component, but not outside [`lo`, `hi`].
            #[inline(always)]
            pub fn clamp<L: Copy, H: Copy>(self, lo: L, hi: H) -> Self
            where
                R: Ops<L> + Ops<H>,
            {
                $v { $($c: self.$c.max(lo).min(hi)),* }
            }

            /// `self + (o - self) t`.
            #[inline(always)]
            pub fn mix<T: Copy>(self, o: Self, t: T) -> Self
            where
                R: Ops<T>,
            {
                $v { $($c: self.$c.mix(o.$c, t)),* }
            }

            /// [`Real::select`], by component.
            #[inline(always)]
            pub fn select(m: R::Mask, yes: Self, no: Self) -> Self {
                $v { $($c: R::select(m, yes.$c, no.$c)),* }
            }

            /// Parameters or constants as numbers of the same company as self.
            #[inline(always)]
            pub fn like(self, c: $v<R::Scalar>) -> Self {
                $v { $($c: self.$c.like(c.$c)),* }
            }
        }
    };
}
vector!(Vec2, 2, x, y);
vector!(Vec3, 3, x, y, z);

impl<R: Real> Vec2<R> {
    /// Scalar product.
    #[inline(always)]
    pub fn dot<T>(self, o: Vec2<T>) -> R
    where
        R: Ops<T>,
    {
        self.x * o.x + self.y * o.y
    }

    /// `self.x o.y - self.y o.x`: the third component of the cross product.
    #[inline(always)]
    pub fn cross<T>(self, o: Vec2<T>) -> R
    where
        R: Ops<T>,
    {
        self.x * o.y - self.y * o.x
    }

    /// Turned a quarter counterclockwise.
    #[inline(always)]
    pub fn perpendicular(self) -> Self {
        v2(-self.y, self.x)
    }

    /// Largest component.
    #[inline(always)]
    pub fn max_component(self) -> R {
        self.x.max(self.y)
    }

    /// Smallest component.
    #[inline(always)]
    pub fn min_component(self) -> R {
        self.x.min(self.y)
    }

    /// With a third component.
    #[inline(always)]
    pub fn with_z(self, z: R) -> Vec3<R> {
        v3(self.x, self.y, z)
    }
}

impl<R: Real> Vec3<R> {
    /// Scalar product.
    #[inline(always)]
    pub fn dot<T>(self, o: Vec3<T>) -> R
    where
        R: Ops<T>,
    {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross<T: Copy>(self, o: Vec3<T>) -> Self
    where
        R: Ops<T>,
    {
        v3(
            self.y * o.z - self.z * o.y,
            self.z * o.x - self.x * o.z,
            self.x * o.y - self.y * o.x,
        )
    }

    /// Largest component.
    #[inline(always)]
    pub fn max_component(self) -> R {
        self.x.max(self.y.max(self.z))
    }

    /// Smallest component.
    #[inline(always)]
    pub fn min_component(self) -> R {
        self.x.min(self.y.min(self.z))
    }

    /// (x, y).
    #[inline(always)]
    pub fn xy(self) -> Vec2<R> {
        v2(self.x, self.y)
    }

    /// (x, z).
    #[inline(always)]
    pub fn xz(self) -> Vec2<R> {
        v2(self.x, self.z)
    }

    /// (y, z).
    #[inline(always)]
    pub fn yz(self) -> Vec2<R> {
        v2(self.y, self.z)
    }
}
