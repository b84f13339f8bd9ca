#pragma once
// What a part answers to a force anywhere along its axis: unit solutions, prepared once and looked up in a loop.

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "parts/stiffness.h"

namespace palpa::parts {

struct ResponseRequest {
    Method method = Method::voxels;  // any but elastica, which is not proportional to the force, and factorised
    std::optional<double> cell_m;    // absent: the part's
    double energy_error = 1e-3;
    std::array<int, 2> view{0, 2};  // axes of the picture, to the right and upwards
};

// Displacements under 1 N along the load's direction, at stations along the part's axis; one of them is the load's own
// place. A part that is no beam has that one only.
struct Response {
    Method method = Method::voxels;
    std::vector<double> station_m;           // ascending
    std::vector<double> compliance_m_per_N;  // mean over the loaded patch, along the direction
    std::size_t named = 0;                   // the station of the load itself
    // Largest relative error half way between two stations, estimated: a quarter of what leaving out every second one
    // changes (the cube root of the compliance is interpolated, whose error falls with the square of the distance).
    double interpolation_error = 0.0;
    double energy_error = 0.0;  // of voxels: the largest
    int iterations = 0;         // of voxels: in all
    std::int64_t cells = 0;
    bool converged = true;
    Validity validity;  // at the load's own place
    // Picture: for each station, displacements along the two axes of the view at the nodes of a grid, averaged over the
    // depth, m/N; x of the view fastest, 2 numbers a node.
    std::array<int, 2> nodes{0, 0};
    double spacing_m = 0.0;  // between nodes; the first one stands at the origin of the voxels
    std::vector<std::vector<float>> field;
};

// Called with the share that is done; returns false to stop.
using ResponseProgress = std::function<bool(double)>;

// Throws InputError as stiffness_of() does, also for a method that has no answer, and mechanics::Cancelled.
Response response_of(const Part& part, const PartLoad& load, const ResponseRequest& request,
                     const ResponseProgress& progress = {});

// The same for cells a piece at a time, for a loop that must not stand still.
class CellResponse {
  public:
    CellResponse(const Part& part, const PartLoad& load,
                 const ResponseRequest& request);  // the model and its multigrid
    ~CellResponse();
    CellResponse(const CellResponse&) = delete;
    CellResponse& operator=(const CellResponse&) = delete;

    bool advance();        // one iteration; false once the response is whole
    double share() const;  // of the stations that are done
    Response take();       // once, when it is whole

  private:
    struct Work;
    std::unique_ptr<Work> work_;
};

// Where a place along the axis lies between two stations; before the first and after the last it is there.
struct StationPlace {
    std::size_t low = 0;
    double share = 0.0;  // of the way to low + 1
};
StationPlace place_of(const Response& response, double station_m);

// Returns the compliance there: the cube root is interpolated. Allocates nothing and does not throw, nor does the next.
double compliance_at(const Response& response, const StationPlace& place);

// Up to which displacement the answer applies there: a uniform beam bends as much where the cube root of its compliance says
// how far the load is from the clamp.
double applies_to_m(const Response& response, const StationPlace& place);

// Returns the displacement (u, v) per newton of a node of the picture's grid; of places between nodes bilinear.
std::array<double, 2> field_at(const Response& response, const StationPlace& place, double u_m, double v_m);

// Store and restore a response by its fingerprint (files/cache.h). write: returns a warning, or "".
std::optional<Response> read_response(const std::filesystem::path& cache, std::uint64_t fingerprint);
std::string write_response(const std::filesystem::path& cache, std::uint64_t fingerprint, const Response& response);

}  // namespace palpa::parts
