#include "mechanics/supports.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>

#include "mechanics/error.h"
#include "mechanics/mesh_check.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Rigid = Eigen::Matrix<double, 3, 6>;  // displacement of a point per unit of each rigid motion

// u = t + w x r / L, with the columns t_x t_y t_z w_x w_y w_z.
Rigid rigid_motions(const Vector3d& x, const Vector3d& centre, double length) {
    const Vector3d r = (x - centre) / length;
    Rigid m;
    m << 1, 0, 0, 0, r.z(), -r.y(), 0, 1, 0, -r.z(), 0, r.x(), 0, 0, 1, r.y(), -r.x(), 0;
    return m;
}

struct Frame {
    Vector3d centre = Vector3d::Zero();
    double length = 1.0;
};

Frame frame_of(const Mesh& mesh, const std::vector<int>& nodes) {
    Vector3d low = mesh.nodes_m.col(nodes.front());
    Vector3d high = low;
    for (const int node : nodes) {
        low = low.cwiseMin(mesh.nodes_m.col(node));
        high = high.cwiseMax(mesh.nodes_m.col(node));
    }
    return {0.5 * (low + high), std::max((high - low).maxCoeff(), 1e-300)};
}

std::vector<std::vector<int>> nodes_by_part(const Mesh& mesh, const Parts& parts) {
    std::vector<std::vector<int>> nodes(static_cast<std::size_t>(parts.count));
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        auto& list = nodes[static_cast<std::size_t>(parts.of_cell[static_cast<std::size_t>(cell)])];
        for (Index k = 0; k < mesh.cells.rows(); ++k) list.push_back(mesh.cells(k, cell));
    }
    for (auto& list : nodes) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return nodes;
}

// Returns the Gram matrix A^T A of the conditions A on the rigid motions of all parts, six per part.
Eigen::MatrixXd motion_conditions(const Mesh& mesh, const Supports& supports,
                                  const std::vector<std::vector<int>>& nodes, const std::vector<Frame>& frames) {
    std::vector<std::vector<int>> parts_of_node(static_cast<std::size_t>(mesh.nodes_m.cols()));
    for (std::size_t p = 0; p < nodes.size(); ++p) {
        for (const int node : nodes[p]) parts_of_node[static_cast<std::size_t>(node)].push_back(static_cast<int>(p));
    }
    const auto motions = [&](int node, int part) {
        const Frame& frame = frames[static_cast<std::size_t>(part)];
        return rigid_motions(mesh.nodes_m.col(node), frame.centre, frame.length);
    };
    Eigen::MatrixXd gram =
        Eigen::MatrixXd::Zero(6 * static_cast<Index>(nodes.size()), 6 * static_cast<Index>(nodes.size()));
    for (const int dof : supports.dof) {
        for (const int part : parts_of_node[static_cast<std::size_t>(dof / 3)]) {
            const Eigen::Matrix<double, 1, 6> row = motions(dof / 3, part).row(dof % 3);
            gram.block<6, 6>(6 * part, 6 * part) += row.transpose() * row;
        }
    }
    for (int node = 0; node < mesh.nodes_m.cols(); ++node) {
        const std::vector<int>& here = parts_of_node[static_cast<std::size_t>(node)];
        for (std::size_t i = 1; i < here.size(); ++i) {
            const int a = here[0];
            const int b = here[i];
            const Rigid ma = motions(node, a);
            const Rigid mb = motions(node, b);
            gram.block<6, 6>(6 * a, 6 * a) += ma.transpose() * ma;
            gram.block<6, 6>(6 * b, 6 * b) += mb.transpose() * mb;
            gram.block<6, 6>(6 * a, 6 * b) -= ma.transpose() * mb;
            gram.block<6, 6>(6 * b, 6 * a) -= mb.transpose() * ma;
        }
    }
    return gram;
}

std::string motion_names(const Eigen::Matrix<double, 6, 1>& motion) {
    constexpr const char* kNames[] = {"translation x",    "translation y",    "translation z",
                                      "rotation about x", "rotation about y", "rotation about z"};
    std::string out;
    for (int k = 0; k < 6; ++k) {
        if (std::abs(motion(k)) > 0.3 * motion.cwiseAbs().maxCoeff()) out += text(out.empty() ? "" : " + ", kNames[k]);
    }
    return out;
}

