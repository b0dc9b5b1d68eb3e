//! The catalogue as functions and methods. Written by `tests/shape/generate.rs`, which a test holds this file against: do not
//! change it by hand.

use super::{Params, Shape};
use glam::{DVec2, DVec3};

/// A ball around the origin.
///
/// - `radius`: Distance from the centre to the surface. Scene units, 1e-9 to 1e9.
pub fn sphere(radius: impl Into<f64>) -> Shape {
    Shape::primitive("sphere", Params::new().number(radius))
}

/// The part of a ball above a horizontal plane.
///
/// - `radius`: Radius of the ball. Scene units, 1e-9 to 1e9.
/// - `height`: Height of the plane; less than the radius. Scene units, -1e9 to 1e9.
pub fn cut_sphere(radius: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("cut_sphere", Params::new().number(radius).number(height))
}

/// A bowl with a round rim: the shell of a ball below a plane.
///
/// - `radius`: Radius of the middle of the shell. Scene units, 1e-9 to 1e9.
/// - `height`: Height of the rim; less than the radius. Scene units, -1e9 to 1e9.
/// - `thickness`: Full thickness of the shell. Scene units, 1e-9 to 1e9.
pub fn cut_hollow_sphere(radius: impl Into<f64>, height: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("cut_hollow_sphere", Params::new().number(radius).number(height).number(thickness))
}

/// A ball with a ball bitten out of its top.
///
/// - `radius`: Radius of the ball. Scene units, 1e-9 to 1e9.
/// - `bite`: Radius of the ball that is taken away. Scene units, 1e-9 to 1e9.
/// - `distance`: Distance between the centres; the surfaces must meet. Scene units, 1e-9 to 1e9.
pub fn death_star(radius: impl Into<f64>, bite: impl Into<f64>, distance: impl Into<f64>) -> Shape {
    Shape::primitive("death_star", Params::new().number(radius).number(bite).number(distance))
}

/// The part of a ball within a cone that opens upwards from its centre.
///
/// - `radius`: Radius of the ball. Scene units, 1e-9 to 1e9.
/// - `angle`: Angle from the axis to the cone. Radians, 0.001 to 3.1406.
pub fn solid_angle(radius: impl Into<f64>, angle: impl Into<f64>) -> Shape {
    Shape::primitive("solid_angle", Params::new().number(radius).number(angle))
}

/// A spindle between two points: the turned overlap of two circles.
///
/// - `start`: First tip. Scene units, -1e9 to 1e9.
/// - `end`: Second tip. Scene units, -1e9 to 1e9.
/// - `width`: Full width in the middle; at most the distance of the tips. Scene units, 1e-9 to 1e9.
pub fn vesica_segment(start: impl Into<DVec3>, end: impl Into<DVec3>, width: impl Into<f64>) -> Shape {
    Shape::primitive("vesica_segment", Params::new().vec3(start).vec3(end).number(width))
}

/// A ring that lies flat.
///
/// - `radius`: From the centre to the middle of the tube. Scene units, 1e-9 to 1e9.
/// - `tube`: Radius of the tube. Scene units, 1e-9 to 1e9.
pub fn torus(radius: impl Into<f64>, tube: impl Into<f64>) -> Shape {
    Shape::primitive("torus", Params::new().number(radius).number(tube))
}

/// A piece of a flat ring, around the z axis, with round ends.
///
/// - `radius`: From the centre to the middle of the tube. Scene units, 1e-9 to 1e9.
/// - `tube`: Radius of the tube. Scene units, 1e-9 to 1e9.
/// - `angle`: Angle from the z axis to an end. Radians, 0 to 3.1416.
pub fn capped_torus(radius: impl Into<f64>, tube: impl Into<f64>, angle: impl Into<f64>) -> Shape {
    Shape::primitive("capped_torus", Params::new().number(radius).number(tube).number(angle))
}

/// A link of a chain, upright in the xy plane.
///
/// - `length`: Length of the straight part. Scene units, 0 to 1e9.
/// - `radius`: Radius of the bends, to the middle of the tube. Scene units, 1e-9 to 1e9.
/// - `tube`: Radius of the tube. Scene units, 1e-9 to 1e9.
pub fn link(length: impl Into<f64>, radius: impl Into<f64>, tube: impl Into<f64>) -> Shape {
    Shape::primitive("link", Params::new().number(length).number(radius).number(tube))
}

/// A box around the origin.
///
/// Source: Tomczak 2012, algorithm 3.6.
///
/// - `size`: Full sides along x, y and z. Scene units, 1e-9 to 1e9.
pub fn box3(size: impl Into<DVec3>) -> Shape {
    Shape::primitive("box", Params::new().vec3(size))
}

/// The box by its largest face distance, too small beside the edges.
///
/// Source: Tomczak 2012, algorithm 3.5.
///
/// - `size`: Full sides along x, y and z. Scene units, 1e-9 to 1e9.
pub fn box_bound(size: impl Into<DVec3>) -> Shape {
    Shape::primitive("box_bound", Params::new().vec3(size))
}

/// A box with round edges.
///
/// - `size`: Full sides along x, y and z. Scene units, 1e-9 to 1e9.
/// - `round`: Radius of the edges; the size stays. Scene units, 0 to 1e9.
pub fn rounded_box(size: impl Into<DVec3>, round: impl Into<f64>) -> Shape {
    Shape::primitive("rounded_box", Params::new().vec3(size).number(round))
}

/// The edges of a box, as square bars.
///
/// - `size`: Full sides along x, y and z. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full side of the bars' square section. Scene units, 1e-9 to 1e9.
pub fn box_frame(size: impl Into<DVec3>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("box_frame", Params::new().vec3(size).number(thickness))
}

/// The half space below y = 0: a floor.
pub fn plane() -> Shape {
    Shape::primitive("plane", Params::new())
}

/// The space between two horizontal planes.
///
/// - `thickness`: Distance between the planes. Scene units, 1e-9 to 1e9.
pub fn slab(thickness: impl Into<f64>) -> Shape {
    Shape::primitive("slab", Params::new().number(thickness))
}

/// A cylinder without ends.
///
/// - `radius`: Distance from the axis to the surface. Scene units, 1e-9 to 1e9.
pub fn infinite_cylinder(radius: impl Into<f64>) -> Shape {
    Shape::primitive("infinite_cylinder", Params::new().number(radius))
}

/// A cylinder with flat ends.
///
/// - `radius`: Distance from the axis to the surface. Scene units, 1e-9 to 1e9.
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
pub fn cylinder(radius: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("cylinder", Params::new().number(radius).number(height))
}

/// A cylinder with round edges.
///
/// - `radius`: Distance from the axis to the surface. Scene units, 1e-9 to 1e9.
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
/// - `round`: Radius of the edges; the size stays. Scene units, 0 to 1e9.
pub fn rounded_cylinder(radius: impl Into<f64>, height: impl Into<f64>, round: impl Into<f64>) -> Shape {
    Shape::primitive("rounded_cylinder", Params::new().number(radius).number(height).number(round))
}

/// A cone that stands on its disc.
///
/// - `radius`: Radius of the disc. Scene units, 1e-9 to 1e9.
/// - `height`: From the disc to the tip. Scene units, 1e-9 to 1e9.
pub fn cone(radius: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("cone", Params::new().number(radius).number(height))
}

/// A cone with a flat top.
///
/// - `lower`: Radius at the bottom. Scene units, 0 to 1e9.
/// - `upper`: Radius at the top. Scene units, 0 to 1e9.
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
pub fn capped_cone(lower: impl Into<f64>, upper: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("capped_cone", Params::new().number(lower).number(upper).number(height))
}

/// A cone without end below its tip, which is the origin.
///
/// - `angle`: Angle from the axis to the surface. Radians, 0.001 to 1.5698.
pub fn infinite_cone(angle: impl Into<f64>) -> Shape {
    Shape::primitive("infinite_cone", Params::new().number(angle))
}

