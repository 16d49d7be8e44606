// A strip of two materials, 0 ≤ x ≤ 1 and 1 ≤ x ≤ 3, of height 0.1: quadrilaterals.
//     gmsh -2 bar.geo -o bar.msh
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 1;
DefineConstant[ n = 50 ];       // cells along the first material, as long as those of the second
h = 0.1;

Point(1) = {0, 0, 0};
Point(2) = {1, 0, 0};
Point(3) = {3, 0, 0};
Point(4) = {3, h, 0};
Point(5) = {1, h, 0};
Point(6) = {0, h, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve{1, 5} = n + 1;
Transfinite Curve{2, 4} = 2 * n + 1;
Transfinite Curve{3, 6, 7} = 3;
Transfinite Surface{1, 2};
Recombine Surface{1, 2};

Physical Surface("first") = {1};
Physical Surface("second") = {2};
Physical Curve("left") = {6};
Physical Curve("right") = {3};
Physical Curve("bottom") = {1, 2};
Physical Curve("top") = {4, 5};
