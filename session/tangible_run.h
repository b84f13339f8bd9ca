#pragma once
// A run of a soft device: live with its hardware or a model in its place, or in virtual time, all by the same function
// (tangible/loop.h). What the loop takes in are the rows of device_rows.h, in TRACE.tangible.tsv.

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/limits.h"
#include "devices/press_file.h"
#include "session/device_loop.h"
#include "session/tactile_moment.h"
#include "session/tangible_moment.h"
#include "tangible/characterise.h"
#include "tangible/run_figures.h"
#include "tangible/tick_log.h"

namespace palpa::session {

// The Device of device_rows.h. The pen's contact says which place of the tissue is felt.
struct TangibleLoop {
    using Plan = std::shared_ptr<const tangible::TangiblePlan>;
    using Feedback = tangible::TangibleFeedback;
    using Command = tangible::TangibleCommand;
    using State = tangible::TangibleState;
    static Command command(const Plan& plan, const DeviceInput<Feedback>& in, State& state) noexcept;
};

// A finger on a plant in this process: it follows a motion, or a hand pushes it with a force.
struct Finger {
    std::vector<devices::PressRow> press;  // depth or force over time; empty: `motion`, again and again
    tangible::PressMotion motion{};
    double seconds = 0.0;  // how long; 0: the press, or the motion once
};

struct TangibleRunOptions {
    Finger finger;
    std::filesystem::path log;     // folder that exists; empty for no log
    std::uint64_t seed = 1;        // of the plant's noise
    std::function<bool()> ends{};  // asked while a press goes on: true once a person wants its end
};

// What the guard of a real device did with the values for its drives (devices/rig_guard.h), one for each drive and command.
struct GuardFigures {
    std::int64_t commands = 0;
    std::int64_t limited = 0;  // values out of a drive's range
    std::int64_t slewed = 0;   // that wanted to change too fast
    std::int64_t scaled = 0;   // commands that added up to too much force
};

struct TangibleResult {
    tangible::TickFigures ticks;
    tangible::ClockFigures clock;
    DeviceReport loop;
    devices::Fault guard = devices::Fault::none;  // why the guard of a real device has relaxed it
    GuardFigures guarded;
    bool logged = true;  // false: a log could not be written to its end
    bool cut = false;    // a person ended it before the press was over
};

// In virtual time, on a plant: the same options give the same log, byte for byte.
TangibleResult run_tangible_virtual(std::shared_ptr<const tangible::TangiblePlan> plan, const tangible::Plant& plant,
                                    const TangibleRunOptions& options);

// Runs recorded rows again, without a plant.
TangibleResult replay_tangible_rows(std::shared_ptr<const tangible::TangiblePlan> plan,
                                    const std::vector<DeviceRow>& rows, const TangibleRunOptions& options);

// Live, in a thread at the loop's rate, until the time is over: on a plant in this process, or on the device's ports
// (NAME=PATH each, instead of the paths of its file). Throws std::runtime_error for a device that cannot be opened or does
// not answer, InputError for a port that the device does not have.
TangibleResult run_tangible_live(std::shared_ptr<const tangible::TangiblePlan> plan,
                                 const std::optional<tangible::Plant>& plant, const std::vector<std::string>& ports,
                                 const TangibleRunOptions& options);

// What one press brought to the hand: for simulated participants.
struct TangibleRecord {
    std::vector<double> time_s;   // every tick
    std::vector<double> force_N;  // on the finger, of the plant
    std::vector<double> depth_m;  // of the finger in the device
};
// A press in virtual time against the scene's plant (the device's own model if it names none). A press by force is a hand
// without mass that goes to where its force is in equilibrium with the device. The press ends early where the device gives
// way. Throws as make_tangible_plan().
TangibleRecord press_tangible(const scene::Scene& scene, const scene::Plan& plan,
                              std::span<const devices::PressRow> press, std::uint64_t seed);

// The parts of a device, each called real or simulated.
std::vector<TactileDevice> devices_of(const tangible::TangiblePlan& plan, bool simulated);

// A line for each port of the device that is not there. Empty: nothing is missing, as for a scene with a plant.
std::vector<std::string> missing_tangible_ports(const scene::TangibleOptions& options);

struct TangibleLiveOptions {
    bool simulate = false;       // the device's own model in the place of hardware, where the scene names no plant
    std::filesystem::path rows;  // TRACE.tangible.tsv; empty: not recorded
    std::filesystem::path log;   // folder that exists; empty: none
    std::uint64_t seed = 1;
};

// A soft device while the app runs, in a thread of its own. All functions are for one other thread, the app's.
class TangibleLive {
  public:
    // Throws InputError for a scene that cannot be driven or a port that is not there, std::runtime_error for a device that
    // does not answer.
    TangibleLive(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan,
                 const TangibleLiveOptions& options);
    ~TangibleLive();  // the device relaxes
    TangibleLive(const TangibleLive&) = delete;
    TangibleLive& operator=(const TangibleLive&) = delete;

    // The latest moment; writes the rows and the log as well. Once a frame. Returns false if nothing is new.
    bool latest(TangibleMoment& out);
    bool latest(TangibleShape& out);
    // Place on the tissue; with a plant the pen's normal force is that of the hand on the device.
    void hand_over(const PenContact& contact) noexcept;
    void stop() noexcept;     // F12: latched
    void restart() noexcept;  // a person's wish to go on
    const TangibleBody& body() const;
    std::vector<TactileDevice> devices() const;
    files::Json report();  // the keys of tangible::figures_json()

  private:
    struct Works;
    std::unique_ptr<Works> works_;
};

}  // namespace palpa::session
