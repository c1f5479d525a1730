// A quarter of a thick tube: radii 0.2 m and 0.25 m, a slice of 50 mm, in ten-node tets.
// gmsh -3 -order 2 -format msh22 -o tube.msh tube.geo
r = 0.2; R = 0.25; L = 0.05; h = 0.05;
Point(1) = {0, 0, 0, h};
Point(2) = {r, 0, 0, h};
Point(3) = {R, 0, 0, h};
Point(4) = {0, R, 0, h};
Point(5) = {0, r, 0, h};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
side[] = Extrude {0, 0, L} { Surface{1}; };
Physical Surface("inner") = {side[5]};
Physical Volume("tube") = {side[1]};
