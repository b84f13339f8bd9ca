#include "session/tactile_run.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "files/input_error.h"
#include "files/text.h"
#include "scene/tissue.h"
#include "session/tactile_run_sink.h"

namespace palpa::session {

using tactile::LoopCommand;

LoopCommand TactileLoop::command(const Plan& plan, const DeviceInput<Feedback>& in, State& state) noexcept {
    const PenContact& pen = in.pen;
    return tactile::loop_command(
        *plan, {in.time_s, in.feedback, {pen.time_s, pen.x_m, pen.y_m, pen.depth_m, pen.normal_N, pen.down > 0.5}},
        state);
}

PenContact contact_of(const devices::PressRow& row) noexcept {
    PenContact contact;
    contact.time_s = row.t_s;
    contact.x_m = row.x_m;
    contact.y_m = row.y_m;
    if (std::isfinite(row.depth_m)) contact.depth_m = row.depth_m;
    if (std::isfinite(row.force_N)) contact.normal_N = row.force_N;
    contact.down = contact.depth_m > 0.0 || contact.normal_N > 0.0 ? 1.0 : 0.0;
    return contact;
}

void choose_input(std::span<const devices::PressRow> press, tactile::TactilePlan& plan) {
    if (plan.options.leads == scene::Leads::arm || press.empty()) return;
    plan.input = std::isfinite(press.front().force_N) ? tactile::InputKind::force : tactile::InputKind::depth;
}

void choose_input(std::span<const DeviceRow> rows, tactile::TactilePlan& plan) {
    if (plan.options.leads == scene::Leads::arm) return;
    const bool by_force = std::any_of(rows.begin(), rows.end(), [](const DeviceRow& row) {
        PenContact pen;
        if (row.kind == DeviceRowKind::hand_over) read_device_row(row, pen);
        return pen.normal_N > 0.0;
    });
    plan.input = by_force ? tactile::InputKind::force : tactile::InputKind::depth;
}

const char* fault_words(devices::Fault fault, const Silent& silent) {
    if (fault == devices::Fault::none) return "";
    if (fault != devices::Fault::silence) return devices::text(fault).data();
    if (silent.arm) return silent.pins ? "nothing comes from the arm, nor from the pins" : "nothing comes from the arm";
    if (silent.sensor)
        return silent.pins ? "nothing comes from the force sensor, nor from the pins"
                           : "nothing comes from the force sensor";
    return silent.pins ? "nothing comes from the pins" : devices::text(fault).data();
}

std::int64_t steps_of(std::span<const devices::PressRow> press) {
    if (press.empty()) return 0;
    return 1 + static_cast<std::int64_t>(std::floor((press.back().t_s - press.front().t_s) / tactile::kStep_s + 1e-9));
}

TactileSink::TactileSink(const tactile::TactilePlan& plan, const std::filesystem::path& log,
                         const std::filesystem::path& rows) {
    if (!log.empty()) {
        log_.emplace(log, plan);
        faults_.emplace(log / "faults.tsv");
        faults_->append("time_s\tfault\n");
    }
    if (!rows.empty()) rows_.emplace(rows, field_names<tactile::LoopFeedback>());
}

void TactileSink::take(const StepRecord& record, std::span<const double> reached_m) {
    const LoopCommand& command = record.command;
    const bool rendered = record.fault == devices::Fault::none;
    count_waiting(rendered);
    const std::span<const double> estimate(command.reached_m.data(), static_cast<std::size_t>(command.pins));
    const std::span<const double> reached = reached_m.empty() ? estimate : reached_m;
    waiting_ = Waiting{command, {reached.begin(), reached.end()}};
    if (!rendered) count_waiting(false);
    if (record.step_ns > 0) step.add_ns(record.step_ns);
    if (log_) log_->write(command);
    if (faults_ && record.fault != fault_) log_fault(record);
}

// Into the file at once: it is what tells which rows of the other files were not rendered.
void TactileSink::log_fault(const StepRecord& record) {
    fault_ = record.fault;
    const bool named = fault_ != devices::Fault::none && *record.fault_words != '\0';
    const std::string_view what = named ? record.fault_words : devices::text(fault_);
    faults_->append(files::number_text(record.command.time_s) + '\t' + std::string(what) + '\n');
    faults_->flush();
}

void TactileSink::count_waiting(bool rendered) {
    if (!waiting_) return;
    const LoopCommand& command = waiting_->command;
    add(command, rendered, result.steps);
    const std::span<const double> wanted(command.wanted_m.data(), static_cast<std::size_t>(command.pins));
    if (rendered) add(wanted, waiting_->reached_m, command.pressed, result.mismatch);
    waiting_.reset();
}

void TactileSink::take_rows(RowRing& recorded) {
    if (rows_) return write_recorded(recorded, *rows_);
    for (DeviceRow row; recorded.take(row);) {
    }
}

void TactileSink::finish(const DeviceReport& loop) {
    count_waiting(true);
    result.loop = loop;
    result.devices.late_steps = loop.late_periods;
    result.devices.real_time = loop.real_time;
    if (step.timed() > 0) {
        result.devices.step_p50_us = 1e-3 * step.quantile_ns(0.5);
        result.devices.step_p99_us = 1e-3 * step.quantile_ns(0.99);
    }
    if (log_) result.logged = log_->sync() && faults_->sync();
    if (rows_) result.logged = rows_->sync() && result.logged;
    result.logged = result.logged && loop.lost_rows == 0 && lost_steps == 0;
}

std::filesystem::path rows_in(const std::filesystem::path& log) {
    return log.empty() ? log : device_rows_of(log / "press.tsv", "tactile");
}

namespace {

// Calls each(record) after every step, before the devices move on, until it returns false.
template <class Each>
void run_virtual_steps(std::span<const devices::PressRow> press, tactile::VirtualPort& port,
                       DeviceLoop<TactileLoop>& loop, const Each& each) {
    const bool touch = loop.plan->options.leads == scene::Leads::touch;
    const std::int64_t steps = steps_of(press);
    const std::vector<devices::PressRow> rows(press.begin(), press.end());
    StepRecord record;
    std::size_t at = 0;
    for (std::int64_t k = 0; k < steps; ++k) {
        const double time_s = press.front().t_s + tactile::kStep_s * static_cast<double>(k);
        PenContact contact;
        if (touch) {
            contact = contact_of(devices::press_at(rows, time_s, at));
            contact.time_s = time_s;
        }
        if (tactile_step(time_s, touch ? &contact : nullptr, port, loop, record.command)) {
            port.send(time_s, record.command);
            record.fault = port.guarded.guard.fault;
            if (!each(record)) return;
        }
        port.advance(tactile::kStep_s);
    }
}

// Greatest minus least sink of the pins under 1 N, over the depth; 0 without pins.
double own_shape_per_depth(const tactile::TactilePlan& plan, const Eigen::Vector2d& place_m) {
    if (!plan.pins) return 0.0;
    tactile::RendererWork work = tactile::make_work(plan.renderer);
    const tactile::Press press = tactile::press_with_force(plan.renderer, place_m, 1.0, work);
    Eigen::VectorXd sink_m(mechanics::pin_count(plan.pins->grid));
    tactile::shape_m(plan.renderer, work, sink_m);
    return press.depth_m > 0.0 ? (sink_m.maxCoeff() - sink_m.minCoeff()) / press.depth_m : 0.0;
}

}  // namespace

TactileResult run_virtual(std::shared_ptr<const tactile::TactilePlan> plan, const TactileRunOptions& options) {
    tactile::VirtualPort port(*plan, options.press, options.seed);
    auto loop = make_tactile_loop(plan);
    TactileSink sink(*plan, options.log, rows_in(options.log));
    run_virtual_steps(options.press, port, *loop, [&](const StepRecord& record) {
        sink.take(record, port.height_m);
        sink.take_rows(loop->recorded);
        sink.result.cut = options.ends && options.ends();
        return !sink.result.cut;
    });
    sink.take_rows(loop->recorded);
    sink.result.devices.guard = port.guarded.guard;
    sink.result.devices.reached_by = port.boards ? "simulator" : "estimate";
    sink.finish(loop->report);
    return std::move(sink.result);
}

TactileResult replay_rows(std::shared_ptr<const tactile::TactilePlan> plan, const std::vector<DeviceRow>& rows,
                          const TactileRunOptions& options) {
    DeviceMemory<TactileLoop> memory;
    memory.state = tactile::make_loop_state(*plan);
    TactileSink sink(*plan, options.log, {});
    StepRecord record;
    replay_device<TactileLoop>(plan, rows, memory, [&](const LoopCommand& command, double) {
        record.command = command;
        sink.take(record, {});
    });
    sink.result.devices.reached_by = plan->pins ? "estimate" : "nothing";
    sink.finish({});
    return std::move(sink.result);
}

TactileRecord run_press(const scene::Scene& scene, const scene::Plan& scene_plan,
                        std::span<const devices::PressRow> press, const PressOptions& options) {
    auto plan = std::make_shared<tactile::TactilePlan>(tactile::make_tactile_plan(scene, scene_plan));
    if (options.schedule && plan->options.display) plan->options.display->schedule = *options.schedule;
    if (options.compensation) plan->compensation = options.compensation;
    choose_input(press, *plan);
    const std::vector<devices::PressRow> rows(press.begin(), press.end());
    tactile::VirtualPort port(*plan, rows, options.seed);
    auto loop = make_tactile_loop(plan);
    TactileRecord out;
    if (!press.empty()) out.own_shape_per_depth = own_shape_per_depth(*plan, {press[0].x_m, press[0].y_m});
    out.pins = static_cast<int>(port.height_m.size());
    run_virtual_steps(press, port, *loop, [&](const StepRecord& record) {
        out.time_s.push_back(record.command.time_s);
        out.force_N.push_back(port.arm ? port.arm->hand_N : record.command.force_N);
        out.depth_m.push_back(port.arm ? port.arm->depth_m : record.command.depth_m);
        out.height_m.insert(out.height_m.end(), port.height_m.begin(), port.height_m.end());
        for (DeviceRow row; loop->recorded.take(row);) {
        }
        return true;
    });
    return out;
}

std::vector<std::string> missing_ports(const scene::TactileOptions& options) {
    std::vector<std::string> missing;
    const auto attempt = [&](const auto& open) {
        try {
            open();
        } catch (const std::exception& error) {
            missing.emplace_back(error.what());
        }
    };
    if (options.arm && !options.arm->device.empty()) {
        attempt([&] { devices::open_arm(devices::read_arm_device(options.arm->device)); });
    }
    if (options.display && !options.display->device.empty()) {
        attempt([&] {
            const devices::PinDevice device = devices::read_pin_device(options.display->device);
            std::error_code error;
            if (!std::filesystem::exists(device.port, error))
                throw files::bad_input(options.display->device.string(), "port", device.port, "a port that is there");
        });
    }
    return missing;
}

}  // namespace palpa::session
