// The L of lshape.geo as a slice of one layer, c at its inner corner and h elsewhere.
// gmsh -3 -format msh22 -setnumber h 0.07 -setnumber c 0.0012 -o graded.msh lshape_graded.geo
If (!Exists(h)) h = 0.07; EndIf
If (!Exists(c)) c = 0.0012; EndIf
Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {1, 0.5, 0, h};
Point(4) = {0.5, 0.5, 0, c};
Point(5) = {0.5, 1, 0, h/8};
Point(6) = {0, 1, 0, h/8};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
side[] = Extrude {0, 0, 0.004} { Surface{1}; Layers{1};};
Physical Volume("body") = {side[1]};
