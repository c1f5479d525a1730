// The bar of Hauth & Strasser (2004), Example 3: 0.1 x 0.1 x 0.3 m, 70 tets. Made by gmsh 4.8.4:
//   gmsh -3 -algo del2d -format msh22 -o bar.msh bar.geo
base = 0.085; // length of an edge at the base [m]
top = 0.125;  // and at the top
Point(1) = {0, 0, 0, base};
Point(2) = {0.1, 0, 0, base};
Point(3) = {0.1, 0.1, 0, base};
Point(4) = {0, 0.1, 0, base};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
e[] = Extrude {0, 0, 0.3} { Surface{1}; };
MeshSize{ PointsOf{ Surface{e[0]}; } } = top;
Physical Volume(1) = {1};
