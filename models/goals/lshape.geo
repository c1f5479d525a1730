// An L of three squares of 0.5 m, 0.1 m thick, whose inner corner is sharp. Four-node tets.
// gmsh -3 -format msh22 -o lshape.msh lshape.geo
h = 0.25;
Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {1, 0.5, 0, h};
Point(4) = {0.5, 0.5, 0, h};
Point(5) = {0.5, 1, 0, h};
Point(6) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
side[] = Extrude {0, 0, 0.1} { Surface{1}; };
Physical Volume("body") = {side[1]};
