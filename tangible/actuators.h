#pragma once
// The coordinate q of an actuator as a function of the nodes: the length of a cable (m), or minus the volume of a cavity
// (m^3), so that both pull q down with their force. With tension or pressure a, the energy of an actuator is a q(u).
//
//   cable   q = sum over the path of |x_k - x_k+1|, each x a mean over nodes or a place in space
//   cavity  q = sum over triangles (x0 . (x1 x x2)) / 6, the corners counter-clockwise seen from the cavity; quads are
//           split in both ways, with half the weight each. Exact for bilinear quads.
//
// Nodes from `free_nodes` on are held and get no forces.

#include <Eigen/Core>

#include "mechanics/band_matrix.h"
#include "tangible/device_file.h"
#include "tangible/places.h"

namespace palpa::tangible {

double coordinate(const SoftActuator& actuator, const Places& x) noexcept;
// Adds factor * dq/dx to out, 3 free_nodes numbers.
void add_gradient(const SoftActuator& actuator, const Places& x, int free_nodes, double factor,
                  Eigen::Ref<Eigen::VectorXd> out) noexcept;
// Adds factor * d2q/dx2.
void add_hessian(const SoftActuator& actuator, const Places& x, double factor, mechanics::BandMatrix& K) noexcept;
// Adds factor * dq/dx dq/dx^T of a cable.
void add_squared_gradient(const SoftActuator& cable, const Places& x, double factor, mechanics::BandMatrix& K) noexcept;

// Lists of nodes that add_hessian() couples, and with `squared` also add_squared_gradient().
std::vector<std::vector<int>> coupled_nodes(const SoftActuator& actuator, bool squared);

}  // namespace palpa::tangible
