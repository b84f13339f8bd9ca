#pragma once
// How a recording becomes a map: every choice that a person may change, and the result. What is not set is chosen from
// the recording; either way map.source.choices records it.

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

enum class RecordingForm { probing, sliding, matrices };
enum class Gridding { on_grid, plane, inverse_distance, median };
enum class ContactStart { first_row, threshold, given };
enum class TangentialChoice { measured, energy, none };
enum class Quantity { force, stiffness, young };  // meaning of an array's numbers: N, N/m at any depth, Pa
enum class LengthUnit { mm, m, um };
enum class ForceUnit { N, mN };

struct ImportOptions {
    std::optional<RecordingForm> form;
    std::string name;     // of the map; empty: that of the first file
    std::string licence;  // of the recording
    IndenterShape indenter = IndenterShape::sphere;
    double indenter_radius_m = 3e-3;
    double cylinder_length_m = 20e-3;  // only for the contact formula

    // tables
    std::map<std::string, std::string> columns;  // role -> name in the file, see columns.h
    std::optional<LengthUnit> length_unit;       // of the positions
    std::optional<LengthUnit> depth_unit;
    std::optional<ForceUnit> force_unit;
    bool negate_force = false;
    std::optional<std::array<double, 4>> region_m;  // x from, x to, y from, y to: only this is read
    bool remove_tilt = true;
    std::optional<double> outliers;  // in robust standard deviations, 0: none

    // the grid
    std::optional<Gridding> gridding;
    std::optional<double> pitch_m;
    std::optional<double> radius_m;  // within which a cell takes samples, if the points lie on no grid
    std::vector<double> depths_m;    // of the map's layers; for matrices, of the files
    std::optional<int> layers;       // number of layers, if the depths are chosen
    bool fill = true;                // stores filled_normal_N as well
    std::optional<TangentialChoice> tangential;

    // probing
    std::optional<ContactStart> contact;
    std::optional<double> contact_force_N;  // above which a place touches for sure, with ContactStart::threshold

    // sliding
    std::optional<double> surface_z_m;     // height of a flat surface, instead of an estimated one
    std::vector<double> at_depths_m;       // for each file, if recorded at constant depth
    std::optional<double> surface_node_m;  // spacing of the estimated surface's nodes

    // arrays
    std::array<double, 2> spacing_m{0.0, 0.0};  // must be stated
    std::array<double, 2> origin_m{0.0, 0.0};
    Quantity quantity = Quantity::force;
    double scale = 1.0;             // SI units of `quantity` per unit of the file
    bool scale_stated = false;      // required for images, whose counts have no unit
    double offset = 0.0;            // in the file's units, subtracted before scaling
    std::optional<double> missing;  // the number that means "not measured", besides NaN
    double poisson = 0.5;
    std::string axes = "dyx";  // order of a three-dimensional array's axes: d depth, y, x
    std::string dataset;       // in MATLAB and HDF5 files; empty: the only array
    std::vector<std::filesystem::path> tangential_x;
    std::vector<std::filesystem::path> tangential_y;

    std::function<void(const char* what, double done)> progress;  // done: 0 ... 1; may be empty
};

// |map - recording| at the recorded points.
struct ImportResidual {
    std::size_t n = 0;
    double median_N = 0.0;
    double worst_N = 0.0;
    double greatest_N = 0.0;  // greatest force of the map, to which the shares refer
    double worst_x_m = 0.0;
    double worst_y_m = 0.0;
    double worst_depth_m = 0.0;

    double median_share() const { return greatest_N > 0.0 ? median_N / greatest_N : 0.0; }
    double worst_share() const { return greatest_N > 0.0 ? worst_N / greatest_N : 0.0; }
};

struct ImportReport {
    RecordingForm form = RecordingForm::probing;
    std::size_t rows = 0;
    std::size_t points = 0;           // places probed, samples in contact, or numbers in the arrays
    std::size_t rejected_rows = 0;    // not numbers, not deeper than the row before, off their command, or outliers
    std::size_t rejected_points = 0;  // with fewer than two depths left
    std::size_t outliers = 0;         // among the rejected rows
    std::size_t missing_cells = 0;    // of the grid
    double median_offset_N = 0.0;     // force at contact, or in the air, subtracted point by point
    ImportResidual residual;
    std::optional<ImportResidual> tangential;  // |map - recording| of measured tangential forces of a sliding tool
    std::vector<std::string> notes;            // what a person should know, in plain words
};

const char* name_of(RecordingForm form);
const char* name_of(Gridding gridding);
const char* name_of(TangentialChoice choice);

}  // namespace palpa::stiffnessmaps
