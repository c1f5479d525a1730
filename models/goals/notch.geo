// A quarter of a bar with two sharp notches of 60 degrees, half as deep as it is thin; four-node tets.
// gmsh -3 -format msh22 -o notch.msh notch.geo
h = 0.25; w = 0.25 * Tan(Pi / 6);
Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {1, 0.5, 0, h};
Point(4) = {w, 0.5, 0, h};
Point(5) = {0, 0.25, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
side[] = Extrude {0, 0, 0.2} { Surface{1}; };
Physical Volume("body") = {side[1]};
