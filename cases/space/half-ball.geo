// Half y > 0 of a ball of radius 1 about the origin, refined at (0, 0, -1) for contact: half-ball.msh
// within a tenth of its radius, half-ball-fine.msh (cells of half the size there) within a twentieth.
// scripts/make_meshes.py calls facets of the sphere above z = 0.9 `cap`.
//     gmsh -3 half-ball.geo -o half-ball.msh
DefineConstant[ fine = 0.045 ];         // edge length of a cell at the contact
DefineConstant[ reach = 0.15 ];         // distance from (0, 0, -1) up to which cells are fine
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Point(1) = {0, 0, 0};
Point(2) = {-1, 0, 0};
Point(3) = {1, 0, 0};
Point(4) = {0, 1, 0};
Point(5) = {0, 0, -1};
Point(6) = {0, 0, 1};

// The circle in y = 0, and arcs from it to (0, 1, 0).
Circle(1) = {2, 1, 5};
Circle(2) = {5, 1, 3};
Circle(3) = {3, 1, 6};
Circle(4) = {6, 1, 2};
Circle(5) = {2, 1, 4};
Circle(6) = {5, 1, 4};
Circle(7) = {3, 1, 4};
Circle(8) = {6, 1, 4};

Curve Loop(1) = {1, 6, -5};
Surface(1) = {1} In Sphere {1};
Curve Loop(2) = {2, 7, -6};
Surface(2) = {2} In Sphere {1};
Curve Loop(3) = {3, 8, -7};
Surface(3) = {3} In Sphere {1};
Curve Loop(4) = {4, 5, -8};
Surface(4) = {4} In Sphere {1};
Curve Loop(5) = {1, 2, 3, 4};
Plane Surface(5) = {5};
Surface Loop(1) = {1, 2, 3, 4, 5};
Volume(1) = {1};

Field[1] = MathEval;
Field[1].F = Sprintf("Min(0.4, %g + 0.4*Max(0, Sqrt(x*x + y*y + (z + 1)*(z + 1)) - %g))", fine, reach);
Background Field = 1;

Physical Surface("sphere") = {1, 2, 3, 4};
Physical Surface("plane_y") = {5};
Physical Volume("ball") = {1};
