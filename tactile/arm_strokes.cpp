#include "tactile/arm_strokes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "files/text.h"
#include "platform/real_time.h"

namespace palpa::tactile {
namespace {

using devices::ArmCommand;
using devices::ArmFeedback;
using devices::ArmMode;

constexpr double kStrokeTick_s = 1e-3;
constexpr double kSilent_s = 0.5;  // what is left of the strokes tells no stiffness

class LinkRig : public ArmRig {
  public:
    explicit LinkRig(const devices::ArmDevice& device) : port_(devices::open_arm(device)), due_s_(devices::steady_s()) {
        platform::set_real_time(true);
    }
    ~LinkRig() override { platform::set_real_time(false); }

    // What cannot be caught up on is left out.
    double next_tick() override {
        due_s_ += kStrokeTick_s;
        const double now_s = devices::steady_s();
        if (now_s < due_s_)
            std::this_thread::sleep_for(std::chrono::duration<double>(due_s_ - now_s));
        else
            due_s_ = now_s;
        return devices::steady_s();
    }
    bool read(ArmFeedback& out) noexcept override { return port_->read(out); }
    void send(const ArmCommand& command) noexcept override { port_->send(command); }
    const devices::LinkHealth* link() const override { return &port_->health(); }

  private:
    std::unique_ptr<devices::ArmPort> port_;
    double due_s_;
};

class VirtualRig : public ArmRig {
  public:
    explicit VirtualRig(devices::simulators::ArmPlant plant) : plant_(std::move(plant)) {}

    double next_tick() override {
        devices::simulators::advance(kStrokeTick_s, plant_);
        return plant_.time_s;
    }
    bool read(ArmFeedback& out) noexcept override {
        if (said_) out = *said_;
        return said_.has_value();
    }
    void send(const ArmCommand& command) noexcept override {
        devices::simulators::command(command, plant_);
        said_ = devices::simulators::feedback(plant_);
        said_->age_s = kStrokeTick_s;
    }

