#pragma once
// One or two multi-material parts that a pen presses or pulls. What a force does to them is prepared (parts/response.h,
// mechanics/button.h) and looked up at each sample.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/json.h"
#include "mechanics/button.h"
#include "mechanics/operators.h"
#include "parts/proxy.h"
#include "parts/response.h"
#include "scene/contact.h"
#include "scene/scene.h"
#include "scene/stages.h"
#include "scene/surface.h"

namespace palpa::scene {

struct Plan;

// One design. Its picture lies in the tissue's plane: u to the right, v upwards, the part's origin at origin_m.
struct PartDesign {
    parts::Part part;
    parts::PartLoad load;
    std::vector<parts::Response> responses;  // of each method that is offered; none for a button
    std::optional<mechanics::ButtonCurve> button;
    parts::Slice slice;  // in which the proxy moves
    Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d size_m = Eigen::Vector2d::Zero();  // of the space that the part's file can fill
    std::string runs_sha256;
};

struct PartTissue {
    PartOptions options;
    std::vector<PartDesign> designs;                   // one or two, the first above
    std::vector<parts::Method> methods;                // that are offered, in the order in which they are changed
    std::size_t first_method = 0;                      // the scene's
    Eigen::Vector2d size_m = Eigen::Vector2d::Zero();  // of the plane
    double direction_m[2] = {0.0, 0.0};                // of the load, in the plane; 0 0: into the picture
    std::string cache_warning;
};

// What a sample changes.
struct PartWork {
    bool down = false;
    std::size_t design = 0;                            // under the pen
    std::array<double, 2> proxy_m{0.0, 0.0};           // in the frame of that design
    Eigen::Vector2d from_m = Eigen::Vector2d::Zero();  // where the touch began
    bool touching = false;                             // the proxy rests on the part
    std::size_t method = 0;
    // of each design
    std::array<mechanics::ButtonState, 2> button;
    std::array<double, 2> force_N{0.0, 0.0};
    std::array<double, 2> depth_m{0.0, 0.0};
    std::array<parts::StationPlace, 2> station{};
};

// Rise of the resistance of a part that is dragged along the load's direction, over reference_m before p:
//   R(p) = k max(0, (p - p0) . d),   df = ( R(p) - R(p - s_ref u) ) u . d
// k: stiffness at the place where the touch began, p0; d: direction of the load. Ours: the law of avatar/display_ratio.h takes
// any rise.
struct RiseOnPart {
    double stiffness_N_per_m = 0.0;
    Eigen::Vector2d from_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();

    double resistance_N(const Eigen::Vector2d& p_m) const;
    double operator()(const Eigen::Vector2d& p_m, const Eigen::Vector2d& u, double reference_m) const;
};

// The functions that every tissue has; scene/tissue.h describes them.
bool takes_seconds(const PartOptions& options);
std::vector<std::filesystem::path> input_files(const PartOptions& options);
files::Json file_hashes(const PartOptions& options);
inline std::filesystem::path map_folder(const PartOptions&) { return {}; }
inline bool knows_surface(const PartOptions&) { return false; }

PartTissue prepare(const PartOptions& options, const Scene& scene, const mechanics::Progress& progress);

// The finite cells of a scene's parts a piece at a time, for a program with one thread. They are left in the cache
// (files/cache.h), where prepare() finds them; without a cache it computes them again.
class PartCells {
  public:
    explicit PartCells(const PartOptions& options);  // throws as prepare() does
    ~PartCells();
    PartCells(const PartCells&) = delete;
    PartCells& operator=(const PartCells&) = delete;

    bool advance();  // one iteration; false once nothing is left. Throws as prepare() does
    double share() const;

  private:
    struct Work;
    std::unique_ptr<Work> work_;
};

inline bool serves(const PartTissue&, const Scene&) { return true; }
void describe(const PartTissue& tissue, const Scene& scene, Plan& plan);
std::vector<Stage> stages(const PartTissue& tissue, const Scene& scene);
files::Json identity(const PartTissue& tissue);

PartWork make_work(const PartTissue& tissue);
void answer(const PartTissue& tissue, StageId stage, const Press& press, PartWork& work, Contact& contact);
double rise_N(const PartTissue& tissue, const Station& station, PartWork& work);
Push push_to(const PartTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, PartWork& work);
void sample_surface(const PartTissue& tissue, const SurfaceEffect& effect, const Contact& contact, const PartWork& work,
                    SurfaceShape& shape);

// How one of the methods computes the depth, and how large its error is.
Stage depth_stage(const PartTissue& tissue, std::size_t method);

// Whether the load lies in the picture's plane, and does not go into it.
bool in_plane(const PartTissue& tissue);
// Whether there is material of the design at p_m of the tissue's plane, at any depth.
bool is_on_part(const PartDesign& design, const Eigen::Vector2d& p_m);

// How far the chosen method applies to a design where it is pressed now, if it never does (0), or not as far as the design is
// displaced (parts::Validity); nothing if it applies.
struct PartDoubt {
    double to_m = 0.0;
    std::string_view why_not;
};
std::optional<PartDoubt> doubt_of(const PartTissue& tissue, const PartWork& work, std::size_t design);

// Takes the next method, unless something presses. Returns its name; nullptr if it stays.
const char* next_method(const PartTissue& tissue, PartWork& work);
// How often buttons went on since the start; nothing without a button.
std::optional<std::int64_t> switch_events(const PartTissue& tissue, const PartWork& work);

}  // namespace palpa::scene
