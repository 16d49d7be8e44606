// Quarter of a cylinder of radius 1 that touches y = 0 at the origin, refined there for contact, for
// the problems of Hertz. scripts/make_meshes.py adds its mirror image below, node for node, so that
// the nodes of two equal cylinders match: cylinders.msh.
Mesh.ElementOrder = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Point(1) = {0, 0, 0};
Point(2) = {1, 1, 0};
Point(3) = {0, 1, 0};
Circle(1) = {1, 3, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

// Cells of 0.005 within 0.075 of the contact grow to 0.2.
Field[1] = MathEval;
Field[1].F = "Min(0.2, 0.005 + 0.25*Max(0, Sqrt(x*x + y*y) - 0.075))";
Background Field = 1;

Physical Surface("upper") = {1};
Physical Curve("arc") = {1};
Physical Curve("cut") = {2};         // y = 1
Physical Curve("axis") = {3};        // x = 0
