#include "parts/response.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/input_error.h"
#include "mechanics/error.h"
#include "mechanics/voxel_solve.h"
#include "parts/beam_model.h"
#include "parts/cell_model.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

constexpr int kBeamStations = 65;
constexpr int kCellStations = 17;
constexpr int kFewStations = 9;  // of voxels with more cells than
constexpr std::size_t kManyCells = 50'000;

struct Station {
    double at_m = 0.0;
    PartLoad load;
    bool named = false;
};

double round_trip(double value, double whole) { return whole * std::round(value / whole); }

// The surface that looks against the load, on the line through `at`; nothing if there is only air.
std::optional<Point> surface_under(const Part& part, const PartLoad& load, Point at_m) {
    const Voxels& voxels = part.voxels;
    const auto axis = static_cast<std::size_t>(largest_axis(load.direction));
    const bool up = load.direction[axis] < 0.0;
    std::array<int, 3> p{};
    for (std::size_t c = 0; c < 3; ++c)
        p[c] = static_cast<int>(std::floor((at_m[c] - voxels.frame.origin_m[c]) / voxels.frame.pitch_m));
    const int n = voxels.size[axis];
    for (int i = 0; i < n; ++i) {
        p[axis] = up ? n - 1 - i : i;
        if (material_at(voxels, p[0], p[1], p[2]) < 0) continue;
        at_m[axis] = voxels.frame.origin_m[axis] + voxels.frame.pitch_m * (up ? p[axis] + 1 : p[axis]);
        return at_m;
    }
    return std::nullopt;
}

// A load like the named one at another place along the axis.
std::optional<PartLoad> load_at(const Part& part, const PartLoad& load, double station_m) {
    const auto axis = static_cast<std::size_t>(*part.axis);
    const auto pressed = static_cast<std::size_t>(largest_axis(load.direction));
    const FilledBox box = filled_box(part.voxels);
    const double h = part.voxels.frame.pitch_m;
    PartLoad out = load;
    out.face.reset();
    if (load.face) {
        const std::size_t lateral = 3 - axis - pressed;
        out.at_m[lateral] = 0.5 * h * (box.low[lateral] + box.high[lateral]);
        out.patch_m = 0.5 * h * std::min(box.high[lateral] - box.low[lateral], box.high[pressed] - box.low[pressed]);
    }
    out.patch_m = std::max(out.patch_m, 2.0 * h);
    out.at_m[axis] = station_m;
    const std::optional<Point> on_surface = surface_under(part, out, out.at_m);
    if (!on_surface) return std::nullopt;
    out.at_m = *on_surface;
    return out;
}

// Stations from the clamp to the free end, `n` of them, the end's and the load's own. Of a part that is no beam only the latter.
std::vector<Station> stations_of(const Part& part, const PartLoad& load, const PartBeam& beam, int n) {
    if (!beam.why_not.empty()) return {{0.0, load, true}};
    const auto axis = static_cast<std::size_t>(*part.axis);
    const FilledBox box = filled_box(part.voxels);
    const double h = part.voxels.frame.pitch_m;
    const double named_m = beam.clamped_low ? beam.pieces.back().to_m : beam.pieces.front().from_m;
    const double clamp_m = beam.clamped_low ? beam.pieces.front().from_m : beam.pieces.back().to_m;
    const double free_m = h * (beam.clamped_low ? box.high[axis] : box.low[axis]);
    std::vector<Station> out{{named_m, load, true}};
    const auto add = [&](double at_m) {
        if (const auto there = load_at(part, load, at_m)) out.push_back({at_m, *there, false});
    };
    for (int i = 0; i < n; ++i) {
        // the middle of a voxel, so that the patch does not stand on an edge
        const double at_m = round_trip(clamp_m + (free_m - clamp_m) * (i + 0.5) / n - 0.5 * h, h) + 0.5 * h;
        if (std::abs(at_m - named_m) >= 0.25 * std::abs(free_m - clamp_m) / n) add(at_m);
    }
    // the last voxel, up to which the part can be pressed
    const double end_m = free_m + (beam.clamped_low ? -0.5 : 0.5) * h;
    if (std::abs(end_m - named_m) > h) add(end_m);
    std::sort(out.begin(), out.end(), [](const Station& a, const Station& b) { return a.at_m < b.at_m; });
    return out;
}

