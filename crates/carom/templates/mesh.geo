// A half cylinder above a prism. To generate the mesh: gmsh -2 -order 3 mesh.geo -o mesh.msh
SetFactory("Built-in");
Mesh.MshFileVersion = 4.1;
Mesh.HighOrderOptimize = 1;
r = 0.5;
h = 0.2;        // edge length of a cell

Point(1) = {0, 0.5, 0, h};
Point(2) = {r, 1, 0, h};
Point(3) = {0, 1.5, 0, h};
Point(4) = {0, 1, 0, h};
Circle(1) = {1, 4, 2};
Circle(2) = {2, 4, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Point(5) = {0, -0.5, 0, h};
Point(6) = {1, -0.5, 0, h};
Point(7) = {1, 0, 0, h};
Point(8) = {0, 0, 0, h};
Line(4) = {5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 5};
Curve Loop(2) = {4, 5, 6, 7};
Plane Surface(2) = {2};

// A case refers to bodies and sides by these names.
Physical Surface("cylinder") = {1};
Physical Surface("prism") = {2};
Physical Curve("arc") = {1, 2};
Physical Curve("axis") = {3, 7};
Physical Curve("bottom") = {4};
Physical Curve("right") = {5};
Physical Curve("top") = {6};
