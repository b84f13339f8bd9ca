#pragma once
// Computes the pieces of a map, by worker processes of this program or by one process for a share of them. Pieces are
// files; existing ones are not computed again.

#include "stiffnessmaps/generate/generate.h"
#include "stiffnessmaps/generate/pieces.h"

namespace palpa::stiffnessmaps {

// Returns the numbers of those of `count` pieces that are missing or wrong.
std::vector<std::size_t> missing(const MapTask& task, std::size_t count, std::string (*name)(std::size_t));

// Computes all windows and lines by worker processes.
void compute_with_jobs(const GenerateOptions& options, const MapTask& task);

// Computes one share of the lines. Windows that no process has computed yet are computed first, by the process that
// takes each first.
void compute_part(const MapTask& task, const Part& part);

// Computes all windows of another set of meshes; `what` stands beside their progress.
void compute_windows(const GenerateOptions& options, const MapTask& task, MeshSet meshes, const char* what);

}  // namespace palpa::stiffnessmaps
