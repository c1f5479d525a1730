// An L of steel: a leg of 100 mm along z, one of 80 mm along x, 10 mm thick, 40 mm wide.
// gmsh -3 -format msh22 -o bracket.msh bracket.geo
t = 0.01; H = 0.1; L = 0.08; r = 0.005; h = 0.0105;
Point(1) = {0, 0, 0, h};
Point(2) = {L, 0, 0, h};
Point(3) = {L, 0, t, h};
Point(4) = {t + r, 0, t, h};
Point(5) = {t + r, 0, t + r, h};
Point(6) = {t, 0, t + r, h};
Point(7) = {t, 0, H, h};
Point(8) = {0, 0, H, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Circle(4) = {4, 5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Plane Surface(1) = {1};
side[] = Extrude {0, 0.04, 0} { Surface{1}; };
Physical Surface("top") = {side[7]};
Physical Surface("end") = {side[3]};
Physical Volume("steel") = {side[1]};
