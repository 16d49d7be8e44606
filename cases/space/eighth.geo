// An eighth of the unit ball: eighth-quadratic.msh, eighth-cubic.msh, and files of tests.
//     gmsh -3 -order 2 eighth.geo -o eighth-quadratic.msh
SetFactory("OpenCASCADE");
Mesh.MshFileVersion = 4.1;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeMin = 0.6;
Mesh.MeshSizeMax = 0.6;

Sphere(1) = {0, 0, 0, 1, 0, Pi/2, Pi/2};

Physical Surface("sphere") = {1};
Physical Surface("plane_z") = {2};
Physical Surface("plane_y") = {3};
Physical Surface("plane_x") = {4};
Physical Volume("eighth") = {1};