void start_response(const Part& part, const std::vector<Station>& stations, const ResponseRequest& request,
                    Response& out) {
    out.method = request.method;
    const int per_cell = voxels_per_cell(part, request.cell_m);
    out.spacing_m = per_cell * part.voxels.frame.pitch_m;
    for (std::size_t k = 0; k < 2; ++k) {
        const int n = part.voxels.size[static_cast<std::size_t>(request.view[k])];
        out.nodes[k] = (n + per_cell - 1) / per_cell + 1;
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
        out.station_m.push_back(stations[i].at_m);
        if (stations[i].named) out.named = i;
    }
    const auto count = static_cast<std::size_t>(out.nodes[0]) * static_cast<std::size_t>(out.nodes[1]);
    out.field.assign(stations.size(), std::vector<float>(2 * count, 0.0F));
}

std::size_t node_of(const Response& response, int i, int j) {
    return 2 *
           (static_cast<std::size_t>(i) + static_cast<std::size_t>(response.nodes[0]) * static_cast<std::size_t>(j));
}

// The deflection of a beam under 1 N; of the paper's spring the same shape with its own tip.
struct BeamShape {
    const PartBeam& beam;
    Method method;
    double scale = 1.0;

    double at(double load_m, double x_m) const {
        return scale * beam.across * beam.across *
               beam_deflection_m_per_N(beam.pieces, beam.clamped_low, {load_m, x_m}, method == Method::timoshenko);
    }
};

PartBeam cut_at(const PartBeam& beam, double end_m) {
    PartBeam out = beam;
    out.pieces.clear();
    for (BeamPiece piece : beam.pieces) {
        (beam.clamped_low ? piece.to_m : piece.from_m) =
            beam.clamped_low ? std::min(piece.to_m, end_m) : std::max(piece.from_m, end_m);
        if (piece.to_m > piece.from_m) out.pieces.push_back(piece);
    }
    out.length_m = out.pieces.empty() ? 0.0 : out.pieces.back().to_m - out.pieces.front().from_m;
    return out;
}

void draw_beam(const Part& part, const PartLoad& load, const ResponseRequest& request, const BeamShape& shape,
               double load_m, std::size_t station, Response& out) {
    for (int j = 0; j < out.nodes[1]; ++j) {
        for (int i = 0; i < out.nodes[0]; ++i) {
            double x_m = load_m;
            if (request.view[0] == *part.axis) x_m = i * out.spacing_m;
            if (request.view[1] == *part.axis) x_m = j * out.spacing_m;
            const double w = shape.at(load_m, x_m);
            for (std::size_t k = 0; k < 2; ++k)
                out.field[station][node_of(out, i, j) + k] =
                    static_cast<float>(w * load.direction[static_cast<std::size_t>(request.view[k])]);
        }
    }
}

Response beam_response(const Part& part, const PartLoad& load, const ResponseRequest& request) {
    const PartBeam named = beam_of(part, load);
    if (!named.why_not.empty())
        throw files::bad_input(part.file, name_of(request.method), named.why_not, "a part that is a beam, or voxels");
    const std::vector<Station> stations = stations_of(part, load, named, kBeamStations);
    Response out;
    start_response(part, stations, request, out);
    out.validity = beam_validity(part, named, load, request.method);
    const double end_m = load_place_m(part, named.clamped_low ? stations.back().load : stations.front().load);
    const PartBeam beam = beam_of(part, load, end_m);
    if (!beam.why_not.empty()) throw files::bad_input(part.file, "axis", beam.why_not, "a beam to its free end");
    for (std::size_t i = 0; i < stations.size(); ++i) {
        BeamShape shape{beam, request.method, 1.0};
        const double at_m = load_place_m(part, stations[i].load);
        if (request.method == Method::paper) {
            const PartBeam cut = cut_at(beam, at_m);
            const double own = shape.at(at_m, at_m);
            if (own > 0.0) shape.scale = beam.across * beam.across / (paper_spring_N_per_m(cut) * own);
        }
        out.compliance_m_per_N.push_back(shape.at(at_m, at_m));
        draw_beam(part, load, request, shape, at_m, i, out);
    }
    return out;
}

