//! The list of all entries: adding one is a line here.

/// Calls `$then!` with every primitive, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_primitive {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            solid::Sphere,
            solid::Cuboid,
            solid::Plane,
        }
    };
}
