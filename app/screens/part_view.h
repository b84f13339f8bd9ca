#pragma once
// What the screen of parts keeps from frame to frame: the tool, the stroke that is being drawn, curves, and what the parts
// look like.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa::app {

enum class PartTool { press, sculpt, permute };

// What a person asked for on the screen of parts.
struct PartWish {
    enum class Kind { edit, undo, redo, earlier, offer, method } kind = Kind::method;
    std::size_t design = 0;
    // Of an edit: a cylinder through the whole part along these places, in the part's own frame (view's axes).
    PartTool tool = PartTool::sculpt;
    std::vector<std::array<double, 2>> path_m;
    double radius_m = 0.0;
    std::string material;  // of permute
};

// Rectangle of one material in the picture of a part, in its own frame.
struct PartPatch {
    float u0_m = 0.0f, u1_m = 0.0f, v0_m = 0.0f, v1_m = 0.0f;
    int material = 0;
};

// One point of a press.
struct PressPoint {
    float t_s = 0.0f;
    float force_N = 0.0f;
    float travel_m = 0.0f;
};

struct PartView {
    PartTool tool = PartTool::press;
    std::size_t material = 1;                      // that permute gives: most bodies are of the first
    int radius = 1;                                // of the tool: one of kToolRadii_mm
    bool magnified = false;                        // displacements are drawn kMagnified times as large
    std::vector<std::array<double, 2>> stroke_m;   // on the tissue's plane; empty: none is being drawn
    std::array<std::vector<PressPoint>, 2> press;  // the present or last press of each design
    std::array<std::vector<PressPoint>, 2> last;   // the one before
    bool was_down = false;
    double began_s = 0.0;
    // Pictures, made anew when a design's voxels change.
    std::array<std::string, 2> drawn_sha256;
    std::array<std::vector<PartPatch>, 2> patches;
    std::optional<double> pending;   // share of the finite cells' computation that is done; nothing: none runs
    std::array<int, 2> edits{0, 0};  // that can be undone
    std::size_t undone = 0;          // edits that can be done again
    bool earlier = false;            // designs of another day can be opened
    bool in_browser = false;         // changed designs are kept there, and offered as files
    bool unstored = false;           // for some of them the browser had no room
    std::array<std::filesystem::path, 2> kept;  // files of the changed designs; empty: not changed
};

inline constexpr std::array<double, 3> kToolRadii_mm{0.5, 1.0, 2.0};
inline constexpr double kMagnified = 5.0;

}  // namespace palpa::app
