#include "tangible/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::tangible {
namespace {

constexpr double kLeastContact_N = 1e-3;
constexpr double kMostForce_N = 1e3;
constexpr int kFewestTicks = 20;
constexpr double kLeastTravel_m = 1e-4;  // in contact: a depth that stays tells no stiffness
constexpr int kMostRounds = 24;
constexpr int kMostHalved = 3;  // a step that makes the misfit larger, before it is taken all the same
// ln of the modulus factor, friction share, zero in mm, and the share of a step that a lagging drive still lacks after the time
// between two rows: the forces are straight lines over it near 0, unlike over the lag itself
using Parameters = Eigen::Vector4d;
constexpr double kMostLeft = 0.98;
constexpr double kLeastLeft = 0.02;  // less than this is taken for no lag

bool is_good(DeviceStatus status) { return status == DeviceStatus::good || status == DeviceStatus::unstable; }

DeviceModel model_with(const SoftDevice& device, const Parameters& p) {
    SoftDevice changed = device;
    changed.fit = {};
    changed.fit.modulus_factor = std::exp(p(0));
    return make_device_model(changed);
}

// At rest under the first tick's actuation, from whose height depths count.
DeviceState rest_under(const DeviceModel& model, const Actuation& actuation) {
    DeviceState state = rest_state(model);
    DeviceLoad load;
    load.actuation = actuation;
    const ForwardAnswer rest = equilibrium(model, state, load);
    if (!is_good(rest.status))
        throw std::runtime_error("the device has no equilibrium at the first row of the presses");
    state.rest_depth_m += rest.depth_m;
    return state;
}

// What the drives give, which are told the recorded actuations and lengths, and the sense of friction in that.
std::vector<RecordedTick> behind(std::vector<RecordedTick> ticks, double left, double between_s) {
    for (std::size_t i = 1; i < ticks.size(); ++i) {
        const RecordedTick& before = ticks[i - 1];
        RecordedTick& tick = ticks[i];
        const double apart_s = tick.time_s - before.time_s;
        const double lacks = left > 0.0 ? std::pow(left, apart_s / between_s) : 0.0;
        for (std::size_t j = 0; j < kMostActuators; ++j) {
            tick.actuation[j] += lacks * (before.actuation[j] - tick.actuation[j]);
            tick.length[j] += lacks * (before.length[j] - tick.length[j]);
            tick.sense[j] = friction_sense((before.length[j] - tick.length[j]) / apart_s);
        }
    }
    return ticks;
}

// Half of the rows are further apart in time than this.
double between_rows_s(const std::vector<RecordedTick>& ticks) {
    std::vector<double> apart_s;
    for (std::size_t i = 1; i < ticks.size(); ++i) apart_s.push_back(ticks[i].time_s - ticks[i - 1].time_s);
    const auto middle = apart_s.begin() + static_cast<std::ptrdiff_t>(apart_s.size() / 2);
    std::nth_element(apart_s.begin(), middle, apart_s.end());
    return *middle;
}

// Friction's sense of each cable at each tick.
using Senses = std::vector<std::array<double, kMostActuators>>;

// Forces of the model under the recorded actuations, NaN where it has no equilibrium; `length` receives the lengths.
Eigen::VectorXd forces_N(const DeviceModel& model, const std::vector<RecordedTick>& ticks, const Senses& sense,
                         const Parameters& p, std::vector<Lengths>* length) {
    DeviceState state = rest_under(model, ticks.front().actuation);
    Eigen::VectorXd out(static_cast<Eigen::Index>(ticks.size()));
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        Actuation actuation = ticks[i].actuation;
        for (std::size_t j = 0; j < model.actuators.size(); ++j) {
            if (model.actuators[j].kind == ActuatorKind::cable) actuation[j] *= 1.0 - p(1) * sense[i][j];
        }
        const ForwardAnswer answer = press_to_depth(model, state, actuation, ticks[i].depth_m - 1e-3 * p(2));
        out(static_cast<Eigen::Index>(i)) = is_good(answer.status) ? answer.force_N : std::nan("");
        if (length != nullptr) (*length)[i] = answer.length;
    }
    return out;
}

Senses recorded_senses(const std::vector<RecordedTick>& ticks) {
    Senses out;
    for (const RecordedTick& tick : ticks) out.push_back(tick.sense);
    return out;
}

Senses modelled_senses(const DeviceModel& model, const std::vector<RecordedTick>& ticks, const Parameters& p,
                       const Senses& before) {
    std::vector<Lengths> length(ticks.size());
    forces_N(model, ticks, before, p, &length);
    Senses out(ticks.size());
    for (std::size_t i = 1; i + 1 < ticks.size(); ++i) {
        const double dt_s = ticks[i + 1].time_s - ticks[i - 1].time_s;
        for (std::size_t j = 0; j < model.actuators.size(); ++j)
            out[i][j] = friction_sense((length[i - 1][j] - length[i + 1][j]) / dt_s);
    }
    return out;
}

