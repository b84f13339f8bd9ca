#pragma once
// Parts as files for printers: STL, 3MF and slices. On the desk only.

#include <filesystem>
#include <string>
#include <vector>

#include "parts/part_file.h"
#include "parts/surface.h"

namespace palpa::parts {

// What was written, or what a file holds of one material.
struct ExportedFile {
    std::string file;
    std::string material;  // "" for all
    std::int64_t triangles = 0;
    std::int64_t pixels = 0;  // of slices
    double volume_m3 = 0.0;
};

// Bytes of a binary STL file, in mm. Its coordinates are 32-bit numbers.
std::string stl_bytes(const Surface& surface, const std::string& name);

// Bytes of a 3MF file, in mm: a mesh object for each material, with its name and colour, all of them components of one
// object, which is the one build item, since slicers set down separate items apart from each other. Equal parts have
// equal bytes: identifiers are made from the part's, and the archive bears no time. Throws std::runtime_error if lib3mf fails.
// Source: 3MF Core Specification 1.2.3, sections 4 and 5; Production Extension 1.1.2, section 4 (identifiers).
std::string three_mf_bytes(const Part& part, const std::vector<Surface>& surfaces);

// Write FOLDER/MATERIAL.stl for each surface; FILE.3mf; FOLDER/MATERIAL-LAYER.png for each material and layer, with
// slices.json. Files are there whole or not at all; a folder must be new or empty, and is there with all its files or not at
// all. Throw InputError for a folder that is not empty, std::runtime_error if a file cannot be written.
std::vector<ExportedFile> export_stl(const Part& part, const std::vector<Surface>& surfaces,
                                     const std::filesystem::path& folder);
std::vector<ExportedFile> export_three_mf(const Part& part, const std::vector<Surface>& surfaces,
                                          const std::filesystem::path& file);

// The printer's pixel along x and y, and its layer.
struct SlicePitch {
    double x_m = 0.0, y_m = 0.0, z_m = 0.0;
};
// Images of 1 bit per pixel: white where the voxel that holds the pixel's centre is of the material. The images cover the box
// around the part; their first row is its highest y, the first layer its lowest z. Also throws InputError for more than
// 65,535 pixels along a side or more than 100,000 images.
std::vector<ExportedFile> export_slices(const Part& part, const SlicePitch& pitch, const std::filesystem::path& folder);

// Names for files, one for each material: letters, digits, '-' and '_' stay, others become '_'; equal ones get a number.
std::vector<std::string> file_names(const Part& part);

}  // namespace palpa::parts
