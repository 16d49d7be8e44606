// Half model of the impact: a half-disc of radius 0.5 above a prism of 1 x 0.5 whose top is y = 0. The
// curve `axis` belongs to both bodies. impact.msh, and files of tests.
//     gmsh -2 -order 3 impact.geo -o impact.msh
DefineConstant[ disc_size = 0.1 ];      // edge length of a cell
DefineConstant[ prism_size = 0.125 ];
DefineConstant[ quadrangles = 0 ];      // whether the prism has these
Mesh.MshFileVersion = 4.1;
If (Mesh.ElementOrder == 3)
  Mesh.HighOrderOptimize = 1;
EndIf

Point(1) = {0, 1, 0, disc_size};
Point(2) = {0, 0.5, 0, disc_size};
Point(3) = {0.5, 1, 0, disc_size};
Point(4) = {0, 1.5, 0, disc_size};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 2};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Point(5) = {0, -0.5, 0, prism_size};
Point(6) = {1, -0.5, 0, prism_size};
Point(7) = {1, 0, 0, prism_size};
Point(8) = {0, 0, 0, prism_size};
Line(4) = {5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 5};
Curve Loop(2) = {4, 5, 6, 7};
Plane Surface(2) = {2};
If (quadrangles)
  Recombine Surface {2};
EndIf

Physical Surface("cylinder") = {1};
Physical Surface("prism") = {2};
Physical Curve("arc") = {1, 2};
Physical Curve("axis") = {3, 7};
Physical Curve("bottom") = {4};
Physical Curve("right") = {5};
Physical Curve("top") = {6};