/// A cone with round ends: the hull of two balls, one above the other.
///
/// - `lower`: Radius of the lower ball. Scene units, 1e-9 to 1e9.
/// - `upper`: Radius of the upper ball. Scene units, 1e-9 to 1e9.
/// - `height`: Distance between the balls' centres; more than the radii differ. Scene units, 1e-9 to 1e9.
pub fn round_cone(lower: impl Into<f64>, upper: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("round_cone", Params::new().number(lower).number(upper).number(height))
}

/// An upright prism over a regular hexagon, two corners on the x axis.
///
/// - `radius`: Distance from the axis to the corners. Scene units, 1e-9 to 1e9.
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
pub fn hexagonal_prism(radius: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("hexagonal_prism", Params::new().number(radius).number(height))
}

/// An upright prism over a regular triangle, one corner on the z axis.
///
/// - `radius`: Distance from the axis to the corners. Scene units, 1e-9 to 1e9.
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
pub fn triangular_prism(radius: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("triangular_prism", Params::new().number(radius).number(height))
}

/// An upright prism over a rhombus with its diagonals along x and z.
///
/// - `width`: Full diagonal along x. Scene units, 1e-9 to 1e9.
/// - `depth`: Full diagonal along z. Scene units, 1e-9 to 1e9.
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
pub fn rhombic_prism(width: impl Into<f64>, depth: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("rhombic_prism", Params::new().number(width).number(depth).number(height))
}

/// Eight triangles, corners on the axes.
///
/// - `radius`: Distance from the centre to the corners. Scene units, 1e-9 to 1e9.
pub fn octahedron(radius: impl Into<f64>) -> Shape {
    Shape::primitive("octahedron", Params::new().number(radius))
}

/// A pyramid that stands on a square.
///
/// - `base`: Full side of the square. Scene units, 1e-9 to 1e9.
/// - `height`: From the square to the tip. Scene units, 1e-9 to 1e9.
pub fn pyramid(base: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("pyramid", Params::new().number(base).number(height))
}

/// Four triangles, one corner up and one towards z.
///
/// - `radius`: Distance from the centre to the corners. Scene units, 1e-9 to 1e9.
pub fn tetrahedron(radius: impl Into<f64>) -> Shape {
    Shape::primitive("tetrahedron", Params::new().number(radius))
}

/// Twelve pentagons, six edges facing the axes.
///
/// - `radius`: Distance from the centre to the corners. Scene units, 1e-9 to 1e9.
pub fn dodecahedron(radius: impl Into<f64>) -> Shape {
    Shape::primitive("dodecahedron", Params::new().number(radius))
}

/// Twenty triangles, six edges facing the axes.
///
/// - `radius`: Distance from the centre to the corners. Scene units, 1e-9 to 1e9.
pub fn icosahedron(radius: impl Into<f64>) -> Shape {
    Shape::primitive("icosahedron", Params::new().number(radius))
}

/// Between a ball and an octahedron.
///
/// Source: Akleman and Chen 1999.
///
/// - `radius`: Distance from the centre to the faces of the sharp solid. Scene units, 1e-9 to 1e9.
/// - `exponent`: 2 is a ball; the higher, the sharper the edges. A plain number, 2 to 64.
pub fn generalised_octahedron(radius: impl Into<f64>, exponent: impl Into<f64>) -> Shape {
    Shape::primitive("generalised_octahedron", Params::new().number(radius).number(exponent))
}

/// Between a ball and a dodecahedron.
///
/// Source: Akleman and Chen 1999.
///
/// - `radius`: Distance from the centre to the faces of the sharp solid. Scene units, 1e-9 to 1e9.
/// - `exponent`: 2 is a ball; the higher, the sharper the edges. A plain number, 2 to 64.
pub fn generalised_dodecahedron(radius: impl Into<f64>, exponent: impl Into<f64>) -> Shape {
    Shape::primitive("generalised_dodecahedron", Params::new().number(radius).number(exponent))
}

/// Between a ball and an icosahedron.
///
/// Source: Akleman and Chen 1999.
///
/// - `radius`: Distance from the centre to the faces of the sharp solid. Scene units, 1e-9 to 1e9.
/// - `exponent`: 2 is a ball; the higher, the sharper the edges. A plain number, 2 to 64.
pub fn generalised_icosahedron(radius: impl Into<f64>, exponent: impl Into<f64>) -> Shape {
    Shape::primitive("generalised_icosahedron", Params::new().number(radius).number(exponent))
}

/// A ball stretched along the axes.
///
/// Source: root as in Eberly 2013, found as a secular equation (More and Sorensen 1983).
///
/// - `radii`: Half diameters along x, y and z. Scene units, 1e-9 to 1e9.
pub fn ellipsoid(radii: impl Into<DVec3>) -> Shape {
    Shape::primitive("ellipsoid", Params::new().vec3(radii))
}

/// A superellipsoid: from an octahedron over a ball to a box.
///
/// Source: Barr 1981; exponents as 2 / e of his.
///
/// - `radii`: Half diameters along x, y and z. Scene units, 1e-9 to 1e9.
/// - `around`: Exponent around y: 1 is a rhombus, 2 an ellipse, more a box. A plain number, 1 to 64.
/// - `upright`: Exponent of the upright outline: as `around`. A plain number, 1 to 64.
pub fn superquadric(radii: impl Into<DVec3>, around: impl Into<f64>, upright: impl Into<f64>) -> Shape {
    Shape::primitive("superquadric", Params::new().vec3(radii).number(around).number(upright))
}

/// Where a polynomial of second degree in x, y and z is not above zero.
///
/// Source: distance bound of second order, Taubin 1994.
///
/// - `squares`: Factors of x^2, y^2 and z^2. A plain number, -1e9 to 1e9.
/// - `products`: Factors of y z, z x and x y. A plain number, -1e9 to 1e9.
/// - `linear`: Factors of x, y and z. A plain number, -1e9 to 1e9.
/// - `constant`: What is added. A plain number, -1e9 to 1e9.
pub fn quadric(squares: impl Into<DVec3>, products: impl Into<DVec3>, linear: impl Into<DVec3>, constant: impl Into<f64>) -> Shape {
    Shape::primitive("quadric", Params::new().vec3(squares).vec3(products).vec3(linear).number(constant))
}

/// A cylinder with half balls as ends.
///
/// - `radius`: Radius of the cylinder and of its ends. Scene units, 1e-9 to 1e9.
/// - `height`: Height of the cylinder, without its ends. Scene units, 0 to 1e9.
pub fn capsule(radius: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("capsule", Params::new().number(radius).number(height))
}

/// A capsule from one point to another.
///
/// - `start`: Centre of the first end. Scene units, -1e9 to 1e9.
/// - `end`: Centre of the second end. Scene units, -1e9 to 1e9.
/// - `radius`: Radius of the cylinder and of its ends. Scene units, 1e-9 to 1e9.
pub fn capsule_between(start: impl Into<DVec3>, end: impl Into<DVec3>, radius: impl Into<f64>) -> Shape {
    Shape::primitive("capsule_between", Params::new().vec3(start).vec3(end).number(radius))
}

/// A tube along straight lines from point to point.
///
/// - `radius`: Radius of the tube and of its ends. Scene units, 1e-9 to 1e9.
/// - `points`: Points in their order, one at least. Scene units, -1e9 to 1e9.
pub fn polyline_tube(radius: impl Into<f64>, points: impl IntoIterator<Item = impl Into<DVec3>>) -> Shape {
    Shape::primitive("polyline_tube", Params::new().number(radius).points(points))
}

/// A tube along a quadratic Bezier curve.
///
/// - `start`: Where the curve begins. Scene units, -1e9 to 1e9.
/// - `control`: Where its tangents at both ends meet. Scene units, -1e9 to 1e9.
/// - `end`: Where the curve ends. Scene units, -1e9 to 1e9.
/// - `radius`: Radius of the tube and of its ends. Scene units, 1e-9 to 1e9.
pub fn bezier_tube(start: impl Into<DVec3>, control: impl Into<DVec3>, end: impl Into<DVec3>, radius: impl Into<f64>) -> Shape {
    Shape::primitive("bezier_tube", Params::new().vec3(start).vec3(control).vec3(end).number(radius))
}

