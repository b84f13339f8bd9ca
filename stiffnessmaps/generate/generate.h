#pragma once
// `palpa maps generate`: a phantom becomes a map by virtual rolling indentation (mechanics/rolling.h). Jobs,
// progress, resume, parts on a cluster, joining, and what other meshes say of the error.

#include <filesystem>
#include <optional>
#include <string>

namespace palpa::stiffnessmaps {

struct Part {  // share number `index` of `count`, counted from 1
    int index = 1;
    int count = 1;
};

// Which of a map's meshes: its own, those refined once that check it, coarser ones that its error is estimated from.
enum class MeshSet { own, refined, coarser };

struct GenerateOptions {
    std::filesystem::path phantom;
    std::filesystem::path output;  // NAME.map; the pieces stand in NAME.map.lines until they are joined
    bool analytic = false;         // closed-form stand-in (stiffnessmaps/analytic.h)
    int jobs = 1;
    std::optional<Part> part;
    bool merge = false;
    bool check = false;
    double coarseness = 1.0;
    std::optional<int> window;      // one call of run_jobs: this window only,
    MeshSet meshes = MeshSet::own;  // of these meshes
};

// Throws InputError for bad input and std::runtime_error when the run fails.
void generate_map(const GenerateOptions& options);

// "2/8"; throws InputError.
Part parse_part(const std::string& text);
// The share that a cluster's scheduler gives this process: SLURM_ARRAY_TASK_ID with .._MIN and .._COUNT, or
// OMPI_COMM_WORLD_RANK with .._SIZE. Nothing when neither is set.
std::optional<Part> part_from_environment();

}  // namespace palpa::stiffnessmaps
