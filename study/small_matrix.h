#pragma once
// Dense matrices of a few rows, for fits of a study's results.

#include <cmath>
#include <cstddef>
#include <vector>

namespace palpa::study {

struct SmallMatrix {
    SmallMatrix() = default;
    SmallMatrix(std::size_t rows, std::size_t columns) : columns_(columns), values_(rows * columns, 0.0) {}
    double& operator()(std::size_t i, std::size_t k) { return values_[i * columns_ + k]; }
    double operator()(std::size_t i, std::size_t k) const { return values_[i * columns_ + k]; }
    std::size_t columns() const { return columns_; }

  private:
    std::size_t columns_ = 0;
    std::vector<double> values_;  // row by row
};

// The factor L of A = L L' for a symmetric A, of which the lower half is read. If A is not positive definite, positive() is
// false and nothing else may be called.
class Cholesky {
  public:
    explicit Cholesky(const SmallMatrix& a) : l_(a) {
        const std::size_t n = a.columns();
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k <= i; ++k) {
                double sum = a(i, k);
                for (std::size_t m = 0; m < k; ++m) sum -= l_(i, m) * l_(k, m);
                if (k < i) {
                    l_(i, k) = sum / l_(k, k);
                } else {
                    positive_ = sum > 0.0 && std::isfinite(sum);
                    if (!positive_) return;
                    l_(i, i) = std::sqrt(sum);
                }
            }
        }
    }

    bool positive() const { return positive_; }

    // Replaces the right side by the solution.
    void solve(std::vector<double>& x) const {
        const std::size_t n = l_.columns();
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < i; ++k) x[i] -= l_(i, k) * x[k];
            x[i] /= l_(i, i);
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t k = i + 1; k < n; ++k) x[i] -= l_(k, i) * x[k];
            x[i] /= l_(i, i);
        }
    }

    double log_determinant() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < l_.columns(); ++i) sum += 2.0 * std::log(l_(i, i));
        return sum;
    }

  private:
    SmallMatrix l_;
    bool positive_ = true;
};

// The inverse of a positive definite matrix, by columns; empty if it is not one.
inline std::vector<std::vector<double>> inverse(const SmallMatrix& a) {
    const Cholesky factor(a);
    std::vector<std::vector<double>> out;
    if (!factor.positive()) return out;
    for (std::size_t i = 0; i < a.columns(); ++i) {
        out.emplace_back(a.columns(), 0.0);
        out.back()[i] = 1.0;
        factor.solve(out.back());
    }
    return out;
}

}  // namespace palpa::study