/// A tube that winds around the y axis.
///
/// - `radius`: From the axis to the middle of the tube. Scene units, 1e-9 to 1e9.
/// - `pitch`: Height of a turn. Scene units, 1e-9 to 1e9.
/// - `turns`: Number of turns. A plain number, 0.01 to 1000.
/// - `tube`: Radius of the tube and of its ends. Scene units, 1e-9 to 1e9.
pub fn helix(radius: impl Into<f64>, pitch: impl Into<f64>, turns: impl Into<f64>, tube: impl Into<f64>) -> Shape {
    Shape::primitive("helix", Params::new().number(radius).number(pitch).number(turns).number(tube))
}

/// A triangle in space, thickened.
///
/// - `a`: First corner. Scene units, -1e9 to 1e9.
/// - `b`: Second corner. Scene units, -1e9 to 1e9.
/// - `c`: Third corner. Scene units, -1e9 to 1e9.
/// - `radius`: Half the thickness, and the radius of the edges. Scene units, 1e-9 to 1e9.
pub fn triangle_sheet(a: impl Into<DVec3>, b: impl Into<DVec3>, c: impl Into<DVec3>, radius: impl Into<f64>) -> Shape {
    Shape::primitive("triangle_sheet", Params::new().vec3(a).vec3(b).vec3(c).number(radius))
}

/// A quadrilateral in space, thickened; folded from a to c if it is not flat.
///
/// - `a`: First corner. Scene units, -1e9 to 1e9.
/// - `b`: Second corner. Scene units, -1e9 to 1e9.
/// - `c`: Third corner. Scene units, -1e9 to 1e9.
/// - `d`: Fourth corner. Scene units, -1e9 to 1e9.
/// - `radius`: Half the thickness, and the radius of the edges. Scene units, 1e-9 to 1e9.
pub fn quad(a: impl Into<DVec3>, b: impl Into<DVec3>, c: impl Into<DVec3>, d: impl Into<DVec3>, radius: impl Into<f64>) -> Shape {
    Shape::primitive("quad", Params::new().vec3(a).vec3(b).vec3(c).vec3(d).number(radius))
}

/// Schoen's gyroid, a sheet without straight lines that fills space.
///
/// Source: von Schnering and Nesper 1991; bound of second order, Taubin 1994.
///
/// - `period`: Side of the cube that repeats. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full thickness of the sheet, as far as it is flat. Scene units, 1e-9 to 1e9.
pub fn gyroid(period: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("gyroid", Params::new().number(period).number(thickness))
}

/// Schwarz' primitive surface: a cubic lattice of tunnels.
///
/// Source: von Schnering and Nesper 1991; bound of second order, Taubin 1994.
///
/// - `period`: Side of the cube that repeats. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full thickness of the sheet, as far as it is flat. Scene units, 1e-9 to 1e9.
pub fn schwarz_p(period: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("schwarz_p", Params::new().number(period).number(thickness))
}

/// Schwarz' diamond surface: tunnels along the bonds of diamond.
///
/// Source: von Schnering and Nesper 1991; bound of second order, Taubin 1994.
///
/// - `period`: Side of the cube that repeats. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full thickness of the sheet, as far as it is flat. Scene units, 1e-9 to 1e9.
pub fn schwarz_d(period: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("schwarz_d", Params::new().number(period).number(thickness))
}

/// Neovius' surface: chambers joined through the edges of the cube.
///
/// Source: von Schnering and Nesper 1991; bound of second order, Taubin 1994.
///
/// - `period`: Side of the cube that repeats. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full thickness of the sheet, as far as it is flat. Scene units, 1e-9 to 1e9.
pub fn neovius(period: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("neovius", Params::new().number(period).number(thickness))
}

/// Schoen's I-WP: chambers joined through the corners of the cube.
///
/// Source: von Schnering and Nesper 1991; bound of second order, Taubin 1994.
///
/// - `period`: Side of the cube that repeats. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full thickness of the sheet, as far as it is flat. Scene units, 1e-9 to 1e9.
pub fn iwp(period: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("iwp", Params::new().number(period).number(thickness))
}

/// The Mandelbulb: z -> z^power + p with powers by spherical angles.
///
/// Source: White and Nylander 2009; estimate after Hart, Sandin and Kauffman 1989.
///
/// - `power`: Exponent. A plain number, 2 to 32.
/// - `iterations`: Most steps of an orbit. A whole number, 1 to 64.
pub fn mandelbulb(power: impl Into<f64>, iterations: u32) -> Shape {
    Shape::primitive("mandelbulb", Params::new().number(power).number(iterations))
}

/// The Mandelbox: fold into a box and a ball, scale, add the point, again; in a cube of side 2.
///
/// Source: Lowe 2010; estimate after Buddhi 2010.
///
/// - `factor`: Scale of a step: -4 to -1.2 or 1.5 to 4. A plain number, -4 to 4.
/// - `iterations`: Most steps of an orbit. A whole number, 1 to 64.
/// - `inner`: Radius below which the ball fold is linear. A plain number, 0.05 to 1.
pub fn mandelbox(factor: impl Into<f64>, iterations: u32, inner: impl Into<f64>) -> Shape {
    Shape::primitive("mandelbox", Params::new().number(factor).number(iterations).number(inner))
}

/// Menger's sponge: a cube of side 2 with square holes in every third of a third.
///
/// Source: Menger 1926; distance bound after Quilez 2011.
///
/// - `iterations`: Generations of holes. A whole number, 1 to 10.
pub fn menger(iterations: u32) -> Shape {
    Shape::primitive("menger", Params::new().number(iterations))
}

/// Sierpinski's tetrahedron: four copies of half its size, again and again, in a cube of side 2.
///
/// Source: Sierpinski 1915; by reflections.
///
/// - `iterations`: Generations of copies. A whole number, 1 to 14.
pub fn sierpinski(iterations: u32) -> Shape {
    Shape::primitive("sierpinski", Params::new().number(iterations))
}

/// A quaternion Julia set: q -> q^2 + c, seen where the last coordinate is `slice`.
///
/// Source: Norton 1982; Hart, Sandin and Kauffman 1989.
///
/// - `c`: First three coordinates of c. A plain number, -2 to 2.
/// - `c_w`: Last coordinate of c. A plain number, -2 to 2.
/// - `slice`: Last coordinate of the points that are seen. Scene units, -2 to 2.
/// - `iterations`: Most steps of an orbit. A whole number, 1 to 64.
pub fn julia(c: impl Into<DVec3>, c_w: impl Into<f64>, slice: impl Into<f64>, iterations: u32) -> Shape {
    Shape::primitive("julia", Params::new().vec3(c).number(c_w).number(slice).number(iterations))
}

/// An Apollonian packing without end: repeat, invert in a sphere, again. Intersect it with a shape.
///
/// Source: Quilez 2013, after inversions in circles (Apollonius).
///
/// - `inversion`: Square of the inversion's radius. A plain number, 0.8 to 1.6.
/// - `iterations`: Steps of an orbit. A whole number, 1 to 12.
/// - `thickness`: Thickness of the sheets. Scene units, 0 to 0.5.
pub fn apollonian(inversion: impl Into<f64>, iterations: u32, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("apollonian", Params::new().number(inversion).number(iterations).number(thickness))
}

/// A kaleidoscopic iterated function system: fold into an eighth and a sixth of space, turn, scale, again.
///
/// Source: Knighty 2010.
///
/// - `iterations`: Steps of folding, turning and scaling. A whole number, 1 to 24.
/// - `factor`: How much every step scales. A plain number, 1.1 to 4.
/// - `twist`: Turn about z before every step's scaling. Radians, -7 to 7.
/// - `tilt`: Turn about x before every step's scaling. Radians, -7 to 7.
/// - `offset`: The corner that every step scales about. Scene units, -4 to 4.
pub fn kaleidoscope(iterations: u32, factor: impl Into<f64>, twist: impl Into<f64>, tilt: impl Into<f64>, offset: impl Into<DVec3>) -> Shape {
    Shape::primitive("kaleidoscope", Params::new().number(iterations).number(factor).number(twist).number(tilt).vec3(offset))
}

