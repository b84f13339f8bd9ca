#pragma once
// A phantom: a block of tissue with stiff nodules, and the indenter that is pressed into it on a grid.

#include <filesystem>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

struct Elastic {
    double young_Pa = 0.0;
    double poisson = 0.0;
    bool assumed = false;  // the modulus is a guess, and a map made from it says so
};

struct PhantomNodule {
    std::string id;
    double centre_m[3] = {0.0, 0.0, 0.0};  // x, y, and z from the surface downwards
    double diameter_m = 0.0;
    Elastic material;
};

struct Phantom {
    std::string name;  // of the file
    double size_m[3] = {0.0, 0.0, 0.0};
    Elastic tissue;
    std::vector<PhantomNodule> nodules;
    IndenterShape indenter = IndenterShape::sphere;
    double indenter_radius_m = 0.0;
    double indenter_length_m = 0.0;  // of a cylinder, whose axis lies along y
    bool rolling = true;
    double friction = 0.0;  // coefficient; used only if the tool slides
    std::vector<double> depths_m;
    double origin_m[2] = {0.0, 0.0};
    double spacing_m[2] = {0.0, 0.0};
    std::size_t n_x = 0;
    std::size_t n_y = 0;
};

// Returns the nodules as placed nodules of a map.
std::vector<Nodule> placed_nodules(const Phantom& phantom);

// Reads a phantom from its JSON file. Throws InputError.
Phantom read_phantom(const std::filesystem::path& path);

// Returns a map with the grid, depths, indenter and nodules of the phantom, and no forces yet.
Map map_of_phantom(const Phantom& phantom);

}  // namespace palpa::stiffnessmaps
