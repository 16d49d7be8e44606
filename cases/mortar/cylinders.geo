// Quarters of two cylinders of radius 1 that touch at the origin, refined there for contact over a
// half-width of 0.02: cells of 0.00125 above and of 0.0017 below, so that no nodes match.
//     gmsh -2 cylinders.geo -o cylinders.msh
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Point(1) = {0, 0, 0};
Point(2) = {1, 1, 0};
Point(3) = {0, 1, 0};
Circle(1) = {1, 3, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Point(4) = {0, 0, 0};
Point(5) = {1, -1, 0};
Point(6) = {0, -1, 0};
Circle(4) = {5, 6, 4};
Line(5) = {4, 6};
Line(6) = {6, 5};
Curve Loop(2) = {4, 5, 6};
Plane Surface(2) = {2};

// Within 0.03 of the contact, growing to 0.2.
Field[1] = MathEval;
Field[1].F = "Min(0.2, 0.001475 - 0.000225*y/(Abs(y) + 0.0000001) + 0.25*Max(0, Sqrt(x*x + y*y) - 0.03))";
Background Field = 1;

Physical Surface("upper") = {1};
Physical Surface("lower") = {2};
Physical Curve("arc") = {1, 4};
Physical Curve("cut") = {2, 6};      // y = ±1
Physical Curve("axis") = {3, 5};     // x = 0
