#include "scene/linear_tissue.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "files/cache.h"
#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/body.h"
#include "mechanics/linear_range.h"
#include "mechanics/material.h"
#include "mechanics/statics.h"

namespace palpa::scene {
namespace {

constexpr int kLayers = 9;                  // over the thickness, finer towards the surface
constexpr double kDeepestShare = 0.45;      // of the thickness; no pose goes deeper, far beyond the linear range
constexpr double kMostCompliance_GB = 1.0;  // with friction: ten times the frictionless compliance
constexpr int kMostSlides = 16;  // half spacings per sample: over two contact radii, after which friction is steady
constexpr double kFrictionTolerance = 1e-5;  // of the largest force: 2e-6 from the converged one (docs/performance.md)
constexpr double kSlopeShare = 0.02;         // of a depth, over which push_to() takes the slope of the force
constexpr int kMostInContact = 256;          // nodes that memory is reserved for: a contact 16 spacings wide

mechanics::Material material_of(const stiffnessmaps::Elastic& elastic) { return {elastic.young_Pa, elastic.poisson}; }

mechanics::Body body_of(const stiffnessmaps::Phantom& phantom, std::size_t n_x, std::size_t n_y,
                        const std::optional<mechanics::Grading>& grading) {
    using namespace mechanics;
    const auto along = [&](std::size_t axis, std::size_t n) -> Eigen::VectorXd {
        const auto nodes = static_cast<Eigen::Index>(n);
        if (!grading) return Eigen::VectorXd::LinSpaced(nodes, 0.0, phantom.size_m[axis]);
        return graded_coordinates_m(phantom.size_m[axis], static_cast<int>(nodes) - 1, grading->centre_m[axis],
                                    grading->finest_m);
    };
    const double thickness_m = phantom.size_m[2];
    const double even_m = 0.5 * thickness_m / kLayers;
    const double finest_m = grading ? std::min(grading->finest_m, even_m) : even_m;
    Body body;
    body.mesh =
        hex_box(along(0, n_x), along(1, n_y), graded_coordinates_m(thickness_m, kLayers, thickness_m, finest_m));
    body.materials.assign(static_cast<std::size_t>(body.mesh.cells.cols()), material_of(phantom.tissue));
    constexpr int kSubdivisions = 4;
    for (const stiffnessmaps::PhantomNodule& nodule : phantom.nodules) {
        const Sphere sphere{{nodule.centre_m[0], nodule.centre_m[1], thickness_m - nodule.centre_m[2]},
                            0.5 * nodule.diameter_m};
        mix_in(sphere_share(body.mesh, sphere, kSubdivisions), material_of(nodule.material), Mixing::between,
               body.materials);
    }
    return body;
}

mechanics::ContactOptions contact_options(const LinearTissue& tissue) {
    mechanics::ContactOptions options;
    options.max_depth_m = kDeepestShare * tissue.phantom.size_m[2];
    return options;
}

std::vector<double> plain(const Eigen::Ref<const Eigen::MatrixXd>& values) {
    return {values.data(), values.data() + values.size()};
}

files::CachedArrays arrays_of(const mechanics::Compliance& c) {
    files::CachedArrays out{
        plain(c.position_m), plain(c.area_m2), {c.surface_z_m, c.thickness_m, c.asymmetry}, plain(c.normal_m_per_N)};
    if (c.full_m_per_N.size() > 0) out.push_back(plain(c.full_m_per_N));
    return out;
}

// Fills `out` from the cache. Returns false if the cache does not hold a complete compliance of these nodes.
bool restore(const std::filesystem::path& cache, std::uint64_t number, const mechanics::SurfaceRequest& request,
             mechanics::Compliance& out) {
    if (cache.empty()) return false;
    const auto arrays = files::read_cache(cache, number);
    const auto n = request.touch_nodes.size();
    if (!arrays || arrays->size() != (request.tangential ? 5u : 4u)) return false;
    if (request.tangential && arrays->back().size() != 9 * n * n) return false;
    const auto& [position, area, numbers, normal] = std::tie((*arrays)[0], (*arrays)[1], (*arrays)[2], (*arrays)[3]);
    if (position.size() != 3 * n || area.size() != n || numbers.size() != 3 || normal.size() != n * n) return false;
    const auto rows = static_cast<Eigen::Index>(n);
    out.revision = mechanics::new_revision();
    out.n_touch = static_cast<int>(n);
    out.node = request.touch_nodes;
    out.position_m = Eigen::Map<const Eigen::Matrix3Xd>(position.data(), 3, rows);
    out.area_m2 = Eigen::Map<const Eigen::VectorXd>(area.data(), rows);
    out.surface_z_m = numbers[0];
    out.thickness_m = numbers[1];
    out.asymmetry = numbers[2];
    out.normal_m_per_N = Eigen::Map<const Eigen::MatrixXd>(normal.data(), rows, rows);
    if (request.tangential)
        out.full_m_per_N = Eigen::Map<const Eigen::MatrixXd>(arrays->back().data(), 3 * rows, 3 * rows);
    return true;
}

void press_to(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, mechanics::ContactWork& work,
              mechanics::Contact& contact) {
    const mechanics::Tool tool{tissue.indenter, {p_m.x(), p_m.y(), depth_m}};
    mechanics::press_to_depth(tissue.compliance, {&tool, 1}, contact_options(tissue), work, contact);
}

// Slope of the frictionless contact's energy along u at a depth, N: positive uphill, negative downhill.
double energy_slope_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u, double depth_m,
                      SlopeWork& work, mechanics::Contact& probe) {
    if (u.isZero() || !(depth_m > 0.0)) return 0.0;
    const double window_m = spacing_at_m(tissue, p_m);
    press_to(tissue, p_m + 0.5 * window_m * u, depth_m, work.ahead, probe);
    const double ahead_J = probe.energy_J;
    press_to(tissue, p_m - 0.5 * window_m * u, depth_m, work.behind, probe);
    return (ahead_J - probe.energy_J) / window_m;
}

}  // namespace

