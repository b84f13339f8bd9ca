#include "study/score.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa::study {
namespace {

constexpr double kNoMark_m = 1e6;  // the cost of a missed target, above any sum of distances

// Returns the column of each row such that the sum of the costs is least and no column is used twice; needs rows <=
// columns. Shortest augmenting paths with potentials (Jonker & Volgenant, Computing 38 (1987) 325); row and column 0
// are not used.
std::vector<int> cheapest_columns(const std::vector<std::vector<double>>& cost) {
    const std::size_t rows = cost.size();
    const std::size_t columns = rows == 0 ? 0 : cost.front().size();
    std::vector<double> u(rows + 1, 0.0), v(columns + 1, 0.0);
    std::vector<std::size_t> row_of(columns + 1, 0), way(columns + 1, 0);
    for (std::size_t row = 1; row <= rows; ++row) {
        std::vector<double> least(columns + 1, std::numeric_limits<double>::infinity());
        std::vector<bool> visited(columns + 1, false);
        row_of[0] = row;
        std::size_t at = 0;
        do {
            visited[at] = true;
            const std::size_t from = row_of[at];
            double step = std::numeric_limits<double>::infinity();
            std::size_t next = 0;
            for (std::size_t j = 1; j <= columns; ++j) {
                if (visited[j]) continue;
                const double reduced = cost[from - 1][j - 1] - u[from] - v[j];
                if (reduced < least[j]) {
                    least[j] = reduced;
                    way[j] = at;
                }
                if (least[j] < step) {
                    step = least[j];
                    next = j;
                }
            }
            for (std::size_t j = 0; j <= columns; ++j) {
                if (visited[j]) {
                    u[row_of[j]] += step;
                    v[j] -= step;
                } else {
                    least[j] -= step;
                }
            }
            at = next;
        } while (row_of[at] != 0);
        for (; at != 0; at = way[at]) row_of[at] = row_of[way[at]];
    }
    std::vector<int> column_of(rows, -1);
    for (std::size_t j = 1; j <= columns; ++j) {
        if (row_of[j] > 0) column_of[row_of[j] - 1] = static_cast<int>(j) - 1;
    }
    return column_of;
}

void judge(std::span<const Target> targets, const MarkedPlace& mark, MarkScore& score) {
    if (score.kind == MarkKind::hit) return;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const double d_m = distance_m(targets[t], mark);
        if (d_m >= nearest_m) continue;
        nearest_m = d_m;
        score.target = static_cast<int>(t);
        score.distance_m = d_m;
        score.kind = d_m <= acceptance_radius_m(targets[t]) ? MarkKind::again : MarkKind::false_mark;
    }
}

}  // namespace

double acceptance_radius_m(const Target& target) {
    constexpr double kLeast_m = 8e-3;
    return std::max(target.diameter_m, kLeast_m);
}

double distance_m(const Target& target, const MarkedPlace& mark) {
    const double half_m = std::max(0.0, 0.5 * (target.length_m - target.diameter_m));
    const double dx = mark.x_m - target.x_m;
    const double dy = mark.y_m - target.y_m;
    const double along = dx * std::cos(target.angle_rad) + dy * std::sin(target.angle_rad);
    const double across = dy * std::cos(target.angle_rad) - dx * std::sin(target.angle_rad);
    return std::hypot(along - std::clamp(along, -half_m, half_m), across);
}

Score score_marks(std::span<const Target> targets, std::span<const MarkedPlace> marks) {
    Score score;
    score.marks.resize(marks.size());
    std::vector<std::vector<double>> cost(targets.size(),
                                          std::vector<double>(marks.size() + targets.size(), kNoMark_m));
    for (std::size_t t = 0; t < targets.size(); ++t) {
        for (std::size_t m = 0; m < marks.size(); ++m) {
            const double d_m = distance_m(targets[t], marks[m]);
            if (d_m <= acceptance_radius_m(targets[t])) cost[t][m] = d_m;
        }
    }
    score.found_by = cheapest_columns(cost);
    for (std::size_t t = 0; t < targets.size(); ++t) {
        int& mark = score.found_by[t];
        const auto m = static_cast<std::size_t>(mark);
        if (m >= marks.size() || cost[t][m] >= kNoMark_m) {
            mark = -1;
            continue;
        }
        score.marks[m] = {MarkKind::hit, static_cast<int>(t), cost[t][m]};
        ++score.true_positives;
    }
    for (std::size_t m = 0; m < marks.size(); ++m) {
        judge(targets, marks[m], score.marks[m]);
        score.false_positives += score.marks[m].kind == MarkKind::false_mark ? 1 : 0;
    }
    score.false_negatives = static_cast<int>(targets.size()) - score.true_positives;
    score.sensitivity = static_cast<double>(score.true_positives) / static_cast<double>(targets.size());
    score.ppv = static_cast<double>(score.true_positives) / (score.true_positives + score.false_positives);
    return score;
}

}  // namespace palpa::study