// Ticks in contact, thinned out evenly.
std::vector<RecordedTick> used_ticks(const std::vector<RecordedTick>& ticks, std::size_t most) {
    std::vector<RecordedTick> in_contact;
    for (const RecordedTick& tick : ticks) {
        if (tick.force_N > kLeastContact_N) in_contact.push_back(tick);
    }
    if (static_cast<int>(in_contact.size()) < kFewestTicks)
        throw std::runtime_error("the presses hold " + std::to_string(in_contact.size()) +
                                 " rows in contact, expected at least " + std::to_string(kFewestTicks));
    const auto [least, deepest] =
        std::minmax_element(in_contact.begin(), in_contact.end(),
                            [](const RecordedTick& a, const RecordedTick& b) { return a.depth_m < b.depth_m; });
    if (deepest->depth_m - least->depth_m < kLeastTravel_m)
        throw std::runtime_error("the presses stay between " + files::short_number(1e3 * least->depth_m) + " and " +
                                 files::short_number(1e3 * deepest->depth_m) +
                                 " mm deep, expected presses that go in and out by " +
                                 files::short_number(1e3 * kLeastTravel_m) + " mm at least");
    if (deepest->depth_m < 0.5 * kLeastTravel_m)
        throw std::runtime_error("the presses are between " + files::short_number(1e3 * least->depth_m) + " and " +
                                 files::short_number(1e3 * deepest->depth_m) +
                                 " mm deep, expected depths into the device, which are positive");
    const std::size_t every = (in_contact.size() + most - 1) / most;
    std::vector<RecordedTick> out{ticks.front()};
    for (std::size_t i = 0; i < in_contact.size(); i += every) out.push_back(in_contact[i]);
    return out;
}

// What was recorded, and how it is used.
struct Presses {
    const std::vector<RecordedTick>& all;
    std::size_t most;
    bool lag;
    double between_s;
};

std::vector<RecordedTick> used_ticks(const Presses& presses, double left) {
    return used_ticks(behind(presses.all, left, presses.between_s), presses.most);
}

struct Misfit {
    Eigen::VectorXd off_N;  // 0 where the model has no equilibrium
    int known = 0;
    double rms_N = 0.0;
};

Misfit misfit_of(const Eigen::VectorXd& model_N, const std::vector<RecordedTick>& ticks) {
    Misfit out;
    out.off_N.setZero(model_N.size());
    for (Eigen::Index i = 1; i < model_N.size(); ++i) {  // the first row sets the rest
        if (!std::isfinite(model_N(i))) continue;
        out.off_N(i) = model_N(i) - ticks[static_cast<std::size_t>(i)].force_N;
        ++out.known;
    }
    out.rms_N = out.known > 0 ? out.off_N.norm() / std::sqrt(static_cast<double>(out.known)) : 0.0;
    return out;
}

// `sense` is that of the model, or null where it is recorded.
Eigen::MatrixXd slopes(const SoftDevice& device, const Presses& presses, const Senses* sense, const Parameters& p,
                       const Eigen::VectorXd& at_N) {
    const Parameters step(2e-2, 2e-3, 2e-2, 4e-2);  // large against the 5e-6 N by which equilibria scatter
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(at_N.size(), p.size());
    for (Eigen::Index k = 0; k < (presses.lag ? 4 : 3); ++k) {
        Parameters there = p;
        there(k) += step(k);
        const std::vector<RecordedTick> ticks = used_ticks(presses, there(3));
        const Eigen::VectorXd there_N = forces_N(model_with(device, there), ticks,
                                                 sense != nullptr ? *sense : recorded_senses(ticks), there, nullptr);
        for (Eigen::Index i = 1; i < at_N.size(); ++i) {
            const double slope = (there_N(i) - at_N(i)) / step(k);
            if (std::isfinite(slope)) out(i, k) = slope;
        }
    }
    return out;
}

}  // namespace

std::vector<RecordedTick> read_presses(const std::filesystem::path& tsv, const DeviceModel& model) {
    files::Table table = files::read_tsv(tsv);
    const std::size_t time = table.column("time_s");
    const std::size_t depth = table.column("depth_mm");
    const std::size_t force = table.column("force_N");
    std::vector<std::size_t> actuator, length;
    for (const SoftActuator& a : model.actuators) actuator.push_back(table.column(a.name + "_" + unit_of(a.kind)));
    const bool has_lengths = std::all_of(model.actuators.begin(), model.actuators.end(), [&](const SoftActuator& a) {
        return a.kind != ActuatorKind::cable || table.has_column(a.name + "_mm");
    });
    for (const SoftActuator& a : model.actuators) {
        if (has_lengths && a.kind == ActuatorKind::cable) length.push_back(table.column(a.name + "_mm"));
    }
    const std::size_t by_length = table.has_column("by_length") ? table.column("by_length") : 0;
    std::vector<RecordedTick> out;
    while (table.next()) {
        if (by_length > 0 && table.field(by_length) != "0")
            table.fail(by_length,
                       "0: drives that were told tensions (--command force), since those of a cable that is held at "
                       "a length follow from the modulus that is to be found");
        RecordedTick tick;
        tick.time_s = table.finite_number(time);
        if (!out.empty() && tick.time_s <= out.back().time_s) table.fail(time, "a time after that of the row above");
        tick.depth_m = 1e-3 * table.finite_number(depth);
        if (tick.depth_m > model.size_m)
            table.fail(depth, "at most the device's size, " + files::short_number(1e3 * model.size_m) + " mm");
        tick.force_N = table.finite_number(force);
        if (std::abs(tick.force_N) > kMostForce_N)
            table.fail(force, "a force of a finger, at most " + files::short_number(kMostForce_N) + " N");
        for (std::size_t j = 0; j < actuator.size(); ++j) tick.actuation[j] = table.finite_number(actuator[j]);
        tick.has_lengths = !length.empty();
        std::size_t cable = 0;
        for (std::size_t j = 0; tick.has_lengths && j < actuator.size(); ++j) {
            if (model.actuators[j].kind == ActuatorKind::cable)
                tick.length[j] = 1e-3 * table.finite_number(length[cable++]);
        }
        out.push_back(tick);
    }
    if (out.empty()) throw files::InputError(tsv.string() + ": found no rows, expected a press");
    return out;
}

