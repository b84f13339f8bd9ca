#pragma once
// Whether nodules can be seen on the screen: strokes of a simulated pen over and beside them, published thresholds, and
// the angle at which a motion on the screen is seen. The pictures are drawn and compared by `palpa bench visibility`.

#include <string>
#include <vector>

#include "files/json.h"
#include "platform/sample.h"
#include "scene/plan.h"

namespace palpa::accuracy {

struct VisibilityOptions {
    double force_N = 2.0;
    double speed_m_per_s = 0.03;
    double rate_Hz = 240.0;
    double distance_m = 0.4;  // from the eye to the screen
    platform::Tool tool = platform::Tool::pen;
};

// A published difference in latency that people notice while they drag something. Times the speed of the pen it is a
// distance on the screen.
struct Threshold {
    const char* name;
    const char* source;
    double latency_s;
};
// The finer one holds for a device that answers at once, whereas common ones take 65 to 120 ms: what stays below it is
// not seen. What exceeds the coarser one is seen.
inline constexpr Threshold kMayBeSeen{"dragging with a finger, 6 ms told from 1 ms", "Annett et al. 2014", 5e-3};
inline constexpr Threshold kIsSeen{"inking with a stylus, about 50 ms", "Annett et al. 2014", 50e-3};
// Least change of a real compliance that is felt and seen.
inline constexpr double kComplianceWeber = 0.15;  // Bergmann Tiest & Kappers 2009

// Returns the angle at which a length on the screen is seen, in minutes of arc.
double arcmin_of(double length_m, double distance_m);
double arcmin_of(const Threshold& threshold, const VisibilityOptions& options);

// A straight stroke through a place, along the unit vector.
struct Stroke {
    std::string nodule;  // its id; empty for a stroke beside all nodules
    Eigen::Vector2d through_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d along = Eigen::Vector2d::UnitX();
};

// Returns a stroke through each nodule, and strokes beside all of them: towards each nodule, and through a grid of
// places. These stay away from every nodule by its radius and four radii of the indenter, and from the edges by four
// radii. Strokes that leave the tissue are left out.
std::vector<Stroke> strokes_over(const scene::Plan& plan);

// Returns the samples of a stroke under a constant force. `view`: as the tissue is mapped.
std::vector<platform::Sample> samples_of(const Stroke& stroke, const scene::Scene& scene, const scene::Plan& plan,
                                         const scene::View& view, const VisibilityOptions& options);

// What the same stroke does over the tissue and over one without nodules, from the state alone.
struct Difference {
    double lag_m = 0.0;        // greatest lag of the avatar, with nodules
    double apart_m = 0.0;      // greatest distance between both avatars, relative to their textures,
    std::size_t apart_at = 0;  // and after which sample
    double sunk_m = 0.0;       // greatest difference in depth,
    double depth_share = 0.0;  // and as a share of the depth without nodules,
    std::size_t depth_at = 0;  // and after which sample
    // The tissue is not known as deep as the force presses: depths and lag are those of its last depth.
    bool beyond = false;
};
// Nothing on the screen moves farther than this: the avatar by what both are apart, and its shadow and the dent's rim by the
// difference in depth at most.
inline double longest_motion_m(const Difference& difference) { return difference.apart_m + difference.sunk_m; }
Difference difference_of(const std::vector<platform::Sample>& samples, const scene::Scene& scene,
                         const scene::Plan& with, const scene::Plan& without, const scene::ScreenArea& screen);

// What the pixels say about a stroke.
struct Seen {
    Stroke stroke;
    Difference difference;
    double motion_px = 0.0;
    double motion_arcmin = 0.0;
};

// The nodules through which no stroke stays on the tissue: nothing is said of them.
std::vector<std::string> nodules_left_out(const scene::Plan& plan, const std::vector<Seen>& seen);

files::Json visibility_json(const std::vector<Seen>& seen, const std::vector<std::string>& left_out,
                            const VisibilityOptions& options);
std::string visibility_table(const std::vector<Seen>& seen, const std::vector<std::string>& left_out,
                             const VisibilityOptions& options);

}  // namespace palpa::accuracy
