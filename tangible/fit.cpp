#include "tangible/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "files/input_error.h"
#include "files/table.h"

namespace palpa::tangible {
namespace {

constexpr double kLeastContact_N = 1e-3;
constexpr int kFewestTicks = 20;
constexpr int kMostRounds = 12;
using Parameters = Eigen::Vector3d;  // ln of the modulus factor, friction share, zero in mm

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
std::vector<RecordedTick> used_ticks(const std::vector<RecordedTick>& ticks) {
    std::vector<RecordedTick> in_contact;
    for (const RecordedTick& tick : ticks) {
        if (tick.force_N > kLeastContact_N) in_contact.push_back(tick);
    }
    if (static_cast<int>(in_contact.size()) < kFewestTicks)
        throw std::runtime_error("the presses hold " + std::to_string(in_contact.size()) +
                                 " rows in contact, expected at least " + std::to_string(kFewestTicks));
    const std::size_t every = (in_contact.size() + kMostFitted - 1) / kMostFitted;
    std::vector<RecordedTick> out{ticks.front()};
    for (std::size_t i = 0; i < in_contact.size(); i += every) out.push_back(in_contact[i]);
    return out;
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

Eigen::MatrixXd slopes(const SoftDevice& device, const std::vector<RecordedTick>& ticks, const Senses& sense,
                       const Parameters& p, const Eigen::VectorXd& at_N) {
    const Parameters step(1e-3, 1e-3, 1e-2);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(at_N.size(), 3);
    for (int k = 0; k < 3; ++k) {
        Parameters there = p;
        there(k) += step(k);
        const Eigen::VectorXd there_N = forces_N(model_with(device, there), ticks, sense, there, nullptr);
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
    std::vector<double> before_m(length.size());
    std::vector<RecordedTick> out;
    while (table.next()) {
        RecordedTick tick;
        tick.time_s = table.finite_number(time);
        if (!out.empty() && tick.time_s <= out.back().time_s) table.fail(time, "a time after that of the row above");
        tick.depth_m = 1e-3 * table.finite_number(depth);
        tick.force_N = table.finite_number(force);
        for (std::size_t j = 0; j < actuator.size(); ++j) tick.actuation[j] = table.finite_number(actuator[j]);
        tick.has_sense = !length.empty();
        std::size_t cable = 0;
        for (std::size_t j = 0; tick.has_sense && j < actuator.size(); ++j) {
            if (model.actuators[j].kind != ActuatorKind::cable) continue;
            const double now_m = 1e-3 * table.finite_number(length[cable]);
            if (!out.empty())
                tick.sense[j] = friction_sense((before_m[cable] - now_m) / (tick.time_s - out.back().time_s));
            before_m[cable++] = now_m;
        }
        out.push_back(tick);
    }
    if (out.empty()) throw files::InputError(tsv.string() + ": found no rows, expected a press");
    return out;
}

FitResult fit_presses(const SoftDevice& device, const std::vector<RecordedTick>& all) {
    const std::vector<RecordedTick> ticks = used_ticks(all);
    FitResult out;
    out.ticks = static_cast<int>(ticks.size()) - 1;
    Parameters p = Parameters::Zero();
    const bool has_sense = std::all_of(ticks.begin(), ticks.end(), [](const RecordedTick& t) { return t.has_sense; });
    Senses sense = recorded_senses(ticks);
    for (out.rounds = 1; out.rounds <= kMostRounds; ++out.rounds) {
        const DeviceModel model = model_with(device, p);
        if (!has_sense) sense = modelled_senses(model, ticks, p, sense);
        const Eigen::VectorXd at_N = forces_N(model, ticks, sense, p, nullptr);
        const Misfit misfit = misfit_of(at_N, ticks);
        if (misfit.known < kFewestTicks)
            throw std::runtime_error("the device has an equilibrium at " + std::to_string(misfit.known) +
                                     " rows of the presses, expected at least " + std::to_string(kFewestTicks));
        if (out.rounds == 1) out.rms_before_N = misfit.rms_N;
        out.rms_after_N = misfit.rms_N;
        // a little of each parameter's own size keeps apart what the presses cannot tell apart
        const Eigen::MatrixXd J = slopes(device, ticks, sense, p, at_N);
        Eigen::Matrix3d A = J.transpose() * J;
        A.diagonal() *= 1.0 + 1e-6;
        A.diagonal().array() += 1e-12;
        Parameters step = -A.ldlt().solve(J.transpose() * misfit.off_N);
        if (!step.allFinite()) break;
        const Parameters most(0.3, 0.1, 0.5);
        step = step.cwiseMax(-most).cwiseMin(most);
        p += step;
        p(1) = std::clamp(p(1), 0.0, 0.5);
        if ((step.cwiseAbs().array() < Eigen::Array3d(1e-4, 1e-4, 1e-3)).all()) {
            out.settled = true;
            break;
        }
    }
    out.fit.modulus_factor = std::exp(p(0));
    out.fit.friction_share = p(1);
    out.fit.zero_m = 1e-3 * p(2);
    return out;
}

}  // namespace palpa::tangible
