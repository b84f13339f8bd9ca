#pragma once
// The pattern of a mesh's stiffness matrix, and the sum of its cells' matrices.

#include <algorithm>
#include <vector>

#include "mechanics/mesh.h"
#include "mechanics/stiffness.h"

namespace palpa::mechanics {

// For each node i the nodes >= i that share a cell with it, ascending: node[start[i]] to node[start[i + 1] - 1].
struct Neighbours {
    std::vector<int> start;
    std::vector<int> node;
};
Neighbours neighbours_of(const Mesh& mesh);

// Returns the matrix with all values 0. Column 3 j + c holds rows c..2 of the diagonal block, and then three rows for
// each later neighbour.
LowerMatrix pattern_of(const Neighbours& near);

// Adds the stiffness Ke of a cell to the stored triangle of K.
template <int Corners>
void add_cell(const Neighbours& near, const Eigen::Matrix<int, Corners, 1>& nodes,
              const Eigen::Matrix<double, 3 * Corners, 3 * Corners>& Ke, LowerMatrix& K) {
    double* value = K.valuePtr();
    for (int b = 0; b < Corners; ++b) {
        const int j = nodes(b);
        const auto first = near.node.begin() + near.start[static_cast<std::size_t>(j)];
        const auto last = near.node.begin() + near.start[static_cast<std::size_t>(j) + 1];
        for (int a = 0; a < Corners; ++a) {
            if (nodes(a) < j) continue;
            const auto place = static_cast<int>(std::lower_bound(first, last, nodes(a)) - first);
            for (int c = 0; c < 3; ++c) {
                double* column = value + K.outerIndexPtr()[3 * j + c];
                if (place == 0) {
                    for (int r = c; r < 3; ++r) column[r - c] += Ke(3 * a + r, 3 * b + c);
                } else {
                    for (int r = 0; r < 3; ++r) column[3 * place - c + r] += Ke(3 * a + r, 3 * b + c);
                }
            }
        }
    }
}

}  // namespace palpa::mechanics