// Displacements of the cells' nodes, averaged over the depth.
void draw_cells(const GridLevel& level, const Eigen::Matrix3Xd& u_m, const std::array<int, 2>& view,
                std::size_t station, Response& out) {
    std::vector<float>& field = out.field[station];
    std::vector<float> count(field.size() / 2, 0.0F);
    for (std::size_t n = 0; n < level.node_place.size(); ++n) {
        const auto& p = level.node_place[n];
        const std::size_t node =
            node_of(out, p[static_cast<std::size_t>(view[0])], p[static_cast<std::size_t>(view[1])]);
        for (std::size_t k = 0; k < 2; ++k)
            field[node + k] += static_cast<float>(u_m(view[k], static_cast<Eigen::Index>(n)));
        count[node / 2] += 1.0F;
    }
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (count[i / 2] > 0.0F) field[i] /= count[i / 2];
    }
}

// What leaving out every second station changes at it, over the compliance there.
double interpolation_error(const Response& response) {
    double largest = 0.0;
    const auto& x = response.station_m;
    const auto& c = response.compliance_m_per_N;
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
        const double share = (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]);
        const double root = (1.0 - share) * std::cbrt(c[i - 1]) + share * std::cbrt(c[i + 1]);
        // near the clamp nothing moves; there the error is that of little
        if (c[i] > 0.01 * c[response.named]) largest = std::max(largest, std::abs(root * root * root / c[i] - 1.0));
    }
    return 0.25 * largest;
}

// Does it; what goes wrong names the part's file.
template <class Do>
void by_name(const Part& part, const PartLoad& load, const Do& act) {
    try {
        act();
    } catch (const MeshError& error) {
        throw files::InputError(part.file + ": " + error.what());
    } catch (const LoadError& error) {
        throw files::InputError(part.file + ": loads." + load.name + ": " + error.what());
    }
}

}  // namespace

struct CellResponse::Work {
    Part part;
    PartLoad load;
    ResponseRequest request;
    CellModel model;
    std::vector<PartLoad> loads;  // of the stations
    std::optional<Multigrid> multigrid;
    std::optional<VoxelIteration> solve;  // at the next station
    Eigen::Matrix3Xd u_m;                 // at the one before
    Response out;
};

CellResponse::CellResponse(const Part& part, const PartLoad& load, const ResponseRequest& request)
    : work_(std::make_unique<Work>(Work{part, load, request, {}, {}, {}, {}, {}, {}})) {
    Work& work = *work_;
    by_name(part, load, [&] {
        work.model = cell_model(part, voxels_per_cell(part, request.cell_m));
        const std::size_t cells = work.model.cells.place.size();
        const std::vector<Station> stations =
            stations_of(part, load, beam_of(part, load), cells > kManyCells ? kFewStations : kCellStations);
        for (const Station& station : stations) work.loads.push_back(station.load);
        start_response(part, stations, request, work.out);
        work.out.cells = static_cast<std::int64_t>(cells);
        work.multigrid = make_multigrid(work.model.level);
    });
}

CellResponse::~CellResponse() = default;

