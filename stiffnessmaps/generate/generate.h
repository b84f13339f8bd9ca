#pragma once
// `palpa maps generate`: makes a map of a phantom by virtual rolling indentation (mechanics/rolling.h). Here are jobs,
// progress, resuming, parts on a cluster, joining, and the estimate of the error by other meshes.

#include <filesystem>
#include <optional>
#include <string>

namespace palpa::stiffnessmaps {

struct Part {  // share number `index` of `count`, counted from 1
    int index = 1;
    int count = 1;
};

// Which meshes of a map: its own, those refined once to check it, or coarser ones to estimate its error.
enum class MeshSet { own, refined, coarser };

struct GenerateOptions {
    std::filesystem::path phantom;
    std::filesystem::path output;  // NAME.map; the pieces are in NAME.map.lines until they are joined
    bool analytic = false;         // closed-form stand-in (stiffnessmaps/analytic.h)
    int jobs = 1;
    std::optional<Part> part;
    bool merge = false;
    bool check = false;
    double coarseness = 1.0;
    std::optional<int> window;      // set in a call that run_jobs makes: compute this window only,
    MeshSet meshes = MeshSet::own;  // of these meshes
};

// Throws InputError for bad input and std::runtime_error if the run fails.
void generate_map(const GenerateOptions& options);

// Reads a part such as "2/8". Throws InputError.
Part parse_part(const std::string& text);
// Returns the part that a cluster's scheduler gives this process, from SLURM_ARRAY_TASK_ID with .._MIN and .._COUNT, or
// OMPI_COMM_WORLD_RANK with .._SIZE; nothing if neither is set. Throws InputError if one of them is not a whole number.
std::optional<Part> part_from_environment();

}  // namespace palpa::stiffnessmaps
