// The bracket of bracket.geo, all sizes proportional to s: fine at the rim of the clamp, where the
// stress has no bound, and at the fillet. bracket_reference.py runs
// gmsh -3 -order 2 -format msh22 -setnumber s 0.5 -o bracket_graded.msh bracket_graded.geo
If (!Exists(s)) s = 1; EndIf
t = 0.01; H = 0.1; L = 0.08; r = 0.005;
Point(1) = {0, 0, 0};
Point(2) = {L, 0, 0};
Point(3) = {L, 0, t};
Point(4) = {t + r, 0, t};
Point(5) = {t + r, 0, t + r};
Point(6) = {t, 0, t + r};
Point(7) = {t, 0, H};
Point(8) = {0, 0, H};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Circle(4) = {4, 5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Plane Surface(1) = {1};
side[] = Extrude {0, 0.04, 0} { Surface{1}; };
Physical Surface("top") = {side[7]};
Physical Surface("end") = {side[3]};
Physical Volume("steel") = {side[1]};
rim[] = Boundary{ Surface{side[7]}; };
fillet[] = Boundary{ Surface{side[5]}; };
Field[1] = Distance; Field[1].EdgesList = {rim[]}; Field[1].NNodesByEdge = 200;
Field[2] = Threshold; Field[2].IField = 1; Field[2].DistMin = 0; Field[2].DistMax = 0.02;
Field[2].LcMin = 0.0015*s; Field[2].LcMax = 0.01*s;
Field[3] = Distance; Field[3].EdgesList = {fillet[]}; Field[3].NNodesByEdge = 200;
Field[4] = Threshold; Field[4].IField = 3; Field[4].DistMin = 0; Field[4].DistMax = 0.02;
Field[4].LcMin = 0.004*s; Field[4].LcMax = 0.01*s;
Field[5] = Min; Field[5].FieldsList = {2, 4};
Background Field = 5;
Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
Mesh.Algorithm = 5; Mesh.Algorithm3D = 1; Mesh.Optimize = 1;
