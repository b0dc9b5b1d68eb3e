//! The list of all entries: adding one is a line here.
//!
//! `$then` is the name of a macro, or its path in brackets.

/// Calls `$then!` with every primitive.
#[macro_export]
#[doc(hidden)]
macro_rules! each_primitive {
    ($then:ident $($args:tt)*) => { $crate::each_primitive!{ [$then] $($args)* } };
    ([$($then:tt)+] $($args:tt)*) => {
        $($then)+! { $($args)*
            $crate::solid::Sphere,
            $crate::solid::CutSphere,
            $crate::solid::CutHollowSphere,
            $crate::solid::DeathStar,
            $crate::solid::SolidAngle,
            $crate::solid::VesicaSegment,
            $crate::solid::Torus,
            $crate::solid::CappedTorus,
            $crate::solid::Link,
            $crate::solid::Cuboid,
            $crate::solid::BoundBox,
            $crate::solid::RoundedBox,
            $crate::solid::BoxFrame,
            $crate::solid::Plane,
            $crate::solid::Slab,
            $crate::solid::InfiniteCylinder,
            $crate::solid::Cylinder,
            $crate::solid::RoundedCylinder,
            $crate::solid::Cone,
            $crate::solid::CappedCone,
            $crate::solid::InfiniteCone,
            $crate::solid::RoundCone,
            $crate::solid::HexagonalPrism,
            $crate::solid::TriangularPrism,
            $crate::solid::RhombicPrism,
            $crate::solid::Octahedron,
            $crate::solid::Pyramid,
            $crate::solid::Tetrahedron,
            $crate::solid::Dodecahedron,
            $crate::solid::Icosahedron,
            $crate::solid::GeneralisedOctahedron,
            $crate::solid::GeneralisedDodecahedron,
            $crate::solid::GeneralisedIcosahedron,
            $crate::solid::Ellipsoid,
            $crate::solid::Superquadric,
            $crate::solid::Quadric,
            $crate::solid::Capsule,
            $crate::solid::CapsuleBetween,
            $crate::solid::PolylineTube,
            $crate::solid::BezierTube,
            $crate::solid::Helix,
            $crate::solid::TriangleSheet,
            $crate::solid::Quad,
            $crate::solid::Gyroid,
            $crate::solid::SchwarzP,
            $crate::solid::SchwarzD,
            $crate::solid::Neovius,
            $crate::solid::Iwp,
            $crate::fractal::Mandelbulb,
            $crate::fractal::Mandelbox,
            $crate::fractal::Menger,
            $crate::fractal::Sierpinski,
            $crate::fractal::Julia,
            $crate::fractal::Apollonian,
            $crate::fractal::Kaleidoscope,
            $crate::flat::Circle,
            $crate::flat::Segment,
            $crate::flat::Rectangle,
            $crate::flat::RoundedRectangle,
            $crate::flat::ChamferedRectangle,
            $crate::flat::Diamond,
            $crate::flat::Trapezoid,
            $crate::flat::Parallelogram,
            $crate::flat::Triangle2d,
            $crate::flat::Ngon,
            $crate::flat::Star,
            $crate::flat::Pie,
            $crate::flat::Arc,
            $crate::flat::Ring,
            $crate::flat::Horseshoe,
            $crate::flat::Vesica,
            $crate::flat::Moon,
            $crate::flat::Heart,
            $crate::flat::Egg,
            $crate::flat::Cross,
            $crate::flat::Ellipse,
            $crate::flat::Parabola,
            $crate::flat::Bezier2d,
            $crate::flat::Polygon,
            $crate::flat::Outline,
            $crate::flat::Squircle,
        }
    };
}

/// Calls `$then!` with every join.
#[macro_export]
#[doc(hidden)]
macro_rules! each_join {
    ($then:ident $($args:tt)*) => { $crate::each_join!{ [$then] $($args)* } };
    ([$($then:tt)+] $($args:tt)*) => {
        $($then)+! { $($args)*
            $crate::join::Union,
            $crate::join::Intersection,
            $crate::join::Subtraction,
            $crate::join::Xor,
            $crate::join::Mix,
            $crate::join_smooth::SmoothUnion,
            $crate::join_smooth::SmoothIntersection,
            $crate::join_smooth::SmoothSubtraction,
            $crate::join_smooth::CubicUnion,
            $crate::join_smooth::CubicIntersection,
            $crate::join_smooth::CubicSubtraction,
            $crate::join_smooth::CircularUnion,
            $crate::join_smooth::CircularIntersection,
            $crate::join_smooth::CircularSubtraction,
            $crate::join_smooth::ExponentialUnion,
            $crate::join_smooth::ExponentialIntersection,
            $crate::join_smooth::ExponentialSubtraction,
            $crate::join_edge::ChamferUnion,
            $crate::join_edge::ChamferIntersection,
            $crate::join_edge::ChamferSubtraction,
            $crate::join_edge::RoundUnion,
            $crate::join_edge::RoundIntersection,
            $crate::join_edge::RoundSubtraction,
            $crate::join_edge::StairsUnion,
            $crate::join_edge::StairsIntersection,
            $crate::join_edge::StairsSubtraction,
            $crate::join_edge::ColumnsUnion,
            $crate::join_edge::ColumnsIntersection,
            $crate::join_edge::ColumnsSubtraction,
            $crate::join_line::Pipe,
            $crate::join_line::Engrave,
            $crate::join_line::Groove,
            $crate::join_line::Tongue,
        }
    };
}

/// Calls `$then!` with every map.
#[macro_export]
#[doc(hidden)]
macro_rules! each_map {
    ($then:ident $($args:tt)*) => { $crate::each_map!{ [$then] $($args)* } };
    ([$($then:tt)+] $($args:tt)*) => {
        $($then)+! { $($args)*
            $crate::map::Symmetry,
            $crate::map::Mirror,
            $crate::map::Elongate,
            $crate::map::Revolve,
            $crate::map::Slice,
            $crate::map_deform::Scale3,
            $crate::map_deform::Shear,
            $crate::map_deform::Twist,
            $crate::map_deform::Taper,
            $crate::map_bend::Bend,
            $crate::map_bend::Wrap,
        }
    };
}

/// Calls `$then!` with every modifier.
#[macro_export]
#[doc(hidden)]
macro_rules! each_modify {
    ($then:ident $($args:tt)*) => { $crate::each_modify!{ [$then] $($args)* } };
    ([$($then:tt)+] $($args:tt)*) => {
        $($then)+! { $($args)*
            $crate::modify::Complement,
            $crate::modify::Offset,
            $crate::modify::Round,
            $crate::modify::Onion,
            $crate::modify::Extrude,
            $crate::modify_displace::Displace,
            $crate::modify_displace::DisplaceValue,
            $crate::modify_displace::DisplaceGradient,
            $crate::modify_displace::DisplaceCellular,
        }
    };
}
