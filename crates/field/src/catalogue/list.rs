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

/// Calls `$then!` with every join, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_join {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            join::Union,
            join::Intersection,
            join::Subtraction,
            join_smooth::SmoothUnion,
        }
    };
}

/// Calls `$then!` with every map, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_map {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            map::Twist,
        }
    };
}

/// Calls `$then!` with every modifier, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_modify {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            modify::Onion,
            modify::Round,
            modify::Extrude,
        }
    };
}
