#pragma once
// A run of arm and pins: live with devices or their simulators, replayed from recorded rows, or in virtual time, all by the
// same function (tactile/loop.h).
//
// What the loop takes in are the rows of device_rows.h, in TRACE.tactile.tsv. If the touch leads, a recorded press is
// taken on a fixed grid of 1 ms, each moment of it exactly once and however late the loop is, so that the log is a function
// of the press alone. If the arm leads, the log is a function of the recorded rows.

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/press_file.h"
#include "devices/spsc_ring.h"
#include "scene/meter.h"
#include "session/device_loop.h"
#include "session/tactile_moment.h"
#include "tactile/device_port.h"
#include "tactile/run_figures.h"
#include "tactile/step_log.h"
#include "tactile/virtual_port.h"

namespace palpa::session {

// The Device of device_rows.h. The touch is the pen's contact, or the press in its place.
struct TactileLoop {
    using Plan = std::shared_ptr<const tactile::TactilePlan>;
    using Feedback = tactile::LoopFeedback;
    using Command = tactile::LoopCommand;
    using State = tactile::LoopState;
    static Command command(const Plan& plan, const DeviceInput<Feedback>& in, State& state) noexcept;
};

// The press at a time as a contact that can be handed over. A press by force is one of tactile::InputKind::force.
PenContact contact_of(const devices::PressRow& row) noexcept;

// What the loop reads: depth or force, by the scene's arm, or by what a press that leads brings, or what recorded rows of
// one brought.
void choose_input(std::span<const devices::PressRow> press, tactile::TactilePlan& plan);
void choose_input(std::span<const DeviceRow> rows, tactile::TactilePlan& plan);

// What a run is given beside the plan.
struct TactileRunOptions {
    std::vector<devices::PressRow> press;
    std::filesystem::path log;     // folder that exists; empty for no log
    std::uint64_t seed = 1;        // of simulators in this process
    std::function<bool()> ends{};  // asked while a press goes on: true once a person wants its end
};

struct TactileResult {
    tactile::StepFigures steps;
    tactile::DeviceFigures devices;
    tactile::MismatchMeter mismatch;
    DeviceReport loop;
    bool logged = true;  // false: a log could not be written to its end
    bool cut = false;    // a person ended it before the press was over
};

// One process, no waiting: both simulators are models in this process (tactile/virtual_port.h).
TactileResult run_virtual(std::shared_ptr<const tactile::TactilePlan> plan, const TactileRunOptions& options);

// Runs recorded rows again, without devices.
TactileResult replay_rows(std::shared_ptr<const tactile::TactilePlan> plan, const std::vector<DeviceRow>& rows,
                          const TactileRunOptions& options);

// Runs live, in a thread at 1 kHz, until the press is over. Opens the devices. Throws std::runtime_error for a device
// that cannot be opened or does not answer. `heights`: where simulated pins write their true heights; empty if they are real.
TactileResult run_live_press(std::shared_ptr<const tactile::TactilePlan> plan, const TactileRunOptions& options,
                             const std::filesystem::path& heights);

// What one press brought to the hand: for simulated participants.
struct TactileRecord {
    std::vector<double> time_s;    // every ms
    std::vector<double> force_N;   // that the simulated hand feels; without an arm that of the tissue
    std::vector<double> depth_m;   // that it reached
    std::vector<double> height_m;  // true heights of the pins, `pins` per ms
    int pins = 0;
    // Greatest minus least sink of the pins over the depth under 1 N at the press's first place: the tissue's own shape.
    double own_shape_per_depth = 0.0;
};
struct PressOptions {
    std::uint64_t seed = 1;
    std::optional<scene::PinSchedule> schedule;              // instead of the scene's
    std::optional<tactile::ArmCompensation> compensation{};  // instead of that of the device's file
};
// A press in virtual time. `plan` is that of the scene; no table is made.
TactileRecord run_press(const scene::Scene& scene, const scene::Plan& plan, std::span<const devices::PressRow> press,
                        const PressOptions& options = {});

// The devices of a plan, each called real or simulated.
std::vector<TactileDevice> devices_of(const tactile::TactilePlan& plan, bool simulated);

// Returns what is not there: a line for each device file that cannot be read or port that cannot be opened. Empty: nothing
// is missing.
std::vector<std::string> missing_ports(const scene::TactileOptions& options);

struct TactileLiveOptions {
    bool simulate = false;       // starts the simulators, instead of the devices' own ports
    std::filesystem::path rows;  // TRACE.tactile.tsv; empty: not recorded
    std::filesystem::path log;   // folder that exists; empty: none
    std::uint64_t seed = 1;      // of the simulators
};

// Arm and pins while the app runs: a thread at 1 kHz. All functions are for one other thread, the app's.
class TactileLive {
  public:
    // The touch leads by force (a pen knows its force), unless the scene says that the arm leads. Throws InputError for a
    // scene that cannot be driven or a port that is not there, std::runtime_error for a device that does not answer.
    TactileLive(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan, const TactileLiveOptions& options);
    ~TactileLive();  // arm and pins rest
    TactileLive(const TactileLive&) = delete;
    TactileLive& operator=(const TactileLive&) = delete;

    // The latest moment; writes the rows and the log as well. Once a frame. Returns false if nothing is new.
    bool latest(TactileMoment& out);
    void hand_over(const PenContact& contact) noexcept;
    void stop() noexcept;     // F12: latched
    void restart() noexcept;  // a person's wish to go on
    std::vector<TactileDevice> devices() const;
    files::Json report();  // the keys of tactile::figures_json()

  private:
    struct Works;
    std::unique_ptr<Works> works_;
};

}  // namespace palpa::session
