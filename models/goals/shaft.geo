// A round shaft along z: radius 0.1 m, length 0.4 m, in ten-node tets.
// gmsh -3 -order 2 -format msh22 -o shaft.msh shaft.geo
r = 0.1; L = 0.4; h = 0.05;
Point(1) = {0, 0, 0, h};
Point(2) = {r, 0, 0, h};
Point(3) = {0, r, 0, h};
Point(4) = {-r, 0, 0, h};
Point(5) = {0, -r, 0, h};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Extrude {0, 0, L} { Surface{1}; }
Physical Volume("shaft") = {1};