/// A disc around the origin.
///
/// - `radius`: Distance from the centre to the edge. Scene units, 1e-9 to 1e9.
pub fn circle(radius: impl Into<f64>) -> Shape {
    Shape::primitive("circle", Params::new().number(radius))
}

/// A straight line with round ends.
///
/// - `start`: Where it begins. Scene units, -1e9 to 1e9.
/// - `end`: Where it ends. Scene units, -1e9 to 1e9.
/// - `thickness`: Full width of the line. Scene units, 1e-9 to 1e9.
pub fn segment(start: impl Into<DVec2>, end: impl Into<DVec2>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("segment", Params::new().vec2(start).vec2(end).number(thickness))
}

/// A rectangle around the origin.
///
/// - `size`: Full sides along x and y. Scene units, 1e-9 to 1e9.
pub fn rectangle(size: impl Into<DVec2>) -> Shape {
    Shape::primitive("rectangle", Params::new().vec2(size))
}

/// A rectangle with rounded corners, all alike or each its own.
///
/// - `size`: Full sides along x and y. Scene units, 1e-9 to 1e9.
/// - `radius`: Radius of the corners. Scene units, 0 to 1e9.
/// - `top_right`: Radius of this corner; -1 stands for `radius`. Scene units, -1 to 1e9.
/// - `bottom_right`: Radius of this corner; -1 stands for `radius`. Scene units, -1 to 1e9.
/// - `bottom_left`: Radius of this corner; -1 stands for `radius`. Scene units, -1 to 1e9.
/// - `top_left`: Radius of this corner; -1 stands for `radius`. Scene units, -1 to 1e9.
pub fn rounded_rectangle(size: impl Into<DVec2>, radius: impl Into<f64>, top_right: impl Into<f64>, bottom_right: impl Into<f64>, bottom_left: impl Into<f64>, top_left: impl Into<f64>) -> Shape {
    Shape::primitive("rounded_rectangle", Params::new().vec2(size).number(radius).number(top_right).number(bottom_right).number(bottom_left).number(top_left))
}

/// A rectangle with its corners cut off at 45 degrees.
///
/// - `size`: Full sides along x and y. Scene units, 1e-9 to 1e9.
/// - `chamfer`: How much of each side a corner loses. Scene units, 0 to 1e9.
pub fn chamfered_rectangle(size: impl Into<DVec2>, chamfer: impl Into<f64>) -> Shape {
    Shape::primitive("chamfered_rectangle", Params::new().vec2(size).number(chamfer))
}

/// A rhombus with its corners on the axes.
///
/// - `size`: Full diagonals along x and y. Scene units, 1e-9 to 1e9.
pub fn diamond(size: impl Into<DVec2>) -> Shape {
    Shape::primitive("diamond", Params::new().vec2(size))
}

/// A trapezoid with two equal legs, around the origin.
///
/// - `bottom`: Length of the lower side. Scene units, 1e-9 to 1e9.
/// - `top`: Length of the upper side; 0 makes a triangle. Scene units, 0 to 1e9.
/// - `height`: Distance between the two. Scene units, 1e-9 to 1e9.
pub fn trapezoid(bottom: impl Into<f64>, top: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("trapezoid", Params::new().number(bottom).number(top).number(height))
}

/// A parallelogram with two level sides, around the origin.
///
/// - `width`: Length of the level sides. Scene units, 1e-9 to 1e9.
/// - `height`: Distance between them. Scene units, 1e-9 to 1e9.
/// - `skew`: How far the upper side is moved along x against the lower. Scene units, -1e9 to 1e9.
pub fn parallelogram(width: impl Into<f64>, height: impl Into<f64>, skew: impl Into<f64>) -> Shape {
    Shape::primitive("parallelogram", Params::new().number(width).number(height).number(skew))
}

/// A triangle of the plane between three points.
///
/// - `a`: First corner. Scene units, -1e9 to 1e9.
/// - `b`: Second corner. Scene units, -1e9 to 1e9.
/// - `c`: Third corner. Scene units, -1e9 to 1e9.
pub fn triangle2d(a: impl Into<DVec2>, b: impl Into<DVec2>, c: impl Into<DVec2>) -> Shape {
    Shape::primitive("triangle2d", Params::new().vec2(a).vec2(b).vec2(c))
}

/// A regular polygon with a corner at the top.
///
/// - `sides`: How many sides. A whole number, 3 to 1000.
/// - `radius`: Distance from the centre to a corner. Scene units, 1e-9 to 1e9.
pub fn ngon(sides: u32, radius: impl Into<f64>) -> Shape {
    Shape::primitive("ngon", Params::new().number(sides).number(radius))
}

/// A star with a point at the top.
///
/// - `points`: How many points. A whole number, 3 to 1000.
/// - `radius`: Distance from the centre to a point. Scene units, 1e-9 to 1e9.
/// - `inner`: Distance from the centre to a notch. Scene units, 1e-9 to 1e9.
pub fn star(points: u32, radius: impl Into<f64>, inner: impl Into<f64>) -> Shape {
    Shape::primitive("star", Params::new().number(points).number(radius).number(inner))
}

/// A sector of a disc around +y.
///
/// - `angle`: Opening of the sector. Radians, 0.001 to 6.2832.
/// - `radius`: Radius of the disc. Scene units, 1e-9 to 1e9.
pub fn pie(angle: impl Into<f64>, radius: impl Into<f64>) -> Shape {
    Shape::primitive("pie", Params::new().number(angle).number(radius))
}

/// A part of a circle around +y, drawn with a thick line with round ends.
///
/// - `angle`: How much of the circle. Radians, 0.001 to 6.2832.
/// - `radius`: Radius of the middle of the line. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full width of the line. Scene units, 1e-9 to 1e9.
pub fn arc(angle: impl Into<f64>, radius: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("arc", Params::new().number(angle).number(radius).number(thickness))
}

/// A circle drawn with a thick line.
///
/// - `radius`: Distance from the centre to the middle of the line. Scene units, 1e-9 to 1e9.
/// - `thickness`: Full width of the line. Scene units, 1e-9 to 1e9.
pub fn ring(radius: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("ring", Params::new().number(radius).number(thickness))
}

/// A bend around +y that goes on in two straight legs with square ends.
///
/// - `angle`: How much of a circle the bend is. Radians, 0.001 to 6.2.
/// - `radius`: Radius of the middle of the line. Scene units, 1e-9 to 1e9.
/// - `length`: Length of each leg. Scene units, 0 to 1e9.
/// - `thickness`: Full width of the line. Scene units, 1e-9 to 1e9.
pub fn horseshoe(angle: impl Into<f64>, radius: impl Into<f64>, length: impl Into<f64>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("horseshoe", Params::new().number(angle).number(radius).number(length).number(thickness))
}

/// A lens: what two equal discs side by side have in common.
///
/// - `size`: Full width and height, the height not less than the width. Scene units, 1e-9 to 1e9.
pub fn vesica(size: impl Into<DVec2>) -> Shape {
    Shape::primitive("vesica", Params::new().vec2(size))
}

/// A disc with a bite: a crescent that opens along +x.
///
/// - `radius`: Radius of the disc. Scene units, 1e-9 to 1e9.
/// - `bite`: Radius of the bite. Scene units, 1e-9 to 1e9.
/// - `offset`: How far along x the bite's centre is from the disc's. Scene units, 1e-9 to 1e9.
pub fn moon(radius: impl Into<f64>, bite: impl Into<f64>, offset: impl Into<f64>) -> Shape {
    Shape::primitive("moon", Params::new().number(radius).number(bite).number(offset))
}

