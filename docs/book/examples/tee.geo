// A quarter of a T-piece of a pipe.
//     gmsh -3 tee.geo -o tee.msh
SetFactory("OpenCASCADE");
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeMax = 0.22;
Mesh.MeshSizeFromCurvature = 12;

Cylinder(1) = {-2, 0, 0, 4, 0, 0, 0.5};
Cylinder(2) = {0, 0, 0, 0, 1.2, 0, 0.35};
outer[] = BooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(11) = {-2, 0, 0, 4, 0, 0, 0.3};
Cylinder(12) = {0, 0, 0, 0, 1.2, 0, 0.2};
inner[] = BooleanUnion{ Volume{11}; Delete; }{ Volume{12}; Delete; };
whole[] = BooleanDifference{ Volume{outer[]}; Delete; }{ Volume{inner[]}; Delete; };
Box(21) = {0, -1, 0, 2, 3, 1};
tee[] = BooleanIntersection{ Volume{whole[]}; Delete; }{ Volume{21}; Delete; };

// Surfaces by the boxes that hold them: the cuts, the ends, and the inside.
e = 1e-3;
far = 10;
plane_x[] = Surface In BoundingBox {-e, -far, -far, e, far, far};
plane_z[] = Surface In BoundingBox {-far, -far, -e, far, far, e};
end[] = Surface In BoundingBox {2 - e, -far, -far, far, far, far};
branch[] = Surface In BoundingBox {-far, 1.2 - e, -far, far, far, far};
bore[] = Surface In BoundingBox {-far, -far, -far, far, far, 0.3 + e};
bore[] -= plane_z[];
Physical Volume("tee") = {tee[]};
Physical Surface("plane_x") = {plane_x[]};
Physical Surface("plane_z") = {plane_z[]};
Physical Surface("end") = {end[]};
Physical Surface("branch") = {branch[]};
Physical Surface("bore") = {bore[]};
