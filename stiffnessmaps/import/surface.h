#pragma once
// Estimates the surface of a tissue under a sliding tool from the tool's positions and forces.
//
// Between the nodes of a square grid, surface height s and compliance c are bilinear, and a sample at height z under
// the normal force F obeys
//     n_z (s(x, y) - z) = c(x, y) F^m
// along the surface's own normal n. s and c are the least-squares solution over all samples in contact, with second
// differences along x and y held small (smoothness) and samples far off weighed less (Huber), repeated with the normals
// of the last solution. m is 1 or 2/3 (a ball, Hertz), whichever leaves the smaller deviation, or another one from 1 to 0.5
// that leaves 4 % less than both. If the force hardly changes, s and c cannot be told apart, and fit_surface throws.

#include <string>
#include <vector>

namespace palpa::stiffnessmaps {

struct SurfaceSamples {
    std::vector<double> x_m;
    std::vector<double> y_m;
    std::vector<double> z_m;
    std::vector<float> force_N[3];  // on the tool, along x, y, z
    std::size_t size() const { return x_m.size(); }
};

struct Surface {
    double origin_m[2] = {0.0, 0.0};
    double node_m = 1e-3;
    std::size_t n_x = 0;
    std::size_t n_y = 0;
    std::vector<double> height_m;  // [y][x]
    double exponent = 1.0;
    double deviation_m = 0.0;  // robust deviation of the samples' heights from the model
    double tilt_deg = 0.0;     // of the plane fitted to the surface
};

struct SurfacePoint {
    double height_m = 0.0;
    double normal[3] = {0.0, 0.0, 1.0};
};
// Returns height and unit normal at a position, which is clamped to the grid.
SurfacePoint surface_at(const Surface& surface, double x_m, double y_m);

// Fits a surface with nodes every `node_m`, or wider if there are too many nodes or too few samples. Throws InputError
// if the force changes too little to tell the surface from the tissue's compliance, and names the options that help.
Surface fit_surface(const SurfaceSamples& samples, double node_m, const std::string& file);

// Depth along the normal and normal force of one sample.
struct Indentation {
    double depth_m = 0.0;
    double force_N = 0.0;
};
Indentation indentation_of(const Surface& surface, const SurfaceSamples& samples, std::size_t i);

}  // namespace palpa::stiffnessmaps