/// A heart with its tip down: a square and two half discs.
///
/// - `height`: Full height. Scene units, 1e-9 to 1e9.
pub fn heart(height: impl Into<f64>) -> Shape {
    Shape::primitive("heart", Params::new().number(height))
}

/// An egg of four arcs, its tip up; the big end's centre is the origin.
///
/// Source: Moss's egg (Dixon 1987, Mathographics).
///
/// - `radius`: Radius of the big end. Scene units, 1e-9 to 1e9.
/// - `tip`: Radius of the tip. Scene units, 0 to 1e9.
pub fn egg(radius: impl Into<f64>, tip: impl Into<f64>) -> Shape {
    Shape::primitive("egg", Params::new().number(radius).number(tip))
}

/// Two equal bars crossed at right angles.
///
/// - `size`: Full length of the bars. Scene units, 1e-9 to 1e9.
/// - `width`: Full width of the bars. Scene units, 1e-9 to 1e9.
pub fn cross(size: impl Into<f64>, width: impl Into<f64>) -> Shape {
    Shape::primitive("cross", Params::new().number(size).number(width))
}

/// An ellipse with its axes along x and y.
///
/// Source: foot point by Newton's method on a convex function, after Eberly 2013, Distance from a Point to an Ellipse.
///
/// - `size`: Full axes along x and y. Scene units, 1e-9 to 1e9.
pub fn ellipse(size: impl Into<DVec2>) -> Shape {
    Shape::primitive("ellipse", Params::new().vec2(size))
}

/// The region under a parabolic arch that stands on the x axis.
///
/// Source: foot point by the cubic s^3 + s (1 - 2 k y) / (2 k^2) = x / (2 k^2).
///
/// - `width`: Full width at the foot. Scene units, 1e-9 to 1e9.
/// - `height`: Height of the arch. Scene units, 1e-9 to 1e9.
pub fn parabola(width: impl Into<f64>, height: impl Into<f64>) -> Shape {
    Shape::primitive("parabola", Params::new().number(width).number(height))
}

/// A quadratic Bezier curve of the plane, drawn with a thick line with round ends.
///
/// Source: distance by the cubic of the foot point, as for a parabola.
///
/// - `start`: Where it begins. Scene units, -1e9 to 1e9.
/// - `control`: Where the tangents of both ends meet. Scene units, -1e9 to 1e9.
/// - `end`: Where it ends. Scene units, -1e9 to 1e9.
/// - `thickness`: Full width of the line. Scene units, 1e-9 to 1e9.
pub fn bezier2d(start: impl Into<DVec2>, control: impl Into<DVec2>, end: impl Into<DVec2>, thickness: impl Into<f64>) -> Shape {
    Shape::primitive("bezier2d", Params::new().vec2(start).vec2(control).vec2(end).number(thickness))
}

/// The region within a closed line through any number of points.
///
/// Source: sign by the number of crossings (Shimrat 1962), even for outside.
///
/// - `points`: The corners in their order, either way round. Scene units, -1e9 to 1e9.
pub fn polygon(points: impl IntoIterator<Item = impl Into<DVec2>>) -> Shape {
    Shape::primitive("polygon", Params::new().points2(points))
}

/// The region within closed contours with holes: letters, drawings.
///
/// Source: sign by the winding number (Sunday 2001), zero for outside.
///
/// - `segments`: Start and end of every straight piece; holes run the other way round. Scene units, -1e9 to 1e9.
pub fn outline(segments: impl IntoIterator<Item = [impl Into<DVec2>; 2]>) -> Shape {
    Shape::primitive("outline", Params::new().segments(segments))
}

/// Between a circle and a square: a mix of their implicit equations.
///
/// Source: Munini 2021, section 2.2, as the gauge of its convex curve.
///
/// - `size`: Full width and height. Scene units, 1e-9 to 1e9.
/// - `squareness`: 0 is the circle, 1 the square. A plain number, 0 to 1.
pub fn squircle(size: impl Into<f64>, squareness: impl Into<f64>) -> Shape {
    Shape::primitive("squircle", Params::new().number(size).number(squareness))
}

/// What lies in either shape. Of any number of shapes, from left to right.
///
/// Source: Ricci 1973.
pub fn union(shapes: impl IntoIterator<Item = impl Into<Shape>>) -> Shape {
    Shape::join("union", Params::new(), shapes)
}

/// What lies in both shapes. Of any number of shapes, from left to right.
///
/// Source: Ricci 1973.
pub fn intersection(shapes: impl IntoIterator<Item = impl Into<Shape>>) -> Shape {
    Shape::join("intersection", Params::new(), shapes)
}

/// The first shape without the second. Of any number of shapes, from left to right.
///
/// Source: Ricci 1973.
pub fn subtraction(shapes: impl IntoIterator<Item = impl Into<Shape>>) -> Shape {
    Shape::join("subtraction", Params::new(), shapes)
}

/// What lies in one shape and not in both. Of any number of shapes, from left to right.
///
/// Source: Ricci 1973.
pub fn xor(shapes: impl IntoIterator<Item = impl Into<Shape>>) -> Shape {
    Shape::join("xor", Params::new(), shapes)
}

/// A shape on the way from the first to the second. Of any number of shapes, from left to right.
///
/// Source: Munini 2021, 2.3.
///
/// - `t`: 0 is the first shape, 1 the second. A plain number, 0 to 1.
pub fn mix(shapes: impl IntoIterator<Item = impl Into<Shape>>, t: impl Into<f64>) -> Shape {
    Shape::join("mix", Params::new().number(t), shapes)
}

/// Union with a smooth inner edge. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (quadratic).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_union(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_union", Params::new().number(radius), shapes)
}

/// Intersection with a smooth outer edge. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (quadratic).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_intersection(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_intersection", Params::new().number(radius), shapes)
}

/// Subtraction with a smooth outer edge. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (quadratic).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_subtraction(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_subtraction", Params::new().number(radius), shapes)
}

/// Union with a smooth inner edge whose curvature fades out. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (cubic).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_union_cubic(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_union_cubic", Params::new().number(radius), shapes)
}

/// Intersection with a smooth outer edge whose curvature fades out. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (cubic).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_intersection_cubic(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_intersection_cubic", Params::new().number(radius), shapes)
}

/// Subtraction with a smooth outer edge whose curvature fades out. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (cubic).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_subtraction_cubic(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_subtraction_cubic", Params::new().number(radius), shapes)
}

/// Union with an inner edge that is a circular arc between walls at right angles. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (circular geometrical).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_union_circular(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_union_circular", Params::new().number(radius), shapes)
}

/// Intersection with an outer edge that is a circular arc between walls at right angles. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (circular geometrical).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_intersection_circular(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_intersection_circular", Params::new().number(radius), shapes)
}

/// Subtraction with an outer edge that is a circular arc between walls at right angles. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (circular geometrical).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_subtraction_circular(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_subtraction_circular", Params::new().number(radius), shapes)
}

/// Smooth union that does not depend on the order of its shapes. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (exponential).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_union_exponential(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_union_exponential", Params::new().number(radius), shapes)
}

/// Smooth intersection that does not depend on the order of its shapes. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (exponential).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_intersection_exponential(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_intersection_exponential", Params::new().number(radius), shapes)
}

/// Subtraction with a smooth outer edge that fades out slowly. Of any number of shapes, from left to right.
///
/// Source: Quilez 2013, smooth minimum (exponential).
///
/// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
pub fn smooth_subtraction_exponential(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("smooth_subtraction_exponential", Params::new().number(radius), shapes)
}

/// Union with a flat slope over its inner edge. Of any number of shapes, from left to right.
///
/// Source: Profile: Mercury 2016, hg_sdf, chamfer.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
pub fn chamfer_union(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("chamfer_union", Params::new().number(radius), shapes)
}

