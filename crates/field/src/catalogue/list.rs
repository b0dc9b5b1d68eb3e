//! The list of all entries: adding one is a line here.

/// Calls `$then!` with every primitive, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_primitive {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            solid::Sphere,
            solid::CutSphere,
            solid::CutHollowSphere,
            solid::DeathStar,
            solid::SolidAngle,
            solid::VesicaSegment,
            solid::Torus,
            solid::CappedTorus,
            solid::Link,
            solid::Cuboid,
            solid::BoundBox,
            solid::RoundedBox,
            solid::BoxFrame,
            solid::Plane,
            solid::Slab,
            solid::InfiniteCylinder,
            solid::Cylinder,
            solid::RoundedCylinder,
            solid::Cone,
            solid::CappedCone,
            solid::InfiniteCone,
            solid::RoundCone,
            solid::HexagonalPrism,
            solid::TriangularPrism,
            solid::RhombicPrism,
            solid::Octahedron,
            solid::Pyramid,
            solid::Tetrahedron,
            solid::Dodecahedron,
            solid::Icosahedron,
            solid::GeneralisedOctahedron,
            solid::GeneralisedDodecahedron,
            solid::GeneralisedIcosahedron,
            solid::Ellipsoid,
            solid::Superquadric,
            solid::Quadric,
            solid::Capsule,
            solid::CapsuleBetween,
            solid::PolylineTube,
            solid::BezierTube,
            solid::Helix,
            solid::TriangleSheet,
            solid::Quad,
            solid::Gyroid,
            solid::SchwarzP,
            solid::SchwarzD,
            solid::Neovius,
            solid::Iwp,
            fractal::Mandelbulb,
            fractal::Mandelbox,
            fractal::Menger,
            fractal::Sierpinski,
            fractal::Julia,
            fractal::Apollonian,
            fractal::Kaleidoscope,
            flat::Circle,
            flat::Segment,
            flat::Rectangle,
            flat::RoundedRectangle,
            flat::ChamferedRectangle,
            flat::Diamond,
            flat::Trapezoid,
            flat::Parallelogram,
            flat::Triangle2d,
            flat::Ngon,
            flat::Star,
            flat::Pie,
            flat::Arc,
            flat::Ring,
            flat::Horseshoe,
            flat::Vesica,
            flat::Moon,
            flat::Heart,
            flat::Egg,
            flat::Cross,
            flat::Ellipse,
            flat::Parabola,
            flat::Bezier2d,
            flat::Polygon,
            flat::Outline,
            flat::Squircle,
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
            join::Xor,
            join::Mix,
            join_smooth::SmoothUnion,
            join_smooth::SmoothIntersection,
            join_smooth::SmoothSubtraction,
            join_smooth::CubicUnion,
            join_smooth::CubicIntersection,
            join_smooth::CubicSubtraction,
            join_smooth::CircularUnion,
            join_smooth::CircularIntersection,
            join_smooth::CircularSubtraction,
            join_smooth::ExponentialUnion,
            join_smooth::ExponentialIntersection,
            join_smooth::ExponentialSubtraction,
            join_edge::ChamferUnion,
            join_edge::ChamferIntersection,
            join_edge::ChamferSubtraction,
            join_edge::RoundUnion,
            join_edge::RoundIntersection,
            join_edge::RoundSubtraction,
            join_edge::StairsUnion,
            join_edge::StairsIntersection,
            join_edge::StairsSubtraction,
            join_edge::ColumnsUnion,
            join_edge::ColumnsIntersection,
            join_edge::ColumnsSubtraction,
            join_line::Pipe,
            join_line::Engrave,
            join_line::Groove,
            join_line::Tongue,
        }
    };
}

/// Calls `$then!` with every map, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_map {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            map::Symmetry,
            map::Mirror,
            map::Elongate,
            map::Revolve,
            map::Slice,
            map_deform::Scale3,
            map_deform::Shear,
            map_deform::Twist,
            map_deform::Taper,
            map_bend::Bend,
            map_bend::Wrap,
        }
    };
}

/// Calls `$then!` with every modifier, as paths from the crate's `catalogue`.
#[macro_export]
#[doc(hidden)]
macro_rules! each_modify {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            modify::Complement,
            modify::Offset,
            modify::Round,
            modify::Onion,
            modify::Extrude,
            modify_displace::Displace,
            modify_displace::DisplaceValue,
            modify_displace::DisplaceGradient,
            modify_displace::DisplaceCellular,
        }
    };
}
