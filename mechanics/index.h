#pragma once
// Node numbers of meshes (int) and indices of Eigen (std::ptrdiff_t) as positions in a std::vector.

#include <cstddef>

namespace palpa::mechanics {

inline std::size_t at(std::ptrdiff_t i) { return static_cast<std::size_t>(i); }

}  // namespace palpa::mechanics
