#include "stiffnessmaps/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa::stiffnessmaps {
namespace {

// Blurs one line along x (stride 1) or y (stride n_x): weighted values and weights alike.
void blur_line(std::vector<double>& values, std::vector<double>& weights, std::size_t start, std::size_t stride,
               std::size_t n, const std::vector<double>& kernel) {
    const auto reach = static_cast<std::ptrdiff_t>(kernel.size()) - 1;
    std::vector<double> value(n);
    std::vector<double> weight(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
            const auto j = static_cast<std::ptrdiff_t>(i) + k;
            if (j < 0 || j >= static_cast<std::ptrdiff_t>(n)) continue;
            const std::size_t at = start + static_cast<std::size_t>(j) * stride;
            const double g = kernel[static_cast<std::size_t>(std::abs(k))];
            value[i] += g * values[at];
            weight[i] += g * weights[at];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        values[start + i * stride] = value[i];
        weights[start + i * stride] = weight[i];
    }
}

// Returns half of the kernel, out to four sigmas but no farther than the line is long.
std::vector<double> gaussian(double sigma_in_cells, std::size_t n) {
    const double reach = std::min(std::ceil(4.0 * sigma_in_cells), static_cast<double>(n - 1));
    std::vector<double> kernel(1 + static_cast<std::size_t>(reach));
    for (std::size_t k = 0; k < kernel.size(); ++k) {
        const double s = static_cast<double>(k) / sigma_in_cells;
        kernel[k] = std::exp(-0.5 * s * s);
    }
    return kernel;
}

}  // namespace

std::vector<double> smooth(const std::vector<double>& values, const GridShape& shape, double sigma_m) {
    if (sigma_m <= 0.0) return values;
    std::vector<double> sums(values.size());
    std::vector<double> weights(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        sums[i] = values[i];
        weights[i] = 1.0;
    }
    const auto along_x = gaussian(sigma_m / shape.dx_m, shape.n_x);
    const auto along_y = gaussian(sigma_m / shape.dy_m, shape.n_y);
    for (std::size_t j = 0; j < shape.n_y; ++j) blur_line(sums, weights, j * shape.n_x, 1, shape.n_x, along_x);
    for (std::size_t i = 0; i < shape.n_x; ++i) blur_line(sums, weights, i, shape.n_x, shape.n_y, along_y);
    for (std::size_t i = 0; i < values.size(); ++i) {
        sums[i] = std::isnan(values[i]) ? kMissing : sums[i] / weights[i];
    }
    return sums;
}

void fill_missing(std::vector<double>& values, const GridShape& shape) {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) missing.push_back(i);
    }
    if (missing.size() == values.size()) return;
    while (!missing.empty()) {
        std::vector<std::pair<std::size_t, double>> found;
        std::vector<std::size_t> still;
        for (const std::size_t at : missing) {
            const std::size_t x = at % shape.n_x;
            const std::size_t y = at / shape.n_x;
            double sum = 0.0;
            int count = 0;
            for (std::size_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, shape.n_y - 1); ++j) {
                for (std::size_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, shape.n_x - 1); ++i) {
                    const double value = values[j * shape.n_x + i];
                    if (std::isnan(value)) continue;
                    sum += value;
                    ++count;
                }
            }
            if (count > 0) {
                found.emplace_back(at, sum / count);
            } else {
                still.push_back(at);
            }
        }
        for (const auto& [at, value] : found) values[at] = value;
        missing = std::move(still);
    }
}

Gradient gradient(const std::vector<double>& values, const GridShape& shape) {
    Gradient out{std::vector<double>(values.size()), std::vector<double>(values.size())};
    const auto difference = [&](std::size_t at, std::size_t i, std::size_t n, std::size_t stride, double step_m) {
        if (n < 2) return 0.0;
        const std::size_t back = i > 0 ? stride : 0;
        const std::size_t ahead = i + 1 < n ? stride : 0;
        const double span_m = step_m * static_cast<double>((back + ahead) / stride);
        return (values[at + ahead] - values[at - back]) / span_m;
    };
    for (std::size_t j = 0; j < shape.n_y; ++j) {
        for (std::size_t i = 0; i < shape.n_x; ++i) {
            const std::size_t at = j * shape.n_x + i;
            out.x[at] = difference(at, i, shape.n_x, 1, shape.dx_m);
            out.y[at] = difference(at, j, shape.n_y, shape.n_x, shape.dy_m);
        }
    }
    return out;
}

void make_isotonic(std::vector<double>& values) {
    struct Block {
        double sum;
        std::size_t count;
        double mean() const { return sum / static_cast<double>(count); }
    };
    std::vector<Block> blocks;
    for (const double value : values) {
        blocks.push_back({value, 1});
        while (blocks.size() > 1 && blocks[blocks.size() - 2].mean() > blocks.back().mean()) {
            const Block last = blocks.back();
            blocks.pop_back();
            blocks.back().sum += last.sum;
            blocks.back().count += last.count;
        }
    }
    std::size_t at = 0;
    for (const Block& block : blocks) {
        for (std::size_t i = 0; i < block.count; ++i) values[at++] = block.mean();
    }
}

}  // namespace palpa::stiffnessmaps
