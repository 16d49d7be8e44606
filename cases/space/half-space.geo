// Quarter x, y > 0 of the half z < 0 of a ball of radius 0.4 about the origin, refined at the circle of
// radius 0.1 in z = 0, the edge of a contact.
//     gmsh -3 half-space.geo -o half-space.msh
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
edge = 0.1;
reach = 0.4;

Point(1) = {0, 0, 0};
Point(2) = {edge, 0, 0};
Point(3) = {0, edge, 0};
Point(4) = {reach, 0, 0};
Point(5) = {0, reach, 0};
Point(6) = {0, 0, -reach};
Circle(1) = {2, 1, 3};
Line(2) = {1, 2};
Line(3) = {1, 3};
Line(4) = {2, 4};
Line(5) = {3, 5};
Line(6) = {1, 6};
Circle(7) = {4, 1, 5};
Circle(8) = {4, 1, 6};
Circle(9) = {5, 1, 6};

Curve Loop(1) = {2, 1, -3};
Plane Surface(1) = {1};
Curve Loop(2) = {4, 7, -5, -1};
Plane Surface(2) = {2};
Curve Loop(3) = {7, 9, -8};
Surface(3) = {3} In Sphere {1};
Curve Loop(4) = {2, 4, 8, -6};
Plane Surface(4) = {4};
Curve Loop(5) = {3, 5, 9, -6};
Plane Surface(5) = {5};
Surface Loop(1) = {1, 2, 3, 4, 5};
Volume(1) = {1};

Field[1] = MathEval;
Field[1].F = "0.006 + 0.4*Sqrt((Sqrt(x*x + y*y) - 0.1)^2 + z*z)";
Background Field = 1;

Physical Surface("touched") = {1};   // inside the circle
Physical Surface("free") = {2};
Physical Surface("far") = {3};
Physical Surface("plane_y") = {4};
Physical Surface("plane_x") = {5};
Physical Volume("ground") = {1};