FitResult fit_presses(const SoftDevice& device, const std::vector<RecordedTick>& all, const FitOptions& options) {
    std::vector<RecordedTick> ticks = used_ticks(all, options.most);
    const Presses presses{all, options.most, options.lag, between_rows_s(all)};
    double left_error = 0.0;
    FitResult out;
    out.ticks = static_cast<int>(ticks.size()) - 1;
    Parameters p = Parameters::Zero();
    const double known_lag_s = device.fit.lag_s;  // stays as it is where none is fitted
    if (!options.lag && known_lag_s > 0.0) p(3) = std::exp(-presses.between_s / known_lag_s);
    const bool recorded = std::all_of(ticks.begin(), ticks.end(), [](const RecordedTick& t) { return t.has_lengths; });
    Senses sense = recorded_senses(ticks);  // none, where no lengths are recorded
    Parameters best = p;                    // where the last step began
    double best_rms_N = HUGE_VAL;
    int halved = 0;
    for (out.rounds = 1; out.rounds <= kMostRounds; ++out.rounds) {
        if (options.progress) options.progress(static_cast<double>(out.rounds - 1) / kMostRounds);
        const DeviceModel model = model_with(device, p);
        ticks = used_ticks(presses, p(3));
        sense = recorded ? recorded_senses(ticks) : modelled_senses(model, ticks, p, sense);
        const Eigen::VectorXd at_N = forces_N(model, ticks, sense, p, nullptr);
        const Misfit misfit = misfit_of(at_N, ticks);
        if (misfit.known < kFewestTicks)
            throw std::runtime_error("the device has an equilibrium at " + std::to_string(misfit.known) +
                                     " rows of the presses, expected at least " + std::to_string(kFewestTicks));
        if (out.rounds == 1) out.rms_before_N = misfit.rms_N;
        if (misfit.rms_N > best_rms_N && halved < kMostHalved) {
            p = 0.5 * (p + best);
            ++halved;
            continue;
        }
        best = p;
        best_rms_N = misfit.rms_N;
        halved = 0;
        out.rms_after_N = misfit.rms_N;
        // a little of each parameter's own size keeps apart what the presses cannot tell apart
        const Eigen::MatrixXd J = slopes(device, presses, recorded ? nullptr : &sense, p, at_N);
        Eigen::Matrix4d A = J.transpose() * J;
        A.diagonal() *= 1.0 + 1e-6;
        A.diagonal().array() += 1e-12;
        const Eigen::LDLT<Eigen::Matrix4d> solver(A);
        const Parameters step = -solver.solve(J.transpose() * misfit.off_N);
        left_error = misfit.rms_N * std::sqrt(std::max(0.0, solver.solve(Eigen::Vector4d::Unit(3))(3)));
        if (!step.allFinite()) break;
        const Parameters longest(0.3, 0.1, 0.5, 0.3);
        const Parameters before = p;
        p += step.cwiseMax(-longest).cwiseMin(longest);
        p(1) = std::clamp(p(1), 0.0, 0.5);
        p(3) = options.lag ? std::clamp(p(3), 0.0, kMostLeft) : before(3);
        if (((p - before).cwiseAbs().array() < Eigen::Array4d(1e-4, 1e-4, 1e-3, 1e-3)).all()) {
            out.settled = true;
            break;
        }
    }
    out.fit.modulus_factor = std::exp(p(0));
    out.fit.friction_share = p(1);
    out.fit.zero_m = 1e-3 * p(2);
    if (!options.lag) out.fit.lag_s = known_lag_s;
    if (options.lag && p(3) > std::max(kLeastLeft, 3.0 * left_error)) {
        const double ln = std::log(p(3));
        out.fit.lag_s = -presses.between_s / ln;
        out.lag_error_s = presses.between_s * left_error / (p(3) * ln * ln);
    }
    return out;
}

}  // namespace palpa::tangible
