#pragma once
// A stiffness map: forces on an indenter, recorded or computed on a grid of positions at several depths. This is the
// raw data of a map folder; field.h prepares it for look-up.

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace palpa::stiffnessmaps {

enum class IndenterShape { sphere, cylinder };
enum class TangentialKind { recorded, energy, none };  // where the tangential arrays come from
enum class SourceKind { recorded, simulated, analytic };

struct Nodule {
    std::string id;
    bool placed = true;  // known from the phantom; false: found by detection
    double x_m = 0.0;
    double y_m = 0.0;
    std::optional<double> top_depth_m;
    std::optional<double> diameter_m;
    std::optional<double> length_m;
    std::optional<double> angle_deg;
};

// One choice that the program or a person made when a recording became this map.
struct SourceChoice {
    std::string key;  // "pitch_mm"
    std::variant<double, std::string, std::vector<double>> value;
    std::string how;     // why this value
    std::string option;  // the option that changes it: "--pitch-mm"
};

struct MapSource {
    SourceKind kind = SourceKind::recorded;
    std::string how;
    std::string from;
    std::string licence;
    std::vector<SourceChoice> choices;
};

struct Map {
    std::string name;
    double origin_m[2] = {0.0, 0.0};  // position of cell (0, 0), in the frame of the recording
    double spacing_m[2] = {1e-3, 1e-3};
    std::size_t n_x = 0;
    std::size_t n_y = 0;
    std::vector<double> depths_m;  // ascending, > 0
    // [n_depth][n_y][n_x]; NaN = not measured. The tangential arrays may be empty. Tangential force that opposes motion
    // along +x (+y) is positive.
    std::vector<float> normal_N;
    std::vector<float> tangential_x_N;
    std::vector<float> tangential_y_N;
    // Empty, or normal_N with every gap closed, for programs that cannot read NaN; look-up does not use it.
    std::vector<float> filled_normal_N;
    std::optional<double> noise_N;  // standard deviation of the normal force, if estimated at import
    TangentialKind tangential = TangentialKind::none;
    IndenterShape indenter = IndenterShape::sphere;
    double indenter_radius_m = 4e-3;
    std::vector<Nodule> nodules;
    bool nodules_known = true;  // false: nobody said which there are, as of a recording; then `nodules` is empty
    MapSource source;

    std::size_t n_depths() const { return depths_m.size(); }
    std::size_t n_cells() const { return n_x * n_y; }
    double x_of(std::size_t i) const { return origin_m[0] + spacing_m[0] * static_cast<double>(i); }
    double y_of(std::size_t j) const { return origin_m[1] + spacing_m[1] * static_cast<double>(j); }
};

struct ForceRange {
    double lowest_N = 0.0;
    double highest_N = 0.0;
};

std::size_t missing_count(const Map& map);  // normal forces that are NaN
ForceRange force_range(const Map& map);     // of the measured normal forces; 0, 0 if there are none

const char* name_of(IndenterShape shape);
const char* name_of(TangentialKind kind);
const char* name_of(SourceKind kind);

}  // namespace palpa::stiffnessmaps
