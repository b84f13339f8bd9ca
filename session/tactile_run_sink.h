#pragma once
// What becomes of the steps of a loop of arm and pins, outside of its thread: figures, log, recorded rows. For
// session/tactile_run*.cpp alone.

#include "session/tactile_run.h"

namespace palpa::session {

// One step as the loop hands it on.
struct StepRecord {
    tactile::LoopCommand command;
    double host_s = 0.0;  // when it was computed
    double sensor_N = 0.0;
    double has_sensor = 0.0;
    double round_trip_s = 0.0;
    double arm_age_s = 0.0;  // since the arm's last answer
    std::int64_t lost = 0;   // packets so far
    std::int64_t late = 0;   // steps begun more than 1 ms late so far
    double step_ns = 0.0;    // how long it took; 0: not measured
    devices::Fault fault = devices::Fault::none;
    const char* fault_words = "";  // static; empty: text(fault)
    bool latched = false;
};

class TactileSink {
  public:
    // `log`: folder that exists, which also gets faults.tsv, a row for each change (time_s, fault; "none" where it ends);
    // `rows`: TRACE.tactile.tsv; each empty for none. Throws as StepLog and DeviceRowWriter.
    TactileSink(const tactile::TactilePlan& plan, const std::filesystem::path& log, const std::filesystem::path& rows);
    // reached_m: true heights of the pins; empty: the estimate counts.
    void take(const StepRecord& record, std::span<const double> reached_m);
    void take_rows(RowRing& recorded);
    void finish(const DeviceReport& loop);  // syncs the files

    TactileResult result;
    scene::Meter step;  // time of a step
    std::int64_t lost_steps = 0;

  private:
    // A step counts once the next one knows of no fault: the reading that trips the guard is that of a step whose command
    // the guard replaced by rest.
    struct Waiting {
        tactile::LoopCommand command;
        std::vector<double> reached_m;
    };
    void count_waiting(bool rendered);
    void log_fault(const StepRecord& record);

    std::optional<Waiting> waiting_;
    std::optional<tactile::StepLog> log_;
    std::optional<files::AppendFile> faults_;
    devices::Fault fault_ = devices::Fault::none;
    std::optional<DeviceRowWriter> rows_;
};

// What says nothing.
struct Silent {
    bool arm = false;
    bool sensor = false;  // that a high-impedance arm follows
    bool pins = false;
};

// The fault in words; a silence with what is silent. Static.
const char* fault_words(devices::Fault fault, const Silent& silent);

// How many steps of 1 ms a press lasts.
std::int64_t steps_of(std::span<const devices::PressRow> press);

// LOG/press.tactile.tsv; empty without a log.
std::filesystem::path rows_in(const std::filesystem::path& log);

inline std::unique_ptr<DeviceLoop<TactileLoop>> make_tactile_loop(
    const std::shared_ptr<const tactile::TactilePlan>& plan) {
    auto loop = std::make_unique<DeviceLoop<TactileLoop>>();
    loop->plan = plan;
    loop->memory.state = tactile::make_loop_state(*plan);
    return loop;
}

// Runs one step: the touch, if there is one, and what the devices say. Returns whether `command` is to be sent. Allocates
// nothing.
template <class Port>
bool tactile_step(double time_s, const PenContact* touch, Port& port, DeviceLoop<TactileLoop>& loop,
                  tactile::LoopCommand& command) noexcept {
    if (touch != nullptr) {
        if (all_finite(*touch)) {
            take_row<TactileLoop>(device_row(DeviceRowKind::hand_over, time_s, *touch), loop, command);
            ++loop.report.hand_overs;
        } else {
            ++loop.report.not_numbers;
        }
    }
    tactile::LoopFeedback feedback;
    port.read(feedback);
    feedback.by_table = tactile::table_of(*loop.plan) != nullptr ? 1.0 : 0.0;
    if (!all_finite(feedback)) {
        ++loop.report.not_numbers;
        return false;
    }
    ++loop.report.rows;
    if (take_row<TactileLoop>(device_row(DeviceRowKind::feedback, time_s, feedback), loop, command)) return true;
    ++loop.report.refused_commands;
    return false;
}

}  // namespace palpa::session
