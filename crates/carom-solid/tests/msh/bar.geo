// A bar along x with named ends.
//     gmsh -1 bar.geo -o bar.msh
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 3;
Mesh.HighOrderOptimize = 1;

Point(1) = {0, 0, 0, 0.5};
Point(2) = {2, 0, 0, 0.5};
Line(1) = {1, 2};

Physical Curve("bar") = {1};
Physical Point("left") = {1};
Physical Point("right") = {2};
