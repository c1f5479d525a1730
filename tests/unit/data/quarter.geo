// A quarter of a cylinder of radius 1 and height 1, whose round side is a group.
Point(1) = {0, 0, 0, 0.7}; Point(2) = {1, 0, 0, 0.7}; Point(3) = {0, 1, 0, 0.7};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
a[] = Extrude {0, 0, 1} { Surface{1}; };
Physical Curve("arc", 1) = {2};
Physical Surface("round", 1) = {a[3]};
Physical Surface("flat", 2) = {1, a[0], a[2], a[4]};
Physical Volume("body", 1) = {a[1]};