LinearTissue make_linear_tissue(const LinearOptions& options, const std::filesystem::path& cache,
                                const mechanics::Progress& progress) {
    LinearTissue tissue;
    tissue.phantom = stiffnessmaps::read_phantom(options.phantom);
    if (!options.nodules) tissue.phantom.nodules.clear();
    tissue.indenter.shape = tissue.phantom.indenter == stiffnessmaps::IndenterShape::sphere
                                ? mechanics::IndenterShape::sphere
                                : mechanics::IndenterShape::cylinder;
    tissue.indenter.radius_m = tissue.phantom.indenter_radius_m;
    if (tissue.indenter.shape == mechanics::IndenterShape::cylinder)
        tissue.indenter.length_m = tissue.phantom.indenter_length_m;
    tissue.friction = options.friction;
    const auto nodes_along = [&](double length_m) {
        return 1 + static_cast<std::size_t>(std::max(2.0, std::round(length_m / options.spacing_m)));
    };
    tissue.n_x = nodes_along(tissue.phantom.size_m[0]);
    tissue.n_y = nodes_along(tissue.phantom.size_m[1]);
    constexpr std::size_t kMostNodes = 20000;  // 3.2 GB of compliance
    if (tissue.n_x * tissue.n_y > kMostNodes) {
        throw files::bad_input(options.phantom.string(), "",
                               std::to_string(tissue.n_x * tissue.n_y) + " surface nodes at " +
                                   files::short_number(1e3 * options.spacing_m) + " mm",
                               "at most 20000 (a larger spacing_mm)");
    }
    const double full_GB = 8e-9 * 10.0 * std::pow(static_cast<double>(tissue.n_x * tissue.n_y), 2.0);
    if (options.friction && full_GB > kMostCompliance_GB) {
        throw files::bad_input(
            options.phantom.string(), "",
            files::short_number(full_GB) + " GB of compliance with friction, at " +
                files::short_number(1e3 * options.spacing_m) + " mm",
            "at most " + files::short_number(kMostCompliance_GB) + " GB (a larger spacing_mm, or no friction)");
    }
    tissue.spacing_m[0] = tissue.phantom.size_m[0] / static_cast<double>(tissue.n_x - 1);
    tissue.spacing_m[1] = tissue.phantom.size_m[1] / static_cast<double>(tissue.n_y - 1);

    check_grading(options, tissue.phantom);
    mechanics::Problem problem =
        mechanics::problem_of(body_of(tissue.phantom, tissue.n_x, tissue.n_y, options.grading));
    tissue.mesh_nodes = static_cast<int>(problem.mesh.nodes_m.cols());
    const mechanics::Faces outer = mechanics::boundary_faces(problem.mesh);
    const mechanics::Faces bottom = mechanics::faces_on(problem.mesh, outer, mechanics::Side::zmin);
    mechanics::fix(mechanics::nodes_of(bottom), "xyz", 0.0, problem.supports);
    mechanics::SurfaceRequest request = mechanics::request_rectangle(
        problem.mesh, outer, {0.0, tissue.phantom.size_m[0], 0.0, tissue.phantom.size_m[1]});
    request.tangential = options.friction.has_value();
    const std::uint64_t number = mechanics::fingerprint(problem, request);
    tissue.content = number;
    tissue.from_cache = restore(cache, number, request, tissue.compliance);
    if (!tissue.from_cache) {
        // this scope frees the factor before the cache copies the compliance
        const mechanics::Factored factored = mechanics::factorise(problem, mechanics::best_solver());
        tissue.compliance = mechanics::surface_compliance(problem.mesh, factored, request, progress);
    }
    if (options.grading) take_grid(tissue);
    if (!cache.empty() && !tissue.from_cache)
        tissue.cache_warning = files::write_cache(cache, number, arrays_of(tissue.compliance));
    return tissue;
}

