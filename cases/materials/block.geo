// The layers of laminate.geo as blocks of depth 0.5 in space. No group is the whole body, which
// consists of the groups of its materials.
//     gmsh -3 block.geo -o block.msh
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 1;
h = 0.4;        // edge length of a cell

Point(1) = {0, 0, 0, h};
Point(2) = {0, 1, 0, h};
Point(3) = {0, 1, 0.5, h};
Point(4) = {0, 0, 0.5, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
one[] = Extrude {0.4, 0, 0} { Surface{1}; };
two[] = Extrude {0.8, 0, 0} { Surface{one[0]}; };
three[] = Extrude {0.4, 0, 0} { Surface{two[0]}; };

Physical Volume("stiff") = {one[1], three[1]};
Physical Volume("soft") = {two[1]};
Physical Surface("left") = {1};
Physical Surface("right") = {three[0]};
Physical Surface("back") = {one[2], two[2], three[2]};        // z = 0
Physical Surface("top") = {one[3], two[3], three[3]};         // y = 1
Physical Surface("front") = {one[4], two[4], three[4]};       // z = 0.5
Physical Surface("bottom") = {one[5], two[5], three[5]};      // y = 0
