#pragma once
// Force over depth on a soft device: what was rendered, and what was wanted.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::figures {

struct ForceDepthPanel {
    std::string title;
    std::string table;  // name of its table in the folder, with columns depth_mm, wanted_N and force_N
};

// Writes force-depth.gp into the folder and draws it (.png, .svg, .pdf), a panel for each press. Returns what went wrong;
// the tables are kept.
std::string draw_force_depth(const std::vector<ForceDepthPanel>& panels, const std::filesystem::path& folder);

}  // namespace palpa::figures
