// Two stacked unit cubes with physical groups of every dimension: overlapping volumes, an interface
// of reversed orientation, the same number in different dimensions.
Point(1) = {0, 0, 0, 2}; Point(2) = {1, 0, 0, 2}; Point(3) = {1, 1, 0, 2}; Point(4) = {0, 1, 0, 2};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
a[] = Extrude {0, 0, 1} { Surface{1}; };
b[] = Extrude {0, 0, 1} { Surface{a[0]}; };
Physical Point("tip", 1) = {2};
Physical Curve("edge", 2) = {1, 2};
Physical Surface("base", 1) = {1};
Physical Surface("middle", 2) = {-a[0]};
Physical Surface("top", 7) = {b[0]};
Physical Volume("lower", 1) = {a[1]};
Physical Volume("all", 2) = {a[1], b[1]};