LinearWork make_work(const LinearTissue& tissue) {
    LinearWork out;
    for (mechanics::ContactWork* work :
         {&out.work, &out.slope.ahead, &out.slope.behind, &out.station, &out.station_slope.ahead,
          &out.station_slope.behind, &out.reference_slope.ahead, &out.reference_slope.behind}) {
        *work = mechanics::make_contact_work(tissue.compliance, kMostInContact);
    }
    if (tissue.friction) {
        out.friction_work = mechanics::make_friction_work(tissue.compliance, kMostInContact);
        out.friction.touch.reserve(kMostInContact);
        out.friction.force_N.reserve(3 * kMostInContact);
    }
    for (mechanics::Contact* contact : {&out.contact, &out.probe, &out.sliding}) {
        contact->touch.reserve(kMostInContact);
        contact->by_tool.reserve(kMostInContact);
        contact->force_N.reserve(kMostInContact);
        contact->tool.resize(1);
    }
    return out;
}

LinearAnswer press(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double force_N, LinearWork& work) {
    LinearAnswer answer;
    if (!(force_N > 0.0)) {
        press_to(tissue, p_m, 0.0, work.work, work.contact);
        return answer;
    }
    const mechanics::Tool tool{tissue.indenter, {p_m.x(), p_m.y(), work.depth_m}};
    mechanics::press_with_force(tissue.compliance, tool, force_N, contact_options(tissue), work.work, work.contact);
    const mechanics::ToolForce& out = work.contact.tool[0];
    answer.depth_m = out.depth_m;
    answer.saturated = work.contact.flags.capped;
    answer.inexact = work.contact.flags.not_settled || work.contact.flags.force_missed;
    work.depth_m = out.depth_m;
    const double width_m = 2.0 * std::sqrt(out.area_m2 / std::numbers::pi);
    answer.linearity = mechanics::linearity_ratio(out.depth_m, tissue.phantom.size_m[2], width_m);
    return answer;
}

double tangential_force_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u,
                          double depth_m, LinearWork& work) {
    return std::max(0.0, energy_slope_N(tissue, p_m, u, depth_m, work.slope, work.probe));
}

double tangential_rise_N(const LinearTissue& tissue, const Eigen::Vector2d& e_m, const Eigen::Vector2d& u,
                         double force_N, double reference_m, LinearWork& work) {
    if (!(force_N > 0.0)) return 0.0;
    const mechanics::Tool tool{tissue.indenter, {e_m.x(), e_m.y(), work.depth_m}};
    mechanics::press_with_force(tissue.compliance, tool, force_N, contact_options(tissue), work.station, work.probe);
    const double depth_m = work.probe.tool[0].depth_m;
    const Eigen::Vector2d before_m = e_m - reference_m * u;
    const double here_N = energy_slope_N(tissue, e_m, u, depth_m, work.station_slope, work.probe);
    const double before_N = energy_slope_N(tissue, before_m, u, depth_m, work.reference_slope, work.probe);
    return std::max(0.0, here_N) - std::max(0.0, before_N);
}

double rough_tangential_force_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u,
                                double depth_m, LinearWork& work) {
    return std::max(0.0, energy_slope_N(tissue, p_m, u, depth_m, work.slope, work.probe) + u.dot(work.drag_N));
}

void let_go(LinearWork& work) {
    work.friction.touching = false;
    work.friction.touch.clear();
    work.friction.force_N.clear();
    work.drag_N.setZero();
}

