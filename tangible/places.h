#pragma once
// Where the nodes of a body are now.

#include <Eigen/Core>
#include <cstddef>

namespace palpa::tangible {

inline std::size_t position(Eigen::Index i) { return static_cast<std::size_t>(i); }  // in a std::vector

struct Places {
    const Eigen::Matrix3Xd& rest_m;
    const Eigen::Matrix3Xd& u_m;
    Eigen::Vector3d operator()(int node) const { return rest_m.col(node) + u_m.col(node); }
};

}  // namespace palpa::tangible
