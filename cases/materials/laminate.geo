// Three layers across the x axis, 1.6 × 1: stiff, soft, stiff. Physical Surface("laminate") is all
// of them, and every triangle is also in the group of its material.
//     gmsh -2 laminate.geo -o laminate.msh
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 1;
h = 0.2;        // edge length of a cell

Point(1) = {0, 0, 0, h};
Point(2) = {0.4, 0, 0, h};
Point(3) = {1.2, 0, 0, h};
Point(4) = {1.6, 0, 0, h};
Point(5) = {1.6, 1, 0, h};
Point(6) = {1.2, 1, 0, h};
Point(7) = {0.4, 1, 0, h};
Point(8) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 1};
Line(9) = {2, 7};
Line(10) = {3, 6};
Curve Loop(1) = {1, 9, 7, 8};
Curve Loop(2) = {2, 10, 6, -9};
Curve Loop(3) = {3, 4, 5, -10};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};

Physical Surface("laminate") = {1, 2, 3};
Physical Surface("stiff") = {1, 3};
Physical Surface("soft") = {2};
Physical Curve("bottom") = {1, 2, 3};
Physical Curve("right") = {4};
Physical Curve("top") = {5, 6, 7};
Physical Curve("left") = {8};