/// Intersection with its outer edge cut off. Of any number of shapes, from left to right.
///
/// Source: Profile: Mercury 2016, hg_sdf, chamfer.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
pub fn chamfer_intersection(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("chamfer_intersection", Params::new().number(radius), shapes)
}

/// Subtraction with its outer edge cut off. Of any number of shapes, from left to right.
///
/// Source: Profile: Mercury 2016, hg_sdf, chamfer.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
pub fn chamfer_subtraction(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("chamfer_subtraction", Params::new().number(radius), shapes)
}

/// Union with a circular fillet, offsets of which are circular too. Of any number of shapes, from left to right.
///
/// Source: Mercury 2016, hg_sdf, round.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
pub fn round_union(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("round_union", Params::new().number(radius), shapes)
}

/// Intersection with a circular outer edge, offsets of which are circular too. Of any number of shapes, from left to right.
///
/// Source: Mercury 2016, hg_sdf, round.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
pub fn round_intersection(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("round_intersection", Params::new().number(radius), shapes)
}

/// Subtraction with a circular outer edge, offsets of which are circular too. Of any number of shapes, from left to right.
///
/// Source: Mercury 2016, hg_sdf, round.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
pub fn round_subtraction(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("round_subtraction", Params::new().number(radius), shapes)
}

/// Union with stairs along its inner edge. Of any number of shapes, from left to right.
///
/// Source: After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
/// - `n`: Number of steps. A whole number, 1 to 1000.
pub fn stairs_union(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>, n: u32) -> Shape {
    Shape::join("stairs_union", Params::new().number(radius).number(n), shapes)
}

/// Intersection with stairs along its outer edge. Of any number of shapes, from left to right.
///
/// Source: After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
/// - `n`: Number of steps. A whole number, 1 to 1000.
pub fn stairs_intersection(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>, n: u32) -> Shape {
    Shape::join("stairs_intersection", Params::new().number(radius).number(n), shapes)
}

/// Subtraction with stairs along its outer edge. Of any number of shapes, from left to right.
///
/// Source: After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
/// - `n`: Number of steps. A whole number, 1 to 1000.
pub fn stairs_subtraction(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>, n: u32) -> Shape {
    Shape::join("stairs_subtraction", Params::new().number(radius).number(n), shapes)
}

/// Union with half columns along its inner edge. Of any number of shapes, from left to right.
///
/// Source: After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
/// - `n`: Number of columns. A whole number, 1 to 1000.
pub fn columns_union(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>, n: u32) -> Shape {
    Shape::join("columns_union", Params::new().number(radius).number(n), shapes)
}

/// Intersection with half-round grooves along its outer edge. Of any number of shapes, from left to right.
///
/// Source: After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
/// - `n`: Number of columns. A whole number, 1 to 1000.
pub fn columns_intersection(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>, n: u32) -> Shape {
    Shape::join("columns_intersection", Params::new().number(radius).number(n), shapes)
}

/// Subtraction with half-round grooves along its outer edge. Of any number of shapes, from left to right.
///
/// Source: After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends.
///
/// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
/// - `n`: Number of columns. A whole number, 1 to 1000.
pub fn columns_subtraction(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>, n: u32) -> Shape {
    Shape::join("columns_subtraction", Params::new().number(radius).number(n), shapes)
}

/// A pipe along the line where two surfaces meet; both shapes vanish. Of any number of shapes, from left to right.
///
/// Source: Mercury 2016, hg_sdf, pipe.
///
/// - `radius`: Radius of the pipe. Scene units, 1e-9 to 1e9.
pub fn pipe(shapes: impl IntoIterator<Item = impl Into<Shape>>, radius: impl Into<f64>) -> Shape {
    Shape::join("pipe", Params::new().number(radius), shapes)
}

/// Cuts a V-shaped groove into the first shape where the second one's surface meets it. Of any number of shapes, from left to right.
///
/// Source: Profile: Mercury 2016, hg_sdf, engrave.
///
/// - `depth`: Depth of the groove, and half its width. Scene units, 1e-9 to 1e9.
pub fn engrave(shapes: impl IntoIterator<Item = impl Into<Shape>>, depth: impl Into<f64>) -> Shape {
    Shape::join("engrave", Params::new().number(depth), shapes)
}

/// Cuts a groove with straight walls into the first shape where the second one's surface meets it. Of any number of shapes, from left to right.
///
/// Source: Mercury 2016, hg_sdf, groove.
///
/// - `depth`: How far it goes into or out of the first surface. Scene units, 1e-9 to 1e9.
/// - `width`: Full width. Scene units, 1e-9 to 1e9.
pub fn groove(shapes: impl IntoIterator<Item = impl Into<Shape>>, depth: impl Into<f64>, width: impl Into<f64>) -> Shape {
    Shape::join("groove", Params::new().number(depth).number(width), shapes)
}

/// Puts a rail with straight walls onto the first shape where the second one's surface meets it. Of any number of shapes, from left to right.
///
/// Source: Mercury 2016, hg_sdf, tongue.
///
/// - `depth`: How far it goes into or out of the first surface. Scene units, 1e-9 to 1e9.
/// - `width`: Full width. Scene units, 1e-9 to 1e9.
pub fn tongue(shapes: impl IntoIterator<Item = impl Into<Shape>>, depth: impl Into<f64>, width: impl Into<f64>) -> Shape {
    Shape::join("tongue", Params::new().number(depth).number(width), shapes)
}

/// # Maps of space
impl Shape {
    /// Shows the half of the shape at positive coordinates on both sides.
    ///
    /// - `axes`: 1 for every axis that is reflected, else 0. A whole number, 0 to 1.
    pub fn symmetry(&self, axes: impl Into<DVec3>) -> Shape {
        self.map("symmetry", Params::new().vec3(axes))
    }

    /// Shows what is in front of a plane also behind it, reflected.
    ///
    /// - `normal`: Points to the side that is kept. A direction of any length, -1e9 to 1e9.
    /// - `offset`: Distance of the plane from the origin, along the normal. Scene units, -1e9 to 1e9.
    pub fn mirror(&self, normal: impl Into<DVec3>, offset: impl Into<f64>) -> Shape {
        self.map("mirror", Params::new().vec3(normal).number(offset))
    }

    /// Cuts the shape at its middle, pulls the halves apart and fills the gap.
    ///
    /// Source: Quilez 2018, elongation.
    ///
    /// - `size`: How much longer along x, y and z. Scene units, 0 to 1e9.
    pub fn elongate(&self, size: impl Into<DVec3>) -> Shape {
        self.map("elongate", Params::new().vec3(size))
    }

    /// A solid from a 2D shape, turned about the y axis.
    ///
    /// Source: Quilez 2018, revolution.
    ///
    /// - `offset`: How far the shape's origin is from the axis. Scene units, -1e9 to 1e9.
    pub fn revolve(&self, offset: impl Into<f64>) -> Shape {
        self.map("revolve", Params::new().number(offset))
    }

    /// A 2D shape: the section of a solid across the z axis.
    ///
    /// - `at`: Where it is cut: z. Scene units, -1e9 to 1e9.
    pub fn slice(&self, at: impl Into<f64>) -> Shape {
        self.map("slice", Params::new().number(at))
    }

    /// Scales the shape by a factor of its own along each axis.
    ///
    /// - `factor`: Factors along x, y and z. A plain number, 0.001 to 1000.
    pub fn stretch(&self, factor: impl Into<DVec3>) -> Shape {
        self.map("stretch", Params::new().vec3(factor))
    }

    /// Leans the shape: moves it along x and z in proportion to its height y.
    ///
    /// - `x`: Way along x per unit of height. A plain number, -100 to 100.
    /// - `z`: Way along z per unit of height. A plain number, -100 to 100.
    pub fn shear(&self, x: impl Into<f64>, z: impl Into<f64>) -> Shape {
        self.map("shear", Params::new().number(x).number(z))
    }

