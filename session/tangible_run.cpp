#include "session/tangible_run.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "files/input_error.h"
#include "files/progress_line.h"
#include "session/tangible_run_sink.h"

namespace palpa::session {

using tangible::Plant;
using tangible::TangibleCommand;
using tangible::TangiblePlan;

TangibleCommand TangibleLoop::command(const Plan& plan, const DeviceInput<Feedback>& in, State& state) noexcept {
    tangible::TangibleInput input;
    input.time_s = in.time_s;
    input.feedback = in.feedback;
    input.place_m = {in.pen.x_m, in.pen.y_m};
    input.has_place = in.pen.down > 0.5;
    return tangible::tangible_tick(*plan, input, state);
}

TangibleSink::TangibleSink(const TangiblePlan& plan, const std::filesystem::path& log,
                           const std::filesystem::path& rows) {
    if (!log.empty()) log_.emplace(log, *plan.model, plan.loop.command);
    if (!rows.empty()) rows_.emplace(rows, field_names<tangible::TangibleFeedback>());
}

void TangibleSink::take(const TickRecord& record) {
    add(record.command, record.rendered_N, result.ticks);
    if (record.tick_ns > 0.0) tick.add_ns(record.tick_ns);
    if (record.period_ns > 0.0) period.add_ns(record.period_ns);
    if (log_) log_->write(record.command, record.rendered_N);
}

void TangibleSink::take_rows(RowRing& recorded) {
    if (rows_) return write_recorded(recorded, *rows_);
    for (DeviceRow row; recorded.take(row);) {
    }
}

void TangibleSink::finish(const DeviceReport& loop) {
    result.loop = loop;
    result.clock.missed_ticks = loop.missed_periods;
    if (tick.timed() > 0) {
        result.clock.tick_p50_us = 1e-3 * tick.quantile_ns(0.5);
        result.clock.tick_p99_us = 1e-3 * tick.quantile_ns(0.99);
    }
    if (period.timed() > 0) {
        result.clock.period_p50_us = 1e-3 * period.quantile_ns(0.5);
        result.clock.period_p99_us = 1e-3 * period.quantile_ns(0.99);
        result.clock.period_worst_us = 1e-3 * period.worst_ns();
    }
    if (log_) result.logged = log_->sync();
    if (rows_) result.logged = rows_->sync() && result.logged;
    result.logged = result.logged && loop.lost_rows == 0 && lost_ticks == 0;
}

double seconds_of(const Finger& finger) {
    if (finger.seconds > 0.0) return finger.seconds;
    if (!finger.press.empty()) return finger.press.back().t_s - finger.press.front().t_s;
    return press_time_s(finger.motion);
}

devices::PressRow finger_at(const Finger& finger, double time_s, std::size_t& at) noexcept {
    if (!finger.press.empty()) return devices::press_at(finger.press, finger.press.front().t_s + time_s, at);
    devices::PressRow row;
    row.t_s = time_s;
    row.depth_m = press_depth_m(finger.motion, std::fmod(time_s, press_time_s(finger.motion)));
    return row;
}

PlantPort::PlantPort(const TangiblePlan& plan, const Plant& the_plant, Finger the_finger, std::uint64_t seed)
    : plant(the_plant), state(make_plant_state(the_plant, plan, seed)), finger(std::move(the_finger)) {
    by_force = !finger.press.empty() && std::isfinite(finger.press.front().force_N);
}

tangible::TangibleFeedback PlantPort::read(double time_s) noexcept {
    if (!by_force && !pen_pushes)
        place_finger(time_s, finger_at(finger, time_s, at).depth_m, state);
    else if (state.steps == 0)
        place_finger(time_s, 0.0, state);
    return read_plant_sensor(plant, time_s, state);
}

void PlantPort::send(double time_s, const TangibleCommand& command) noexcept {
    if (!by_force && !pen_pushes) {
        answer = step_plant(plant, command, state);
        return;
    }
    const double hand_N = pen_pushes ? pen_N : finger_at(finger, time_s, at).force_N;
    answer = plant.options.hand.mass_kg > 0.0 ? push_plant(plant, command, time_s, hand_N, state)
                                              : yield_to_hand(plant, command, time_s, hand_N, state);
}

std::unique_ptr<DeviceLoop<TangibleLoop>> make_tangible_loop(std::shared_ptr<const TangiblePlan> plan) {
    auto loop = std::make_unique<DeviceLoop<TangibleLoop>>();
    loop->memory.state = make_tangible_state(*plan);
    loop->plan = std::move(plan);
    return loop;
}

bool tangible_step(double time_s, const PenContact* touch, const tangible::TangibleFeedback& feedback,
                   DeviceLoop<TangibleLoop>& loop, TangibleCommand& command) noexcept {
    if (touch != nullptr) {
        if (all_finite(*touch)) {
            take_row<TangibleLoop>(device_row(DeviceRowKind::hand_over, time_s, *touch), loop, command);
            ++loop.report.hand_overs;
        } else {
            ++loop.report.not_numbers;
        }
    }
    if (!all_finite(feedback)) {
        ++loop.report.not_numbers;
        return false;
    }
    ++loop.report.rows;
    if (take_row<TangibleLoop>(device_row(DeviceRowKind::feedback, time_s, feedback), loop, command)) return true;
    ++loop.report.refused_commands;
    return false;
}

namespace {

PenContact place_of(const devices::PressRow& row) {
    PenContact contact;
    contact.time_s = row.t_s;
    contact.x_m = row.x_m;
    contact.y_m = row.y_m;
    contact.down = 1.0;
    return contact;
}

// Calls each(record) after every tick of a finger on a plant, in virtual time, until it returns false.
template <class Each>
void run_virtual_ticks(PlantPort& port, DeviceLoop<TangibleLoop>& loop, const Each& each) {
    const double period_s = 1.0 / loop.plan->loop.rate_Hz;
    const auto ticks = static_cast<std::int64_t>(std::floor(seconds_of(port.finger) / period_s + 1e-9)) + 1;
    TickRecord record;
    std::size_t at = 0;
    for (std::int64_t k = 0; k < ticks; ++k) {
        const double time_s = period_s * static_cast<double>(k);
        PenContact contact;
        const bool touches = loop.plan->place_follows && !port.finger.press.empty();
        if (touches) contact = place_of(finger_at(port.finger, time_s, at));
        const tangible::TangibleFeedback feedback = port.read(time_s);
        if (!tangible_step(time_s, touches ? &contact : nullptr, feedback, loop, record.command)) continue;
        port.send(time_s, record.command);
        record.rendered_N = port.rendered_N();
        record.sensor_m = feedback.sensor_m;
        if (!each(record)) return;
    }
}

}  // namespace

TangibleResult run_tangible_virtual(std::shared_ptr<const TangiblePlan> plan, const Plant& plant,
                                    const TangibleRunOptions& options) {
    PlantPort port(*plan, plant, options.finger, options.seed);
    auto loop = make_tangible_loop(plan);
    const std::filesystem::path rows =
        options.log.empty() ? options.log : device_rows_of(options.log / "press.tsv", "tangible");
    TangibleSink sink(*plan, options.log, rows);
    files::ProgressLine line;
    const double seconds = seconds_of(port.finger);
    run_virtual_ticks(port, *loop, [&](const TickRecord& record) {
        sink.take(record);
        sink.take_rows(loop->recorded);
        line.show("pressing", record.command.time_s / seconds);
        sink.result.cut = options.ends && options.ends();
        return !sink.result.cut;
    });
    sink.take_rows(loop->recorded);
    sink.finish(loop->report);
    return std::move(sink.result);
}

TangibleResult replay_tangible_rows(std::shared_ptr<const TangiblePlan> plan, const std::vector<DeviceRow>& rows,
                                    const TangibleRunOptions& options) {
    DeviceMemory<TangibleLoop> memory;
    memory.state = make_tangible_state(*plan);
    TangibleSink sink(*plan, options.log, {});
    TickRecord record;
    replay_device<TangibleLoop>(plan, rows, memory, [&](const TangibleCommand& command, double) {
        record.command = command;
        sink.take(record);
    });
    sink.finish({});
    return std::move(sink.result);
}

TangibleRecord press_tangible(const scene::Scene& scene, const scene::Plan& scene_plan,
                              std::span<const devices::PressRow> press, std::uint64_t seed) {
    auto plan = std::make_shared<const TangiblePlan>(tangible::make_tangible_plan(scene, scene_plan));
    const std::string& name = scene.tangible->plant;
    const Plant plant = make_plant(plan->model, tangible::read_plant(name.empty() ? "exact" : name), plan->loop);
    TangibleRecord out;
    if (press.empty()) return out;
    PlantPort port(*plan, plant, {{press.begin(), press.end()}, {}, 0.0}, seed);
    auto loop = make_tangible_loop(plan);
    run_virtual_ticks(port, *loop, [&](const TickRecord& record) {
        out.time_s.push_back(press.front().t_s + record.command.time_s);
        out.force_N.push_back(record.rendered_N);
        out.depth_m.push_back(port.state.depth_m);
        for (DeviceRow row; loop->recorded.take(row);) {
        }
        return !record.command.relaxed;  // the device gave way: whoever pressed it lifts the finger
    });
    return out;
}

std::vector<TactileDevice> devices_of(const TangiblePlan& plan, bool simulated) {
    std::vector<TactileDevice> out;
    const tangible::SoftDevice& device = plan.model->device;
    out.push_back({"soft device", device.name, "", simulated});
    if (!device.wires) return out;
    for (const devices::RigPort& port : device.wires->ports)
        out.push_back({port.name, device.name, simulated ? "" : port.path, simulated});
    for (const devices::RigSensor& sensor : device.wires->sensor) {
        const devices::CountsPlace& at = sensor.place;
        const std::string port = at.host.empty() ? at.path : "udp:" + at.host + ":" + std::to_string(at.port);
        out.push_back({"sensor", device.name, simulated ? "" : port, simulated});
    }
    return out;
}

std::vector<std::string> missing_tangible_ports(const scene::TangibleOptions& options) {
    std::vector<std::string> missing;
    if (!options.plant.empty()) return missing;
    try {
        const tangible::SoftDevice device = tangible::read_soft_device(options.device);
        if (!device.wires)
            missing.push_back(
                files::bad_input(device.file, "wires", "none", "the ports and drives of the device").what());
        if (!device.wires) return missing;
        for (const devices::RigPort& port : device.wires->ports) {
            std::error_code error;
            if (!std::filesystem::exists(port.path, error))
                missing.push_back(
                    files::bad_input(device.file, "wires.ports." + port.name, port.path, "a port that is there")
                        .what());
        }
    } catch (const std::exception& error) {
        missing.emplace_back(error.what());
    }
    return missing;
}

}  // namespace palpa::session
