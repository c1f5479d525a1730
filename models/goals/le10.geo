// A quarter of NAFEMS' thick elliptic plate with an elliptic hole, 0.6 m thick, in ten-node tets.
// gmsh -3 -order 2 -format msh22 -o le10.msh le10.geo
h = 0.6;
Point(1) = {0, 0, 0, h};
Point(2) = {2, 0, 0, h};
Point(3) = {3.25, 0, 0, h};
Point(4) = {0, 2.75, 0, h};
Point(5) = {0, 1, 0, h};
Line(1) = {2, 3};
Ellipse(2) = {3, 1, 3, 4};
Line(3) = {4, 5};
Ellipse(4) = {5, 1, 2, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
low[] = Extrude {0, 0, 0.3} { Surface{1}; };
high[] = Extrude {0, 0, 0.3} { Surface{low[0]}; };
Physical Surface("outer") = {low[3], high[3]};
Physical Curve("rim") = {7};
Physical Surface("top") = {high[0]};
Physical Volume("plate") = {low[1], high[1]};
