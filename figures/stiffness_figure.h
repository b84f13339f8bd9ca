#pragma once
// Force over depth on a force arm: what was felt, and what was wanted.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::figures {

struct StiffnessPanel {
    double wanted_N_per_mm = 0.0;
    double rendered_N_per_mm = 0.0;
    double hysteresis_N = 0.0;
    double force_at_0_N = 0.0;  // of the line through the readings
    std::string table;          // name of its table in the folder, columns depth_mm and force_N first
};

// Writes stiffness.gp into the folder and draws it (.png, .svg, .pdf), a panel for each stiffness. Returns what went wrong;
// the tables are kept.
std::string draw_stiffness(const std::vector<StiffnessPanel>& panels, bool simulated,
                           const std::filesystem::path& folder);

}  // namespace palpa::figures
