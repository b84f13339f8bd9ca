#pragma once
// Who computes the pieces of a map: worker processes of this program, or one process for a share of them. Pieces are files;
// those that are there already are not computed again.

#include "stiffnessmaps/generate/generate.h"
#include "stiffnessmaps/generate/pieces.h"

namespace palpa::stiffnessmaps {

// Numbers of the pieces, of `count`, that are not there or are wrong.
std::vector<std::size_t> missing(const MapTask& task, std::size_t count, std::string (*name)(std::size_t));

// All windows and lines, by worker processes.
void compute_with_jobs(const GenerateOptions& options, const MapTask& task);

// One share of the lines; windows that nobody has made yet are made on the way, whoever comes first.
void compute_part(const MapTask& task, const Part& part);

// The windows of another set of meshes, all of them; `what` stands beside their progress.
void compute_windows(const GenerateOptions& options, const MapTask& task, MeshSet meshes, const char* what);

}  // namespace palpa::stiffnessmaps