// Returns the names of the rigid motions that these conditions, one per row, leave free.
std::string free_motions(const Eigen::MatrixXd& conditions) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(conditions.transpose() * conditions);
    std::string names;
    for (Index k = 0; k < 6 && eigen.eigenvalues()(k) < 1e-10 * eigen.eigenvalues()(5); ++k)
        names += text(names.empty() ? "" : "; ", motion_names(eigen.eigenvectors().col(k)));
    return names;
}

// Prescribes the rigid motion of a body that a support touches. The prescribed dofs must determine one motion, else it
// throws SupportError; the motion then holds for the body's other nodes too. Returns false if no support touches the
// body.
bool prescribe_body(const Mesh& mesh, const std::vector<int>& nodes, const Frame& frame, Reduction& reduction) {
    Eigen::MatrixXd rows(0, 6);
    Eigen::VectorXd values(0);
    int touched = -1;
    for (const int node : nodes) {
        const Rigid motions = rigid_motions(mesh.nodes_m.col(node), frame.centre, frame.length);
        for (int c = 0; c < 3; ++c) {
            if (reduction.equation[static_cast<std::size_t>(3 * node + c)] != kPrescribed) continue;
            if (touched < 0) touched = node;
            rows.conservativeResize(rows.rows() + 1, 6);
            values.conservativeResize(values.size() + 1);
            rows.bottomRows<1>() = motions.row(c);
            values(values.size() - 1) = reduction.prescribed_m(3 * node + c);
        }
    }
    if (rows.rows() == 0) return false;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
    const Eigen::VectorXd q = qr.rank() == 6 ? Eigen::VectorXd(qr.solve(values)) : Eigen::VectorXd::Zero(6);
    const double misfit = (rows * q - values).cwiseAbs().maxCoeff();
    if (qr.rank() < 6 || misfit > 1e-9 * values.cwiseAbs().maxCoeff()) {
        const Vector3d mm = 1e3 * frame.centre;
        throw SupportError(
            text("a rigid inclusion of ", nodes.size(), " nodes around ", mm.x(), ", ", mm.y(), ", ", mm.z(),
                 " mm that a support touches, at ", describe_node(mesh, touched), ", and ",
                 qr.rank() < 6 ? text("leaves free to move in ", 6 - qr.rank(), " ways (", free_motions(rows), ")")
                               : text("strains by ", 1e3 * misfit, " mm")),
            -1);
    }
    for (const int node : nodes) {
        const Vector3d u = rigid_motions(mesh.nodes_m.col(node), frame.centre, frame.length) * q;
        for (int c = 0; c < 3; ++c) {
            reduction.equation[static_cast<std::size_t>(3 * node + c)] = kPrescribed;
            reduction.prescribed_m(3 * node + c) = u(c);
        }
    }
    return true;
}

// Returns the nodes of each rigid body; rigid cells that share a node are one body.
std::vector<std::vector<int>> rigid_bodies(const Mesh& mesh, const std::vector<bool>& rigid_cell) {
    std::vector<int> label(static_cast<std::size_t>(mesh.nodes_m.cols()), -1);
    const auto label_at = [&](Index k, Index cell) -> int& {
        return label[static_cast<std::size_t>(mesh.cells(k, cell))];
    };
    for (bool changed = true; changed;) {  // spreads the lowest node number over each body until it covers the body
        changed = false;
        for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
            if (!rigid_cell[static_cast<std::size_t>(cell)]) continue;
            int lowest = mesh.cells.col(cell).minCoeff();
            for (Index k = 0; k < mesh.cells.rows(); ++k) {
                if (label_at(k, cell) >= 0) lowest = std::min(lowest, label_at(k, cell));
            }
            for (Index k = 0; k < mesh.cells.rows(); ++k) {
                if (label_at(k, cell) == lowest) continue;
                label_at(k, cell) = lowest;
                changed = true;
            }
        }
    }
    std::vector<std::vector<int>> bodies;
    std::vector<int> body_of(label.size(), -1);
    for (std::size_t node = 0; node < label.size(); ++node) {
        if (label[node] < 0) continue;
        int& body = body_of[static_cast<std::size_t>(label[node])];
        if (body < 0) {
            body = static_cast<int>(bodies.size());
            bodies.emplace_back();
        }
        bodies[static_cast<std::size_t>(body)].push_back(static_cast<int>(node));
    }
    return bodies;
}

}  // namespace