void drag(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, LinearWork& work) {
    if (!tissue.friction || !(depth_m > 0.0)) return let_go(work);
    mechanics::FrictionOptions options;
    options.coefficient = *tissue.friction;
    options.tolerance = kFrictionTolerance;
    options.max_depth_m = kDeepestShare * tissue.phantom.size_m[2];
    const auto slide = [&](const Eigen::Vector2d& at_m, double at_depth_m) {
        mechanics::slide_to(tissue.compliance, {tissue.indenter, {at_m.x(), at_m.y(), at_depth_m}}, options,
                            work.friction_work, work.friction, work.sliding);
    };
    const double step_m = 0.5 * spacing_at_m(tissue, p_m);
    const mechanics::Pose& last = work.friction.pose;
    Eigen::Vector2d from_m = work.friction.touching ? Eigen::Vector2d(last.x_m, last.y_m) : p_m;
    double from_depth_m = work.friction.touching ? last.depth_m : depth_m;
    if ((p_m - from_m).norm() > kMostSlides * step_m) {
        work.skipped_slides += static_cast<std::int64_t>((p_m - from_m).norm() / step_m) - kMostSlides;
        from_m = p_m - kMostSlides * step_m * (p_m - from_m).normalized();
        from_depth_m = depth_m;
        let_go(work);
        slide(from_m, from_depth_m);
    }
    const int steps = std::max(1, static_cast<int>(std::ceil((p_m - from_m).norm() / step_m - 1e-9)));
    for (int k = 1; k <= steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        slide(from_m + share * (p_m - from_m), from_depth_m + share * (depth_m - from_depth_m));
    }
    work.drag_N.setZero();
    for (std::size_t k = 0; k < work.friction.touch.size(); ++k) {
        work.drag_N += Eigen::Vector2d(work.friction.force_N[3 * k + 1], work.friction.force_N[3 * k + 2]);
    }
}

void surface_sink_m(const LinearTissue& tissue, const LinearWork& work, Eigen::VectorXd& out_m) {
    mechanics::surface_depression_m(tissue.compliance, work.contact, out_m);
}

namespace {

void rub(const LinearTissue& tissue, const Press& press, LinearWork& work, Contact& contact) {
    if (!press.down) return let_go(work);
    const std::int64_t before = work.skipped_slides;
    drag(tissue, press.p_m, contact.depth_m, work);
    contact.skipped_slides = work.skipped_slides - before;
    contact.inexact = contact.inexact || work.sliding.flags.not_settled;
}

}  // namespace

void answer(const LinearTissue& tissue, StageId stage, const Press& press, LinearWork& work, Contact& contact) {
    if (stage == StageId::friction) return rub(tissue, press, work, contact);
    if (!press.down) return;
    if (stage == StageId::depth) {
        const LinearAnswer found = scene::press(tissue, press.p_m, press.force_N / press.stiffness_scale, work);
        contact.depth_m = found.depth_m;
        contact.saturated = found.saturated;
        contact.inexact = found.inexact;
        contact.linearity = found.linearity;
        return;
    }
    const auto force_N = tissue.friction ? rough_tangential_force_N : tangential_force_N;
    contact.tangential_N = press.stiffness_scale * force_N(tissue, press.p_m, press.heading, contact.depth_m, work);
}

double rise_N(const LinearTissue& tissue, const Station& at, LinearWork& work) {
    return at.stiffness_scale *
           tangential_rise_N(tissue, at.p_m, at.u, at.force_N / at.stiffness_scale, at.reference_m, work);
}

void sample_surface(const LinearTissue& tissue, const SurfaceEffect&, const Contact&, const LinearWork& work,
                    SurfaceShape& shape) {
    if (tissue.graded) {
        Eigen::VectorXd node_sink_m;
        surface_sink_m(tissue, work, node_sink_m);
        return spread_evenly(tissue, node_sink_m, shape);
    }
    shape.n_x = static_cast<Eigen::Index>(tissue.n_x);
    shape.n_y = static_cast<Eigen::Index>(tissue.n_y);
    shape.spacing_m = {tissue.spacing_m[0], tissue.spacing_m[1]};
    surface_sink_m(tissue, work, shape.sink_m);
}

Push push_to(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, LinearWork& work) {
    press_to(tissue, p_m, depth_m, work.work, work.contact);
    const mechanics::ToolForce& tool = work.contact.tool[0];
    Push out{tool.normal_N, 0.0, tool.depth_m, work.contact.flags.capped, work.contact.flags.not_settled};
    const double before_m = tool.depth_m * (1.0 - kSlopeShare);
    press_to(tissue, p_m, before_m, work.station, work.probe);
    if (tool.depth_m > before_m)
        out.slope_N_per_m = (tool.normal_N - work.probe.tool[0].normal_N) / (tool.depth_m - before_m);
    return out;
}

}  // namespace palpa::scene