    /// Turns the shape about the y axis, the more the higher.
    ///
    /// Source: Barr 1984, global twisting.
    ///
    /// - `rate`: Turn per unit of height. Radians a scene unit, -1e9 to 1e9.
    pub fn twist(&self, rate: impl Into<f64>) -> Shape {
        self.map("twist", Params::new().number(rate))
    }

    /// Scales the shape in x and z, from its full size at the bottom to another at the top.
    ///
    /// Source: Barr 1984, global tapering.
    ///
    /// - `height`: Height over which the size changes, half on each side of y = 0. Scene units, 1e-9 to 1e9.
    /// - `top`: Scale at the top; 1 at the bottom. A plain number, 0.01 to 100.
    pub fn taper(&self, height: impl Into<f64>, top: impl Into<f64>) -> Shape {
        self.map("taper", Params::new().number(height).number(top))
    }

    /// Bends the shape's x axis along a circular arc towards y; beyond the arc it goes on straight.
    ///
    /// Source: Barr 1984, global linear bends.
    ///
    /// - `angle`: Angle between the two ends; negative bends towards -y. Radians, -3.1416 to 3.1416.
    /// - `length`: Length of the part that is bent, half on each side of x = 0. Scene units, 1e-9 to 1e9.
    pub fn bend(&self, angle: impl Into<f64>, length: impl Into<f64>) -> Shape {
        self.map("bend", Params::new().number(angle).number(length))
    }

    /// Wraps the shape's x axis around the y axis; what faced z faces away from the axis.
    ///
    /// Source: Barr 1984, global linear bends.
    ///
    /// - `radius`: Distance from the y axis at which lengths stay. Scene units, 1e-9 to 1e9.
    pub fn wrap(&self, radius: impl Into<f64>) -> Shape {
        self.map("wrap", Params::new().number(radius))
    }
}

/// # Changes of the field
impl Shape {
    /// All that is not in the shape.
    ///
    /// Source: Ricci 1973.
    pub fn complement(&self) -> Shape {
        self.modify("complement", Params::new())
    }

    /// Moves the surface out, or in where the distance is negative.
    ///
    /// - `distance`: How far; negative moves inwards. Scene units, -1e9 to 1e9.
    pub fn offset(&self, distance: impl Into<f64>) -> Shape {
        self.modify("offset", Params::new().number(distance))
    }

    /// Grows the shape, which rounds its outer edges.
    ///
    /// Source: Quilez 2008.
    ///
    /// - `radius`: How far the surface moves out. Scene units, 0 to 1e9.
    pub fn round(&self, radius: impl Into<f64>) -> Shape {
        self.modify("round", Params::new().number(radius))
    }

    /// A shell along the surface.
    ///
    /// Source: Quilez 2008.
    ///
    /// - `thickness`: Thickness of the shell, half on each side of the surface. Scene units, 0 to 1e9.
    pub fn onion(&self, thickness: impl Into<f64>) -> Shape {
        self.modify("onion", Params::new().number(thickness))
    }

    /// A solid from a 2D shape, pulled along z.
    ///
    /// Source: Quilez 2018, extrusion.
    ///
    /// - `height`: Full height of the solid, half on each side of z = 0. Scene units, 1e-9 to 1e9.
    pub fn extrude(&self, height: impl Into<f64>) -> Shape {
        self.modify("extrude", Params::new().number(height))
    }

    /// Moves the surface by a product of sines along x, y and z.
    ///
    /// Source: Quilez 2008.
    ///
    /// - `amplitude`: How far the surface moves where the pattern is 1; negative moves inwards. Scene units, -1e9 to 1e9.
    /// - `frequency`: Waves per unit of length. Cycles a scene unit, 0 to 10000.
    pub fn displace(&self, amplitude: impl Into<f64>, frequency: impl Into<f64>) -> Shape {
        self.modify("displace", Params::new().number(amplitude).number(frequency))
    }

    /// Moves the surface by value noise: soft, blotchy bumps.
    ///
    /// Source: Perlin 1985; fractal sum: Musgrave 1993.
    ///
    /// - `amplitude`: How far the surface moves where the pattern is 1; negative moves inwards. Scene units, -1e9 to 1e9.
    /// - `frequency`: Cells of the noise per unit of length. Cycles a scene unit, 0 to 10000.
    /// - `octaves`: Layers, each finer and weaker than the one before. A whole number, 1 to 16.
    /// - `lacunarity`: How much finer each layer is. A plain number, 1 to 8.
    /// - `gain`: How strong each layer is, beside the one before. A plain number, 0 to 1.
    pub fn displace_value(&self, amplitude: impl Into<f64>, frequency: impl Into<f64>, octaves: u32, lacunarity: impl Into<f64>, gain: impl Into<f64>) -> Shape {
        self.modify("displace_value", Params::new().number(amplitude).number(frequency).number(octaves).number(lacunarity).number(gain))
    }

    /// Moves the surface by gradient noise: even, natural roughness.
    ///
    /// Source: Perlin 2002; fractal sum: Musgrave 1993.
    ///
    /// - `amplitude`: How far the surface moves where the pattern is 1; negative moves inwards. Scene units, -1e9 to 1e9.
    /// - `frequency`: Cells of the noise per unit of length. Cycles a scene unit, 0 to 10000.
    /// - `octaves`: Layers, each finer and weaker than the one before. A whole number, 1 to 16.
    /// - `lacunarity`: How much finer each layer is. A plain number, 1 to 8.
    /// - `gain`: How strong each layer is, beside the one before. A plain number, 0 to 1.
    pub fn displace_gradient(&self, amplitude: impl Into<f64>, frequency: impl Into<f64>, octaves: u32, lacunarity: impl Into<f64>, gain: impl Into<f64>) -> Shape {
        self.modify("displace_gradient", Params::new().number(amplitude).number(frequency).number(octaves).number(lacunarity).number(gain))
    }

    /// Moves the surface by cellular noise: dents with ridges between them.
    ///
    /// Source: Worley 1996; fractal sum: Musgrave 1993.
    ///
    /// - `amplitude`: How far the surface moves where the pattern is 1; negative moves inwards. Scene units, -1e9 to 1e9.
    /// - `frequency`: Cells of the noise per unit of length. Cycles a scene unit, 0 to 10000.
    /// - `octaves`: Layers, each finer and weaker than the one before. A whole number, 1 to 16.
    /// - `lacunarity`: How much finer each layer is. A plain number, 1 to 8.
    /// - `gain`: How strong each layer is, beside the one before. A plain number, 0 to 1.
    pub fn displace_cellular(&self, amplitude: impl Into<f64>, frequency: impl Into<f64>, octaves: u32, lacunarity: impl Into<f64>, gain: impl Into<f64>) -> Shape {
        self.modify("displace_cellular", Params::new().number(amplitude).number(frequency).number(octaves).number(lacunarity).number(gain))
    }
}

/// # Joins with another shape
impl Shape {
    /// What lies in either shape.
    ///
    /// Source: Ricci 1973.
    pub fn union(&self, other: impl Into<Shape>) -> Shape {
        Shape::join("union", Params::new(), [self.clone(), other.into()])
    }

    /// What lies in both shapes.
    ///
    /// Source: Ricci 1973.
    pub fn intersection(&self, other: impl Into<Shape>) -> Shape {
        Shape::join("intersection", Params::new(), [self.clone(), other.into()])
    }

    /// The first shape without the second.
    ///
    /// Source: Ricci 1973.
    pub fn subtraction(&self, other: impl Into<Shape>) -> Shape {
        Shape::join("subtraction", Params::new(), [self.clone(), other.into()])
    }

    /// What lies in one shape and not in both.
    ///
    /// Source: Ricci 1973.
    pub fn xor(&self, other: impl Into<Shape>) -> Shape {
        Shape::join("xor", Params::new(), [self.clone(), other.into()])
    }

    /// A shape on the way from the first to the second.
    ///
    /// Source: Munini 2021, 2.3.
    ///
    /// - `t`: 0 is the first shape, 1 the second. A plain number, 0 to 1.
    pub fn mix(&self, other: impl Into<Shape>, t: impl Into<f64>) -> Shape {
        Shape::join("mix", Params::new().number(t), [self.clone(), other.into()])
    }