void fix(const std::vector<int>& nodes, std::string_view axes, double value_m, Supports& supports) {
    for (const char letter : axes) {
        if (letter < 'x' || letter > 'z') {
            throw SupportError(text("support fixes \"", axes, "\"; wanted some of x, y and z"), -1);
        }
        for (const int node : nodes) {
            supports.dof.push_back(3 * node + (letter - 'x'));
            supports.value_m.push_back(value_m);
        }
    }
}

void check_supported(const Mesh& mesh, const Supports& supports) {
    constexpr int kMostParts = 200;  // the eigenvalues of a 1200 x 1200 matrix take seconds
    const Parts parts = parts_of(mesh);
    if (parts.count > kMostParts) {
        throw SupportError(text("mesh falls into ", parts.count, " parts that share no faces, at most ", kMostParts,
                                " are accepted; ", describe_part(mesh, parts, 1)),
                           1);
    }
    const std::vector<std::vector<int>> nodes = nodes_by_part(mesh, parts);
    std::vector<Frame> frames;
    for (const auto& list : nodes) frames.push_back(frame_of(mesh, list));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(motion_conditions(mesh, supports, nodes, frames));
    const double largest = std::max(eigen.eigenvalues().maxCoeff(), 1.0);
    Index free = 0;
    while (free < eigen.eigenvalues().size() && eigen.eigenvalues()(free) < 1e-10 * largest) ++free;
    if (free == 0) return;

    // the part that has most of the free motion
    const Eigen::MatrixXd motions = eigen.eigenvectors().leftCols(free);
    int part = 0;
    for (int p = 1; p < parts.count; ++p) {
        if (motions.middleRows<6>(6 * p).squaredNorm() > (1.0 + 1e-9) * motions.middleRows<6>(6 * part).squaredNorm())
            part = p;
    }
    std::string names;
    for (Index k = 0; k < free; ++k) {
        if (motions.col(k).segment<6>(6 * part).norm() < 1e-3) continue;
        names += text(names.empty() ? "" : "; ", motion_names(motions.col(k).segment<6>(6 * part)));
    }
    throw SupportError(
        text(describe_part(mesh, parts, part), " is not held: free to move in ", free, " ways (", names, ")"), part);
}

Reduction make_reduction(const Mesh& mesh, const Supports& supports, const std::vector<bool>& rigid_cell) {
    const Index n_dof = 3 * mesh.nodes_m.cols();
    Reduction reduction;
    reduction.equation.assign(static_cast<std::size_t>(n_dof), kLoose);
    reduction.prescribed_m = Eigen::VectorXd::Zero(n_dof);
    const auto equation = [&](int dof) -> int& { return reduction.equation[static_cast<std::size_t>(dof)]; };
    for (Index i = 0; i < mesh.cells.size(); ++i) {
        for (int c = 0; c < 3; ++c) equation(3 * mesh.cells.data()[i] + c) = 0;
    }
    for (std::size_t i = 0; i < supports.dof.size(); ++i) {
        const int dof = supports.dof[i];
        if (equation(dof) == kLoose) continue;
        if (equation(dof) == kPrescribed && reduction.prescribed_m(dof) != supports.value_m[i]) {
            throw SupportError(
                text(describe_node(mesh, dof / 3), " is given two displacements along ", "xyz"[dof % 3], ": ",
                     1e3 * reduction.prescribed_m(dof), " mm and ", 1e3 * supports.value_m[i], " mm"),
                -1);
        }
        equation(dof) = kPrescribed;
        reduction.prescribed_m(dof) = supports.value_m[i];
    }
    std::vector<std::vector<int>> bodies;
    if (!rigid_cell.empty()) bodies = rigid_bodies(mesh, rigid_cell);
    std::erase_if(bodies, [&](const std::vector<int>& nodes) {
        return prescribe_body(mesh, nodes, frame_of(mesh, nodes), reduction);
    });
    for (const auto& nodes : bodies) {
        for (const int node : nodes) {
            for (int c = 0; c < 3; ++c) equation(3 * node + c) = kOnBody;
        }
    }
    for (int dof = 0; dof < n_dof; ++dof) {
        if (equation(dof) >= 0) equation(dof) = reduction.equations++;
    }
    std::vector<Eigen::Triplet<double>> rows;
    for (const auto& nodes : bodies) {
        const Frame frame = frame_of(mesh, nodes);
        for (const int node : nodes) {
            const Rigid motions = rigid_motions(mesh.nodes_m.col(node), frame.centre, frame.length);
            for (int c = 0; c < 3; ++c) {
                for (int k = 0; k < 6; ++k) rows.emplace_back(3 * node + c, reduction.equations + k, motions(c, k));
            }
        }
        reduction.equations += 6;
    }
    reduction.body.resize(n_dof, reduction.equations);
    reduction.body.setFromTriplets(rows.begin(), rows.end());
    return reduction;
}

