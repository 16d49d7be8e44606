// Quarter x, y > 0 of a ring of radii 1 and 2, for Lamé's solution and the inflation of a ring.
//     gmsh -2 ring.geo -o ring.msh
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 3;
h = 0.25;       // edge length of a cell

Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {2, 0, 0, h};
Point(4) = {0, 2, 0, h};
Point(5) = {0, 1, 0, h};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Surface("ring") = {1};
Physical Curve("bottom") = {1};      // y = 0
Physical Curve("outer") = {2};
Physical Curve("left") = {3};        // x = 0
Physical Curve("inner") = {4};
