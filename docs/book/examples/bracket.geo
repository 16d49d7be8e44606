// An angle bracket of 50 mm with a rib and three holes.
//     gmsh -3 bracket.geo -o bracket.msh
SetFactory("OpenCASCADE");
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 8;

// In units of 50 mm: foot, wall, and the triangle of the rib between them.
Box(1) = {0, 0, 0, 1, 0.8, 0.16};
Box(2) = {0, 0, 0, 0.16, 0.8, 1};
Point(17) = {0.1, 0.34, 0.1};
Point(18) = {0.75, 0.34, 0.1};
Point(19) = {0.1, 0.34, 0.75};
Line(25) = {17, 18};
Line(26) = {18, 19};
Line(27) = {19, 17};
Curve Loop(13) = {25, 26, 27};
Plane Surface(13) = {13};
rib[] = Extrude {0, 0.12, 0} { Surface{13}; };
whole[] = BooleanUnion{ Volume{1}; Delete; }{ Volume{2, rib[1]}; Delete; };

Cylinder(101) = {0.72, 0.17, -1, 0, 0, 2, 0.09};
Cylinder(102) = {0.72, 0.63, -1, 0, 0, 2, 0.09};
Cylinder(103) = {-1, 0.4, 0.86, 2, 0, 0, 0.07};
part[] = BooleanDifference{ Volume{whole[]}; Delete; }{ Volume{101, 102, 103}; Delete; };
Dilate {{0, 0, 0}, {50, 50, 50}} { Volume{part[]}; }

Field[1] = MathEval;
Field[1].F = "11";
Background Field = 1;

Physical Volume("bracket") = Volume{:};
Physical Surface("skin") = Surface{:};
