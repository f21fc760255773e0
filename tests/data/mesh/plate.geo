// Plate of 2 m x 1 m with a square bar and a round hole. plate22.msh, plate41.msh and plate41_binary.msh are its mesh by Gmsh 4.13, written as version 2.2, as
// version 4.1 and as version 4.1 binary.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
Disk(2) = {1.5, 0.5, 0, 0.25};
Rectangle(3) = {0.25, 0.25, 0, 0.5, 0.5};
BooleanDifference(4) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
BooleanFragments{ Surface{4}; Delete; }{ Surface{3}; Delete; }
Mesh.MeshSizeMin = 0.25;
Mesh.MeshSizeMax = 0.25;
bar() = Surface In BoundingBox{0.2, 0.2, -1, 0.8, 0.8, 1};
all() = Surface{:};
all() -= bar();
Physical Surface("bar") = bar();
Physical Surface("plate") = all();
left() = Curve In BoundingBox{-0.1, -0.1, -1, 0.1, 1.1, 1};
Physical Curve("left") = left();
