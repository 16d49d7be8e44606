// A quarter of a cup upside down, a shell of revolution.
//     gmsh -3 cup.geo -o cup.msh
SetFactory("OpenCASCADE");
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
radius = 1.0;
thick = 0.06;
height = 1.5;
corner = 0.35;

// The profile in y = 0: wall, rounded corner and bottom (above), first outside, then inside.
Point(1) = {radius - corner, 0, height - corner};
Point(2) = {radius, 0, 0};
Point(3) = {radius, 0, height - corner};
Point(4) = {radius - corner, 0, height};
Point(5) = {0, 0, height};
Point(6) = {0, 0, height - thick};
Point(7) = {radius - corner, 0, height - thick};
Point(8) = {radius - thick, 0, height - corner};
Point(9) = {radius - thick, 0, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Line(4) = {5, 6};
Line(5) = {6, 7};
Circle(6) = {7, 1, 8};
Line(7) = {8, 9};
Line(8) = {9, 2};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8};
Plane Surface(1) = {1};
// The surface at x = 0, the volume, and a surface for every curve but the one on the axis, 4.
turned[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/2} { Surface{1}; };

Field[1] = MathEval;
Field[1].F = "0.22";
Background Field = 1;

Physical Volume("cup") = {turned[1]};
Physical Surface("rim") = {turned[8]};
Physical Surface("plane_x") = {turned[0]};
Physical Surface("plane_y") = {1};
// The inside of the rounded corner, 6, is one of the outer surfaces.
Physical Surface("outer") = {turned[2], turned[3], turned[4], turned[6]};
Physical Surface("inner") = {turned[5], turned[7]};
