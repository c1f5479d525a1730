// A quarter of a thick tube: inner radius 0.06 m, outer 0.1 m, 0.08 m long, its axis along z.
SetFactory("Built-in");
r = 0.06; R = 0.1; L = 0.08; h = 0.034;
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
Extrude {0, 0, L} { Surface{1}; }
Physical Volume("solid") = {1};
