#pragma once
// What stands around the loop of a soft device: the plant with a finger on it, and what becomes of the ticks (figures, log,
// recorded rows). For session/tangible_run*.cpp alone.

#include "scene/meter.h"
#include "session/tangible_run.h"

namespace palpa::session {

// One tick as the loop hands it on.
struct TickRecord {
    tangible::TangibleCommand command;
    double rendered_N = TangibleMoment::kNone;  // NaN: nobody knows
    double sensor_m = 0.0;
    double period_ns = 0.0;  // since the tick before; 0: not measured
    double tick_ns = 0.0;    // how long it took; 0: not measured
    std::int64_t missed = 0;
    devices::Fault guard = devices::Fault::none;  // of a real device: why the guard relaxes it
};

class TangibleSink {
  public:
    // `log`: folder that exists; `rows`: TRACE.tangible.tsv; each empty for none. Throws as TickLog and DeviceRowWriter.
    TangibleSink(const tangible::TangiblePlan& plan, const std::filesystem::path& log,
                 const std::filesystem::path& rows);
    void take(const TickRecord& record);
    void take_rows(RowRing& recorded);
    void finish(const DeviceReport& loop);  // syncs the files

    TangibleResult result;
    scene::Meter tick;
    scene::Meter period;
    std::int64_t lost_ticks = 0;

  private:
    std::optional<tangible::TickLog> log_;
    std::optional<DeviceRowWriter> rows_;
};

// A plant and the finger on it, in the time of the loop. Allocates nothing while it runs.
struct PlantPort {
    PlantPort(const tangible::TangiblePlan& plan, const tangible::Plant& the_plant, Finger the_finger,
              std::uint64_t seed);

    tangible::TangibleFeedback read(double time_s) noexcept;
    void send(double time_s, const tangible::TangibleCommand& command) noexcept;
    double rendered_N() const noexcept { return answer.force_N; }

    const tangible::Plant& plant;
    tangible::PlantState state;
    Finger finger;
    bool pen_pushes = false;  // the hand's force is pen_N, not the finger's
    double pen_N = 0.0;
    bool by_force = false;
    std::size_t at = 0;
    tangible::PlantAnswer answer;
};

// How long a finger is on the plant.
double seconds_of(const Finger& finger);
// Its depth at a time, or the force of the hand.
devices::PressRow finger_at(const Finger& finger, double time_s, std::size_t& at) noexcept;

std::unique_ptr<DeviceLoop<TangibleLoop>> make_tangible_loop(std::shared_ptr<const tangible::TangiblePlan> plan);

// Runs one tick: the place that is touched, if there is one, and what the sensor says. Returns whether `command` is to be
// sent. Allocates nothing.
bool tangible_step(double time_s, const PenContact* touch, const tangible::TangibleFeedback& feedback,
                   DeviceLoop<TangibleLoop>& loop, tangible::TangibleCommand& command) noexcept;

}  // namespace palpa::session
