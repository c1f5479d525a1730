// A cube of hexahedra, pyramids and tets above it, prisms on top; the bottom is of quads.
Mesh.CharacteristicLengthMax = 0.6;
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {0, 0, 1, 1, 1, 1};
Coherence;
Transfinite Curve{:} = 3;
Transfinite Surface{1, 2, 3, 4, 5, 6}; Recombine Surface{1, 2, 3, 4, 5, 6};
Transfinite Volume{1};
lid[] = Extrude {0, 0, 0.5} { Surface{11}; Layers{2}; Recombine; };
Physical Volume("lower") = {1}; Physical Volume("all") = {1, 2, lid[1]};
Physical Surface("bottom") = {5}; Physical Surface("side") = {1}; Physical Surface("top") = {lid[0]};
