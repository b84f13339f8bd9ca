#pragma once
// Two designs of a part: force over displacement, with the differences that people can just tell around the first.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::figures {

struct DesignLine {
    std::string name;
    double stiffness_N_per_m = 0.0;
    double mass_kg = 0.0;
    bool applies = true;  // false: its line says that it does not, and no band is drawn
};

// Draws to .png, .svg or .pdf: a line for each design up to `force_N`, and a band for each Weber fraction of compliance
// around the first design's. Throws as draw_figure() does.
void plot_designs(const DesignLine& a, const DesignLine& b, double force_N, const std::vector<double>& weber_fractions,
                  const std::filesystem::path& file);

// The script alone.
std::string designs_script(const DesignLine& a, const DesignLine& b, double force_N,
                           const std::vector<double>& weber_fractions);

}  // namespace palpa::figures