    /// Union with a smooth inner edge.
    ///
    /// Source: Quilez 2013, smooth minimum (quadratic).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_union(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_union", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Intersection with a smooth outer edge.
    ///
    /// Source: Quilez 2013, smooth minimum (quadratic).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_intersection(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_intersection", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Subtraction with a smooth outer edge.
    ///
    /// Source: Quilez 2013, smooth minimum (quadratic).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_subtraction(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_subtraction", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Union with a smooth inner edge whose curvature fades out.
    ///
    /// Source: Quilez 2013, smooth minimum (cubic).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_union_cubic(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_union_cubic", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Intersection with a smooth outer edge whose curvature fades out.
    ///
    /// Source: Quilez 2013, smooth minimum (cubic).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_intersection_cubic(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_intersection_cubic", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Subtraction with a smooth outer edge whose curvature fades out.
    ///
    /// Source: Quilez 2013, smooth minimum (cubic).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_subtraction_cubic(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_subtraction_cubic", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Union with an inner edge that is a circular arc between walls at right angles.
    ///
    /// Source: Quilez 2013, smooth minimum (circular geometrical).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_union_circular(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_union_circular", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Intersection with an outer edge that is a circular arc between walls at right angles.
    ///
    /// Source: Quilez 2013, smooth minimum (circular geometrical).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_intersection_circular(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_intersection_circular", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Subtraction with an outer edge that is a circular arc between walls at right angles.
    ///
    /// Source: Quilez 2013, smooth minimum (circular geometrical).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_subtraction_circular(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_subtraction_circular", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Smooth union that does not depend on the order of its shapes.
    ///
    /// Source: Quilez 2013, smooth minimum (exponential).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_union_exponential(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_union_exponential", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Smooth intersection that does not depend on the order of its shapes.
    ///
    /// Source: Quilez 2013, smooth minimum (exponential).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_intersection_exponential(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_intersection_exponential", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Subtraction with a smooth outer edge that fades out slowly.
    ///
    /// Source: Quilez 2013, smooth minimum (exponential).
    ///
    /// - `radius`: Size of the smooth edge: where the operands differ by more, they stay. Scene units, 1e-9 to 1e9.
    pub fn smooth_subtraction_exponential(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("smooth_subtraction_exponential", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Union with a flat slope over its inner edge.
    ///
    /// Source: Profile: Mercury 2016, hg_sdf, chamfer.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    pub fn chamfer_union(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("chamfer_union", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Intersection with its outer edge cut off.
    ///
    /// Source: Profile: Mercury 2016, hg_sdf, chamfer.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    pub fn chamfer_intersection(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("chamfer_intersection", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Subtraction with its outer edge cut off.
    ///
    /// Source: Profile: Mercury 2016, hg_sdf, chamfer.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    pub fn chamfer_subtraction(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("chamfer_subtraction", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Union with a circular fillet, offsets of which are circular too.
    ///
    /// Source: Mercury 2016, hg_sdf, round.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    pub fn round_union(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("round_union", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Intersection with a circular outer edge, offsets of which are circular too.
    ///
    /// Source: Mercury 2016, hg_sdf, round.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    pub fn round_intersection(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("round_intersection", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Subtraction with a circular outer edge, offsets of which are circular too.
    ///
    /// Source: Mercury 2016, hg_sdf, round.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    pub fn round_subtraction(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("round_subtraction", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Union with stairs along its inner edge.
    ///
    /// Source: After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    /// - `n`: Number of steps. A whole number, 1 to 1000.
    pub fn stairs_union(&self, other: impl Into<Shape>, radius: impl Into<f64>, n: u32) -> Shape {
        Shape::join("stairs_union", Params::new().number(radius).number(n), [self.clone(), other.into()])
    }

    /// Intersection with stairs along its outer edge.
    ///
    /// Source: After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    /// - `n`: Number of steps. A whole number, 1 to 1000.
    pub fn stairs_intersection(&self, other: impl Into<Shape>, radius: impl Into<f64>, n: u32) -> Shape {
        Shape::join("stairs_intersection", Params::new().number(radius).number(n), [self.clone(), other.into()])
    }

    /// Subtraction with stairs along its outer edge.
    ///
    /// Source: After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    /// - `n`: Number of steps. A whole number, 1 to 1000.
    pub fn stairs_subtraction(&self, other: impl Into<Shape>, radius: impl Into<f64>, n: u32) -> Shape {
        Shape::join("stairs_subtraction", Params::new().number(radius).number(n), [self.clone(), other.into()])
    }

    /// Union with half columns along its inner edge.
    ///
    /// Source: After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    /// - `n`: Number of columns. A whole number, 1 to 1000.
    pub fn columns_union(&self, other: impl Into<Shape>, radius: impl Into<f64>, n: u32) -> Shape {
        Shape::join("columns_union", Params::new().number(radius).number(n), [self.clone(), other.into()])
    }

    /// Intersection with half-round grooves along its outer edge.
    ///
    /// Source: After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    /// - `n`: Number of columns. A whole number, 1 to 1000.
    pub fn columns_intersection(&self, other: impl Into<Shape>, radius: impl Into<f64>, n: u32) -> Shape {
        Shape::join("columns_intersection", Params::new().number(radius).number(n), [self.clone(), other.into()])
    }

    /// Subtraction with half-round grooves along its outer edge.
    ///
    /// Source: After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends.
    ///
    /// - `radius`: Size of the edge: how far up each wall it reaches. Scene units, 1e-9 to 1e9.
    /// - `n`: Number of columns. A whole number, 1 to 1000.
    pub fn columns_subtraction(&self, other: impl Into<Shape>, radius: impl Into<f64>, n: u32) -> Shape {
        Shape::join("columns_subtraction", Params::new().number(radius).number(n), [self.clone(), other.into()])
    }

    /// A pipe along the line where two surfaces meet; both shapes vanish.
    ///
    /// Source: Mercury 2016, hg_sdf, pipe.
    ///
    /// - `radius`: Radius of the pipe. Scene units, 1e-9 to 1e9.
    pub fn pipe(&self, other: impl Into<Shape>, radius: impl Into<f64>) -> Shape {
        Shape::join("pipe", Params::new().number(radius), [self.clone(), other.into()])
    }

    /// Cuts a V-shaped groove into the first shape where the second one's surface meets it.
    ///
    /// Source: Profile: Mercury 2016, hg_sdf, engrave.
    ///
    /// - `depth`: Depth of the groove, and half its width. Scene units, 1e-9 to 1e9.
    pub fn engrave(&self, other: impl Into<Shape>, depth: impl Into<f64>) -> Shape {
        Shape::join("engrave", Params::new().number(depth), [self.clone(), other.into()])
    }

    /// Cuts a groove with straight walls into the first shape where the second one's surface meets it.
    ///
    /// Source: Mercury 2016, hg_sdf, groove.
    ///
    /// - `depth`: How far it goes into or out of the first surface. Scene units, 1e-9 to 1e9.
    /// - `width`: Full width. Scene units, 1e-9 to 1e9.
    pub fn groove(&self, other: impl Into<Shape>, depth: impl Into<f64>, width: impl Into<f64>) -> Shape {
        Shape::join("groove", Params::new().number(depth).number(width), [self.clone(), other.into()])
    }

    /// Puts a rail with straight walls onto the first shape where the second one's surface meets it.
    ///
    /// Source: Mercury 2016, hg_sdf, tongue.
    ///
    /// - `depth`: How far it goes into or out of the first surface. Scene units, 1e-9 to 1e9.
    /// - `width`: Full width. Scene units, 1e-9 to 1e9.
    pub fn tongue(&self, other: impl Into<Shape>, depth: impl Into<f64>, width: impl Into<f64>) -> Shape {
        Shape::join("tongue", Params::new().number(depth).number(width), [self.clone(), other.into()])
    }
}
