// A quarter of a ring of quadrangles, and hexahedra above it: sector.msh, and files of tests.
//     gmsh -3 -order 2 sector.geo -o sector.msh
Mesh.MshFileVersion = 4.1;

Point(1) = {0, 0, 0};
Point(2) = {1, 0, 0};
Point(3) = {0, 1, 0};
Point(4) = {2, 0, 0};
Point(5) = {0, 2, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {4, 1, 5};
Line(3) = {2, 4};
Line(4) = {3, 5};
Curve Loop(1) = {3, 2, -4, -1};
Plane Surface(1) = {1};
Transfinite Curve {1, 2} = 5;
Transfinite Curve {3, 4} = 4;
Transfinite Surface {1};
Recombine Surface {1};

// The lid, the volume, and the surface above each curve of the loop.
above[] = Extrude {0, 0, 0.5} { Surface{1}; Layers{2}; Recombine; };

Physical Curve("plane_y") = {3};
Physical Surface("plane_y") = {above[2]};
Physical Curve("outer") = {2};
Physical Surface("outer") = {above[3]};
Physical Curve("plane_x") = {4};
Physical Surface("plane_x") = {above[4]};
Physical Curve("inner") = {1};
Physical Surface("inner") = {above[5]};
Physical Surface("sector") = {1};
Physical Surface("lid") = {above[0]};
Physical Volume("wedge") = {above[1]};
