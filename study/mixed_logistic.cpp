#include "study/mixed_logistic.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "study/small_matrix.h"

namespace palpa::study {
namespace {

// To an absolute error of 2e-16, which is all that a sum of many needs; log1p takes four times as long.
double log_one_plus_exp(double x) { return std::max(x, 0.0) + std::log(1.0 + std::exp(-std::abs(x))); }
double share_of_odds(double x) { return 1.0 / (1.0 + std::exp(-x)); }
std::size_t index(int i) { return static_cast<std::size_t>(i); }

// The system of one Newton step for (u, v):  [D_p  C; C'  D_n], with D_p and D_n diagonal. The people are eliminated first,
// which is cheap where there are as many of them as of nodules, or more (fit_mixed_logistic sees to that).
struct Crossed {
    std::vector<double> d_p, d_n;
    SmallMatrix c;  // people x nodules
};

struct Effects {
    std::vector<double> u, v;
};

struct Laplace {
    const MixedData* data;
    Effects at;  // where the last call ended: the next one begins there

    explicit Laplace(const MixedData& of) : data(&of) {
        at.u.assign(index(of.participants), 0.0);
        at.v.assign(index(of.nodules), 0.0);
    }
};

struct Parameters {
    const std::vector<double>& beta;
    double s_p, s_n;
};

double eta_of(const MixedCell& cell, const Parameters& p, const Effects& e) {
    return p.beta[index(cell.condition)] + p.s_p * e.u[index(cell.participant)] + p.s_n * e.v[index(cell.nodule)];
}

double square_sum(const std::vector<double>& x) { return std::inner_product(x.begin(), x.end(), x.begin(), 0.0); }

// What is maximised over u and v.
double joint(const MixedData& data, const Parameters& p, const Effects& e) {
    double sum = -0.5 * (square_sum(e.u) + square_sum(e.v));
    for (const MixedCell& cell : data.cells) {
        const double eta = eta_of(cell, p, e);
        sum += static_cast<double>(cell.found) * eta - static_cast<double>(cell.n) * log_one_plus_exp(eta);
    }
    return sum;
}

// Minus the Hessian of joint() in (u, v), and its gradient.
void system_at(const MixedData& data, const Parameters& p, const Effects& e, Crossed& h, Effects& gradient) {
    h.d_p.assign(e.u.size(), 1.0);
    h.d_n.assign(e.v.size(), 1.0);
    h.c = SmallMatrix(e.u.size(), e.v.size());
    for (std::size_t i = 0; i < e.u.size(); ++i) gradient.u[i] = -e.u[i];
    for (std::size_t i = 0; i < e.v.size(); ++i) gradient.v[i] = -e.v[i];
    for (const MixedCell& cell : data.cells) {
        const double share = share_of_odds(eta_of(cell, p, e));
        const auto n = static_cast<double>(cell.n);
        const double residual = static_cast<double>(cell.found) - n * share;
        const double w = n * share * (1.0 - share);
        const std::size_t i = index(cell.participant), k = index(cell.nodule);
        gradient.u[i] += p.s_p * residual;
        gradient.v[k] += p.s_n * residual;
        h.d_p[i] += p.s_p * p.s_p * w;
        h.d_n[k] += p.s_n * p.s_n * w;
        h.c(i, k) += p.s_p * p.s_n * w;
    }
}

// D_n - C' D_p^-1 C, factorised: with D_p it gives solutions and the determinant.
Cholesky eliminate_people(const Crossed& h) {
    SmallMatrix s(h.d_n.size(), h.d_n.size());
    for (std::size_t k = 0; k < h.d_n.size(); ++k) s(k, k) = h.d_n[k];
    for (std::size_t i = 0; i < h.d_p.size(); ++i) {
        for (std::size_t k = 0; k < h.d_n.size(); ++k) {
            const double factor = h.c(i, k) / h.d_p[i];
            if (factor == 0.0) continue;
            for (std::size_t l = 0; l <= k; ++l) s(k, l) -= factor * h.c(i, l);
        }
    }
    return Cholesky(s);
}

Effects solve_crossed(const Crossed& h, const Cholesky& s, const Effects& right) {
    Effects x{right.u, right.v};
    for (std::size_t i = 0; i < x.u.size(); ++i) {
        for (std::size_t k = 0; k < x.v.size(); ++k) x.v[k] -= h.c(i, k) * right.u[i] / h.d_p[i];
    }
    s.solve(x.v);
    for (std::size_t i = 0; i < x.u.size(); ++i) {
        for (std::size_t k = 0; k < x.v.size(); ++k) x.u[i] -= h.c(i, k) * x.v[k];
        x.u[i] /= h.d_p[i];
    }
    return x;
}

double log_determinant(const Crossed& h, const Cholesky& s) {
    double sum = s.log_determinant();
    for (const double d : h.d_p) sum += std::log(d);
    return sum;
}

// Newton's method with steps halved until they climb; joint() is concave, so this finds its maximum. Returns log L.
double log_likelihood_at(Laplace& laplace, const Parameters& p, Crossed& h) {
    constexpr int kMostSteps = 200;
    const MixedData& data = *laplace.data;
    Effects gradient = laplace.at, next = laplace.at;
    double here = joint(data, p, laplace.at);
    for (int step = 0; step < kMostSteps; ++step) {
        system_at(data, p, laplace.at, h, gradient);
        const Effects direction = solve_crossed(h, eliminate_people(h), gradient);
        double slope = 0.0;
        for (std::size_t i = 0; i < gradient.u.size(); ++i) slope += gradient.u[i] * direction.u[i];
        for (std::size_t i = 0; i < gradient.v.size(); ++i) slope += gradient.v[i] * direction.v[i];
        if (!(slope > 1e-20)) break;  // twice the climb that is left
        double length = 1.0, there = here;
        for (int halving = 0; halving < 40; ++halving, length *= 0.5) {
            for (std::size_t i = 0; i < next.u.size(); ++i) next.u[i] = laplace.at.u[i] + length * direction.u[i];
            for (std::size_t i = 0; i < next.v.size(); ++i) next.v[i] = laplace.at.v[i] + length * direction.v[i];
            there = joint(data, p, next);
            if (there >= here || slope < 1e-10) break;  // below that, rounding hides the climb
        }
        std::swap(laplace.at, next);
        here = there;
    }
    system_at(data, p, laplace.at, h, gradient);
    return here - 0.5 * log_determinant(h, eliminate_people(h));
}

// Which coordinates the search moves: one for each number in `same`, then the two spreads.
struct MixedSearch {
    Laplace laplace;
    std::vector<int> same;
    int shared = 0;  // different numbers in `same`
    bool prior = false;
    Crossed work;

