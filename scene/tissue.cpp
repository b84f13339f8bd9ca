#include "scene/tissue.h"

#include <cassert>

namespace palpa::scene {
namespace {

// Calls call(tissue, work) with the alternatives that both hold. The work must be one that make_work() of this tissue
// made (assert).
template <class Work, class Call>
auto with_work(const Tissue& tissue, Work& work, const Call& call) {
    return std::visit(
        [&](const auto& of_kind) {
            auto* const its_work = std::get_if<decltype(make_work(of_kind))>(&work);
            assert(its_work != nullptr);
            return call(of_kind, *its_work);
        },
        tissue);
}

}  // namespace

bool takes_seconds(const TissueOptions& options) {
    return std::visit([](const auto& of_kind) { return takes_seconds(of_kind); }, options);
}

std::vector<std::filesystem::path> input_files(const TissueOptions& options) {
    return std::visit([](const auto& of_kind) { return input_files(of_kind); }, options);
}

files::Json file_hashes(const TissueOptions& options) {
    return std::visit([](const auto& of_kind) { return file_hashes(of_kind); }, options);
}

std::filesystem::path map_folder(const TissueOptions& options) {
    return std::visit([](const auto& of_kind) { return map_folder(of_kind); }, options);
}

const PartOptions* part_options(const TissueOptions& options) { return std::get_if<PartOptions>(&options); }
PartOptions* part_options(TissueOptions& options) { return std::get_if<PartOptions>(&options); }

void leave_out_nodules(TissueOptions& options) {
    std::visit(
        [](auto& of_kind) {
            if constexpr (requires { of_kind.nodules; }) of_kind.nodules = false;
        },
        options);
}

Tissue prepare(const TissueOptions& options, const Scene& scene, const mechanics::Progress& progress) {
    return std::visit([&](const auto& of_kind) { return Tissue(prepare(of_kind, scene, progress)); }, options);
}

bool serves(const Tissue& tissue, const Scene& scene) {
    return std::visit([&](const auto& of_kind) { return serves(of_kind, scene); }, tissue);
}

const LinearTissue* block_of(const Tissue& tissue) { return std::get_if<LinearTissue>(&tissue); }

const ForceCurve* curve_of(const Tissue& tissue) {
    if (const auto* curve = std::get_if<ForceCurveTissue>(&tissue)) return &curve->options.curve;
    if (const auto* block = std::get_if<SoftBlockTissue>(&tissue)) return &block->curve;
    return nullptr;
}

const PartTissue* parts_of(const Tissue& tissue) { return std::get_if<PartTissue>(&tissue); }

const PartWork* part_work_of(const TissueWork& work) { return std::get_if<PartWork>(&work); }

const char* next_method(const Tissue& tissue, TissueWork& work) {
    const PartTissue* parts = parts_of(tissue);
    return parts ? next_method(*parts, std::get<PartWork>(work)) : nullptr;
}

std::optional<std::int64_t> switch_events(const Tissue& tissue, const TissueWork& work) {
    const PartTissue* parts = parts_of(tissue);
    return parts ? switch_events(*parts, std::get<PartWork>(work)) : std::nullopt;
}

void describe(const Tissue& tissue, const Scene& scene, Plan& plan) {
    std::visit([&](const auto& of_kind) { describe(of_kind, scene, plan); }, tissue);
}

std::vector<Stage> stages(const Tissue& tissue, const Scene& scene) {
    return std::visit([&](const auto& of_kind) { return stages(of_kind, scene); }, tissue);
}

files::Json identity(const Tissue& tissue) {
    return std::visit([](const auto& of_kind) { return identity(of_kind); }, tissue);
}

TissueWork make_work(const Tissue& tissue) {
    return std::visit([](const auto& of_kind) { return TissueWork(make_work(of_kind)); }, tissue);
}

void answer(const Tissue& tissue, StageId stage, const Press& press, TissueWork& work, Contact& contact) {
    with_work(tissue, work,
              [&](const auto& of_kind, auto& its_work) { answer(of_kind, stage, press, its_work, contact); });
}

double rise_N(const Tissue& tissue, const Station& station, TissueWork& work) {
    return with_work(tissue, work,
                     [&](const auto& of_kind, auto& its_work) { return rise_N(of_kind, station, its_work); });
}

Push push_to(const Tissue& tissue, const Eigen::Vector2d& p_m, double depth_m, TissueWork& work) {
    return with_work(tissue, work, [&](const auto& of_kind, auto& its_work) {
        return depth_m > 0.0 ? push_to(of_kind, p_m, depth_m, its_work) : Push{};
    });
}

void sample_surface(const Tissue& tissue, const SurfaceEffect& effect, const Contact& contact, const TissueWork& work,
                    SurfaceShape& shape) {
    with_work(tissue, work, [&](const auto& of_kind, const auto& its_work) {
        sample_surface(of_kind, effect, contact, its_work, shape);
    });
}

}  // namespace palpa::scene