LowerMatrix reduce(const LowerMatrix& K, const Reduction& reduction) {
    const auto equation = [&](Index dof) { return reduction.equation[static_cast<std::size_t>(dof)]; };
    if (reduction.body.nonZeros() > 0) {
        std::vector<Eigen::Triplet<double>> ones;
        for (Index dof = 0; dof < K.rows(); ++dof) {
            if (equation(dof) >= 0) ones.emplace_back(dof, equation(dof), 1.0);
        }
        Eigen::SparseMatrix<double> T(K.rows(), reduction.equations);
        T.setFromTriplets(ones.begin(), ones.end());
        T += Eigen::SparseMatrix<double>(reduction.body);
        const Eigen::SparseMatrix<double> full = K.selfadjointView<Eigen::Lower>();
        const Eigen::SparseMatrix<double> KT = full * T;
        const Eigen::SparseMatrix<double> product = T.transpose() * KT;
        return product.triangularView<Eigen::Lower>();
    }
    LowerMatrix out(reduction.equations, reduction.equations);
    out.reserve(K.nonZeros());
    for (Index column = 0; column < K.cols(); ++column) {
        if (equation(column) < 0) continue;
        out.startVec(equation(column));
        for (LowerMatrix::InnerIterator it(K, column); it; ++it) {
            if (equation(it.row()) >= 0) out.insertBack(equation(it.row()), equation(column)) = it.value();
        }
    }
    out.finalize();
    return out;
}

void add_force(const Reduction& reduction, int dof, double force_N, Eigen::Ref<Eigen::VectorXd> rhs) {
    const int equation = reduction.equation[static_cast<std::size_t>(dof)];
    if (equation >= 0) rhs(equation) += force_N;
    if (equation != kOnBody) return;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(reduction.body, dof); it; ++it) {
        rhs(it.col()) += force_N * it.value();
    }
}

double displacement_m(const Reduction& reduction, int dof, const Eigen::Ref<const Eigen::VectorXd>& q_m) {
    const int equation = reduction.equation[static_cast<std::size_t>(dof)];
    if (equation >= 0) return q_m(equation);
    if (equation != kOnBody) return reduction.prescribed_m(dof);
    double sum = 0.0;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(reduction.body, dof); it; ++it) {
        sum += it.value() * q_m(it.col());
    }
    return sum;
}

Eigen::VectorXd reduce_load(const Reduction& reduction, const Eigen::VectorXd& f_N) {
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(reduction.equations);
    for (int dof = 0; dof < f_N.size(); ++dof) add_force(reduction, dof, f_N(dof), rhs);
    return rhs;
}

Eigen::VectorXd expand(const Reduction& reduction, const Eigen::VectorXd& q_m) {
    Eigen::VectorXd u(reduction.prescribed_m.size());
    for (int dof = 0; dof < u.size(); ++dof) u(dof) = displacement_m(reduction, dof, q_m);
    return u;
}

}  // namespace palpa::mechanics