bool CellResponse::advance() {
    Work& work = *work_;
    Response& out = work.out;
    const std::size_t station = out.compliance_m_per_N.size();
    if (station == work.loads.size()) return false;
    by_name(work.part, work.load, [&] {
        const PartLoad& load = work.loads[station];
        if (!work.solve)
            work.solve = begin_solve(*work.multigrid, unit_load_N(work.part, work.model, load),
                                     {work.request.energy_error, 500}, work.u_m);
        if (mechanics::advance(*work.multigrid, *work.solve)) return;
        VoxelSolution solution = std::move(work.solve->solution);
        work.solve.reset();
        work.u_m = std::move(solution.u_m);
        out.compliance_m_per_N.push_back(solution.work_J);
        if (station == out.named)
            out.validity = cell_validity(work.part, load, work.model, unit_load_N(work.part, work.model, load),
                                         work.u_m, solution.work_J);
        out.energy_error = std::max(out.energy_error, solution.energy_error);
        out.iterations += solution.iterations;
        out.converged = out.converged && solution.converged;
        draw_cells(work.model.level, work.u_m, work.request.view, station, out);
    });
    return out.compliance_m_per_N.size() < work.loads.size();
}

double CellResponse::share() const {
    return static_cast<double>(work_->out.compliance_m_per_N.size()) / static_cast<double>(work_->loads.size());
}

Response CellResponse::take() {
    work_->out.interpolation_error = interpolation_error(work_->out);
    return std::move(work_->out);
}

Response response_of(const Part& part, const PartLoad& load, const ResponseRequest& request,
                     const ResponseProgress& progress) {
    if (request.method == Method::elastica || request.method == Method::factorised)
        throw files::bad_input(part.file, "method", name_of(request.method),
                               "one of paper, euler-bernoulli, timoshenko, voxels");
    if (request.method == Method::voxels) {
        CellResponse work(part, load, request);
        do {
            if (progress && !progress(work.share())) throw Cancelled("the response of " + part.name + " was cancelled");
        } while (work.advance());
        return work.take();
    }
    Response out;
    by_name(part, load, [&] { out = beam_response(part, load, request); });
    out.interpolation_error = interpolation_error(out);
    return out;
}

StationPlace place_of(const Response& response, double station_m) {
    const auto& x = response.station_m;
    if (x.size() < 2 || !(station_m > x.front())) return {0, 0.0};
    if (station_m >= x.back()) return {x.size() - 2, 1.0};
    const auto above = std::upper_bound(x.begin(), x.end(), station_m);
    const auto low = static_cast<std::size_t>(above - x.begin()) - 1;
    return {low, (station_m - x[low]) / (x[low + 1] - x[low])};
}

double compliance_at(const Response& response, const StationPlace& place) {
    const auto& c = response.compliance_m_per_N;
    if (place.share == 0.0) return c[place.low];
    if (place.share == 1.0) return c[place.low + 1];
    const double root = (1.0 - place.share) * std::cbrt(c[place.low]) + place.share * std::cbrt(c[place.low + 1]);
    return root * root * root;
}

double applies_to_m(const Response& response, const StationPlace& place) {
    const double to_m = response.validity.to_m;
    if (!(to_m > 0.0) || std::isinf(to_m)) return to_m;
    return to_m * std::cbrt(compliance_at(response, place) / response.compliance_m_per_N[response.named]);
}

std::array<double, 2> field_at(const Response& response, const StationPlace& place, double u_m, double v_m) {
    const double u = std::clamp(u_m / response.spacing_m, 0.0, response.nodes[0] - 1.0);
    const double v = std::clamp(v_m / response.spacing_m, 0.0, response.nodes[1] - 1.0);
    const int i = std::min(static_cast<int>(u), response.nodes[0] - 2),
              j = std::min(static_cast<int>(v), response.nodes[1] - 2);
    const double a = u - i, b = v - j;
    const std::size_t at[4] = {node_of(response, i, j), node_of(response, i + 1, j), node_of(response, i, j + 1),
                               node_of(response, i + 1, j + 1)};
    const double weight[4] = {(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b};
    std::array<double, 2> out{};
    for (std::size_t s = 0; s < 2; ++s) {
        const double share = s == 0 ? 1.0 - place.share : place.share;
        if (share == 0.0) continue;
        const std::vector<float>& field = response.field[place.low + s];
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t c = 0; c < 2; ++c) out[c] += share * weight[k] * static_cast<double>(field[at[k] + c]);
        }
    }
    return out;
}

}  // namespace palpa::parts