    std::vector<double> beta(const std::vector<double>& x) const {
        std::vector<double> out;
        for (const int group : same) out.push_back(x[index(group)]);
        return out;
    }

    double value(const std::vector<double>& x) {
        const std::vector<double> b = beta(x);
        const double sum = log_likelihood_at(laplace, {b, x[x.size() - 2], x.back()}, work);
        return prior ? sum - 0.5 * square_sum(b) / (kPriorSpread * kPriorSpread) : sum;
    }
};

struct Derivatives {
    std::vector<double> gradient;
    SmallMatrix minus_hessian;
};

// Central differences. log L is smooth, also where a spread passes through 0, since it depends on its square.
Derivatives derivatives_at(MixedSearch& search, const std::vector<double>& x, double value) {
    constexpr double kStep = 1e-3;
    const std::size_t n = x.size();
    Derivatives out{std::vector<double>(n), SmallMatrix(n, n)};
    const auto moved = [&](std::size_t i, double di, std::size_t k, double dk) {
        std::vector<double> y = x;
        y[i] += di;
        y[k] += dk;
        return search.value(y);
    };
    for (std::size_t i = 0; i < n; ++i) {
        const double up = moved(i, kStep, i, 0.0), down = moved(i, -kStep, i, 0.0);
        const double far_up = moved(i, 2.0 * kStep, i, 0.0), far_down = moved(i, -2.0 * kStep, i, 0.0);
        out.gradient[i] = (8.0 * (up - down) - (far_up - far_down)) / (12.0 * kStep);
        out.minus_hessian(i, i) = -(16.0 * (up + down) - (far_up + far_down) - 30.0 * value) / (12.0 * kStep * kStep);
        for (std::size_t k = 0; k < i; ++k) {
            const double both = moved(i, kStep, k, kStep) + moved(i, -kStep, k, -kStep);
            const double mixed = moved(i, kStep, k, -kStep) + moved(i, -kStep, k, kStep);
            out.minus_hessian(i, k) = out.minus_hessian(k, i) = -(both - mixed) / (4.0 * kStep * kStep);
        }
    }
    return out;
}

// Newton's method with a ridge that grows until a step climbs (Levenberg, Marquardt). Returns whether it converged: a step
// of less than 1e-7 in every coordinate.
bool climb_to_maximum(MixedSearch& search, std::vector<double>& x, double& value, Derivatives& at) {
    constexpr int kMostSteps = 100;
    double ridge = 1e-3;
    value = search.value(x);
    for (int step = 0; step < kMostSteps; ++step) {
        at = derivatives_at(search, x, value);
        for (int tries = 0; tries < 60; ++tries) {
            SmallMatrix h = at.minus_hessian;
            for (std::size_t i = 0; i < x.size(); ++i) h(i, i) += ridge;
            const Cholesky factor(h);
            std::vector<double> move = at.gradient;
            double longest = 0.0;
            if (factor.positive()) factor.solve(move);
            for (const double m : move) longest = std::max(longest, std::abs(m));
            if (factor.positive() && longest < 1e-7) return true;
            if (factor.positive() && longest < 3.0) {
                std::vector<double> there = x;
                for (std::size_t i = 0; i < x.size(); ++i) there[i] += move[i];
                const double climbed = search.value(there);
                if (climbed >= value - 1e-12) {
                    x = there;
                    value = climbed;
                    ridge = std::max(0.1 * ridge, 1e-12);
                    break;
                }
            }
            ridge *= 10.0;
        }
    }
    return false;
}

std::string why_not_mixed(const MixedData& data) {
    const std::string cannot = "cannot be computed, because ";
    if (data.participants < 2) return cannot + "there are fewer than two participants";
    if (data.nodules < 2) return cannot + "there is one nodule only: the spread of nodules needs several";
    std::int64_t found = 0, n = 0;
    for (const MixedCell& cell : data.cells) {
        found += cell.found;
        n += cell.n;
    }
    if (found == 0 || found == n)
        return cannot + (found == 0 ? "nothing was found" : "everything was found") + " under any condition";
    return "";
}

// Shares of the conditions, kept off 0 and 1, as log odds: where the search begins.
std::vector<double> start_of(const MixedData& data, const std::vector<int>& same, int shared) {
    std::vector<double> found(index(shared), 0.5), n(index(shared), 1.0);
    for (const MixedCell& cell : data.cells) {
        found[index(same[index(cell.condition)])] += static_cast<double>(cell.found);
        n[index(same[index(cell.condition)])] += static_cast<double>(cell.n);
    }
    std::vector<double> x;
    for (std::size_t i = 0; i < found.size(); ++i) x.push_back(std::log(found[i] / (n[i] - found[i])));
    x.push_back(0.8);
    x.push_back(0.8);
    return x;
}

// Columns of (X'WX - X'WZL (LZ'WZL + I)^-1 LZ'WX), with the prior's share, inverted.
std::vector<std::vector<double>> covariance_given(MixedSearch& search, const MixedFit& fit) {
    const MixedData& data = *search.laplace.data;
    const std::size_t n = fit.beta.size();
    const Parameters p{fit.beta, fit.s_participants, fit.s_nodules};
    Effects gradient = search.laplace.at;
    system_at(data, p, search.laplace.at, search.work, gradient);
    const Cholesky factor = eliminate_people(search.work);
    std::vector<Effects> across(n, {std::vector<double>(gradient.u.size()), std::vector<double>(gradient.v.size())});
    SmallMatrix information(n, n);
    for (std::size_t c = 0; c < n && search.prior; ++c) information(c, c) = 1.0 / (kPriorSpread * kPriorSpread);
    for (const MixedCell& cell : data.cells) {
        const double share = share_of_odds(eta_of(cell, p, search.laplace.at));
        const double w = static_cast<double>(cell.n) * share * (1.0 - share);
        const std::size_t c = index(cell.condition);
        information(c, c) += w;
        across[c].u[index(cell.participant)] += p.s_p * w;
        across[c].v[index(cell.nodule)] += p.s_n * w;
    }
    for (std::size_t a = 0; a < n; ++a) {
        const Effects x = solve_crossed(search.work, factor, across[a]);
        for (std::size_t b = 0; b < n; ++b) {
            information(b, a) -= std::inner_product(x.u.begin(), x.u.end(), across[b].u.begin(), 0.0) +
                                 std::inner_product(x.v.begin(), x.v.end(), across[b].v.begin(), 0.0);
        }
    }
    return inverse(information);
}

// The same answers with people and nodules in each other's place.
MixedData swapped(const MixedData& data) {
    MixedData out{data.conditions, data.nodules, data.participants, data.cells};
    for (MixedCell& cell : out.cells) std::swap(cell.participant, cell.nodule);
    return out;
}

void swap_people_and_nodules(MixedFit& fit) {
    std::swap(fit.s_participants, fit.s_nodules);
    if (fit.covariance.empty()) return;
    const std::size_t n = fit.beta.size();
    std::swap(fit.covariance[n], fit.covariance[n + 1]);
    for (std::vector<double>& row : fit.covariance) std::swap(row[n], row[n + 1]);
}

}  // namespace

bool is_separated(const MixedData& data) {
    std::vector<std::int64_t> found(index(data.conditions), 0), n(index(data.conditions), 0);
    for (const MixedCell& cell : data.cells) {
        found[index(cell.condition)] += cell.found;
        n[index(cell.condition)] += cell.n;
    }
    for (std::size_t c = 0; c < n.size(); ++c) {
        if (found[c] == 0 || found[c] == n[c]) return true;
    }
    return false;
}

double mixed_log_likelihood(const MixedData& data, const std::vector<double>& beta, double s_participants,
                            double s_nodules) {
    Laplace laplace(data);
    Crossed work;
    return log_likelihood_at(laplace, {beta, s_participants, s_nodules}, work);
}

MixedFit fit_mixed_logistic(const MixedData& data, const std::vector<int>& same) {
    MixedFit fit;
    fit.status = why_not_mixed(data);
    if (!fit.status.empty()) return fit;
    if (data.nodules > data.participants) {
        fit = fit_mixed_logistic(swapped(data), same);
        swap_people_and_nodules(fit);
        return fit;
    }
    fit.prior = is_separated(data);
    MixedSearch search{Laplace(data), same, data.conditions, fit.prior, {}};
    if (same.empty()) {
        search.same.resize(index(data.conditions));
        std::iota(search.same.begin(), search.same.end(), 0);
    } else {
        assert(same.size() == index(data.conditions));
        search.shared = 1 + *std::max_element(same.begin(), same.end());
    }
    std::vector<double> x = start_of(data, search.same, search.shared);
    Derivatives at{{}, SmallMatrix(0, 0)};
    constexpr double kGreatestSpread = 20.0;  // of log odds: beyond, every nodule is found by all or by none
    const bool converged = climb_to_maximum(search, x, fit.log_likelihood, at);
    const double s_p = std::abs(x[x.size() - 2]), s_n = std::abs(x.back());
    if (!converged || !std::isfinite(fit.log_likelihood) || s_p > kGreatestSpread || s_n > kGreatestSpread) {
        fit.status = "cannot be computed, because the model does not converge";
        if (!(s_p < kGreatestSpread && s_n < kGreatestSpread))
            fit.status += ": some people or nodules differ without bound";
        return fit;
    }
    fit.beta = search.beta(x);
    fit.s_participants = s_p;
    fit.s_nodules = s_n;
    if (!same.empty()) return fit;
    fit.covariance_given_spreads = covariance_given(search, fit);
    // at a spread of 0 the curvature there tells nothing of beta's covariance with it
    if (std::min(s_p, s_n) > 1e-3 && Cholesky(at.minus_hessian).positive()) {
        fit.covariance = inverse(at.minus_hessian);
        const std::size_t n = fit.beta.size();
        for (std::size_t i = 0; i < n; ++i) {  // the search may have ended at -s
            for (std::size_t k = n; k < n + 2; ++k) {
                if (x[k] < 0.0) fit.covariance[i][k] = fit.covariance[k][i] = -fit.covariance[i][k];
            }
        }
        if (x[n] * x[n + 1] < 0.0) fit.covariance[n][n + 1] = fit.covariance[n + 1][n] = -fit.covariance[n][n + 1];
    }
    return fit;
}

double standard_error(const MixedFit& fit, int a, int b) {
    const auto& c = fit.covariance.empty() ? fit.covariance_given_spreads : fit.covariance;
    const std::size_t i = index(a);
    if (b < 0) return std::sqrt(c[i][i]);
    const std::size_t k = index(b);
    return std::sqrt(c[i][i] + c[k][k] - 2.0 * c[i][k]);
}

double averaged_share(double log_odds, double spread) {
    // the trapezoidal rule on a smooth integrand that vanishes at both ends: exact to 1e-12 at this step
    constexpr double kEnd = 9.0, kStep = 0.05;
    double sum = 0.0, weights = 0.0;
    for (double z = -kEnd; z <= kEnd + 0.5 * kStep; z += kStep) {
        const double weight = std::exp(-0.5 * z * z);
        sum += weight * share_of_odds(log_odds + spread * z);
        weights += weight;
    }
    return sum / weights;
}

AveragedShare averaged_share(const MixedFit& fit, int condition, double level) {
    const std::size_t n = fit.beta.size();
    const auto log_odds = [](double share) { return std::log(share / (1.0 - share)); };
    const auto value = [&](double beta, double s_p, double s_n) {
        return log_odds(averaged_share(beta, std::hypot(s_p, s_n)));
    };
    const double beta = fit.beta[index(condition)], s_p = fit.s_participants, s_n = fit.s_nodules;
    const double centre = value(beta, s_p, s_n);
    AveragedShare out{share_of_odds(centre), std::nullopt};
    if (fit.covariance.empty()) return out;
    constexpr double kStep = 1e-4;
    std::vector<double> slope(n + 2, 0.0);
    slope[index(condition)] = (value(beta + kStep, s_p, s_n) - value(beta - kStep, s_p, s_n)) / (2.0 * kStep);
    slope[n] = (value(beta, s_p + kStep, s_n) - value(beta, s_p - kStep, s_n)) / (2.0 * kStep);
    slope[n + 1] = (value(beta, s_p, s_n + kStep) - value(beta, s_p, s_n - kStep)) / (2.0 * kStep);
    double variance = 0.0;
    for (std::size_t i = 0; i < n + 2; ++i) {
        for (std::size_t k = 0; k < n + 2; ++k) variance += slope[i] * slope[k] * fit.covariance[i][k];
    }
    const double arm = z_of_level(level) * std::sqrt(variance);
    out.ci = Interval{share_of_odds(centre - arm), share_of_odds(centre + arm)};
    return out;
}

}  // namespace palpa::study