  private:
    devices::simulators::ArmPlant plant_;
    std::optional<ArmFeedback> said_;
};

ArmCommand wanted(const StrokeOptions& options, const ArmFeedback& feedback, FrictionDirection& direction) {
    ArmCommand command;
    command.mode = static_cast<double>(ArmMode::force);
    if (feedback.depth_m > 0.0 && options.law) command.force_N = options.law(feedback.depth_m);
    if (options.compensation)
        command.feedforward_N =
            compensation_N(*options.compensation, feedback.depth_m, feedback.velocity_m_per_s, direction);
    return command;
}

// The arm rests until the sensor has its zero.
double await_sensor(const std::string& arm, ArmRig& rig, ArmFeedback& feedback) {
    constexpr int kMost = 2000;
    double now_s = 0.0;
    bool answers = false;
    for (int i = 0; i < kMost && feedback.has_sensor != 1.0; ++i) {
        now_s = rig.next_tick();
        answers = rig.read(feedback) || answers;
        rig.send(ArmCommand{});
    }
    if (!answers) throw std::runtime_error(arm + ": nothing answers within 2 s");
    if (feedback.has_sensor != 1.0) throw std::runtime_error(arm + ": its force sensor says nothing within 2 s");
    return now_s;
}

void add_leg(double depth_m, double speed_m_per_s, std::vector<devices::PressRow>& path) {
    const devices::PressRow& last = path.back();
    const double rest_s = 0.1;  // so that the next row is later even if the place is the same
    devices::PressRow row;
    row.depth_m = depth_m;
    row.t_s = last.t_s + std::max(std::abs(depth_m - last.depth_m) / speed_m_per_s, rest_s);
    path.push_back(row);
}

std::vector<devices::PressRow> path_from(double depth_m) {
    constexpr double kTakeHold_s = 0.5;
    devices::PressRow row;
    row.depth_m = depth_m;
    std::vector<devices::PressRow> path{row};
    row.t_s = kTakeHold_s;
    path.push_back(row);
    return path;
}

}  // namespace

std::unique_ptr<ArmRig> open_rig(const devices::ArmDevice& device) { return std::make_unique<LinkRig>(device); }

std::unique_ptr<ArmRig> virtual_rig(devices::simulators::ArmPlant plant) {
    return std::make_unique<VirtualRig>(std::move(plant));
}

Strokes run_strokes(const StrokeOptions& options, ArmRig& rig) {
    Strokes out;
    out.rows.reserve(static_cast<std::size_t>(options.seconds / kStrokeTick_s) + 16);
    ArmFeedback feedback;
    const double began_s = await_sensor(options.arm, rig, feedback);
    double last_s = began_s, told_s = began_s, heard_s = began_s, felt_s = began_s;
    double longest_silence_s = 0.0, sent_N = 0.0;
    devices::TimeHistogram delays;
    FrictionDirection direction;
    while (last_s - began_s < options.seconds) {
        const double now_s = rig.next_tick();
        constexpr double kLate_s = 1e-3;
        out.late_ticks += now_s - last_s > kStrokeTick_s + kLate_s;
        last_s = now_s;
        const bool fresh = rig.read(feedback);
        if (fresh) delays.add(feedback.age_s + feedback.round_trip_s);
        if (fresh) heard_s = now_s;
        const bool feels = feedback.has_sensor == 1.0;
        if (feels) felt_s = now_s;
        longest_silence_s = std::max(longest_silence_s, now_s - heard_s);
        devices::begin_tick(options.limits, now_s, fresh, &feedback, out.guard);
        ArmCommand command = wanted(options, feedback, direction);
        devices::guard_arm(options.limits, command, out.guard);
        rig.send(command);
        if (fresh && feels && out.rows.size() < out.rows.capacity())
            out.rows.push_back({now_s, feedback.depth_m, feedback.velocity_m_per_s, feedback.sensor_N, sent_N});
        sent_N = command.force_N + command.feedforward_N;
        if (now_s - felt_s > kSilent_s) {
            rig.send(ArmCommand{});
            throw std::runtime_error(options.arm + ": its force sensor fell silent in the middle of the strokes");
        }
        constexpr double kTell_s = 0.1;
        if (!options.progress || now_s - told_s < kTell_s) continue;
        options.progress(now_s - began_s);
        told_s = now_s;
    }
    rig.send(ArmCommand{});
    out.delay_s = delays.quantile_s(0.5);
    if (devices::latches(out.guard.fault))
        throw std::runtime_error("arm: stopped: " + std::string(devices::text(out.guard.fault)));
    if (longest_silence_s > kSilent_s)
        throw std::runtime_error("arm: nothing came from it for " + files::short_number(longest_silence_s) +
                                 " s in the middle of the strokes");
    return out;
}

std::vector<devices::PressRow> slow_strokes(double lowest_m, double deepest_m) {
    struct Pair {
        double speed_m_per_s, share;
    };
    const double range_m = deepest_m - lowest_m;
    std::vector<devices::PressRow> path = path_from(lowest_m);
    for (const Pair& pair :
         {Pair{24e-3, 1.0}, Pair{12e-3, 1.0}, Pair{6e-3, 0.5}, Pair{3e-3, 0.25}, Pair{1.5e-3, 0.1}}) {
        add_leg(lowest_m + pair.share * range_m, pair.speed_m_per_s, path);
        add_leg(lowest_m, pair.speed_m_per_s, path);
    }
    return path;
}

std::vector<devices::PressRow> cycles(double depth_m, int count, double cycle_s) {
    constexpr double kAbove_m = -2e-3;
    const double speed_m_per_s = 2.0 * depth_m / cycle_s;
    std::vector<devices::PressRow> path = path_from(kAbove_m);
    for (int i = 0; i < count; ++i) {
        add_leg(depth_m, speed_m_per_s, path);
        add_leg(kAbove_m, speed_m_per_s, path);
    }
    return path;
}

}  // namespace palpa::tactile
