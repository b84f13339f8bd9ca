#pragma once
// The simulated side of a soft device's wires: pseudo-terminals and UDP that speak the protocols of its rig, with the devices
// behind them. What the actuators then do to a body is the business of whoever runs it: rig_simulator, or tangible_plant.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "devices/rig.h"
#include "devices/simulators/alicat_units.h"
#include "devices/simulators/dynamixel_bus.h"
#include "devices/simulators/framed_board.h"
#include "devices/simulators/line_faults.h"
#include "devices/simulators/maestro_board.h"
#include "devices/simulators/terminal.h"

namespace palpa::devices::simulators {

struct WiresOptions {
    LineFaults faults;
    std::string links;      // folder of symbolic links to the terminals, by the ports' names; empty: none
    bool watchdogs = true;  // false: devices that hold their force when the line falls silent
    bool sensor_by_udp = false;
    double sensor_rate_Hz = 100.0;
    double silent_from_s = -1e9;  // all terminals are unplugged then, and at SIGUSR1
    double silent_s = 0.0;
    double garbage_from_s = -1e9;  // replies are random bytes then, and at SIGUSR2
    double garbage_s = 0.0;
    std::uint64_t seed = 1;
};
void add_wires_options(CLI::App& app, WiresOptions& options);

struct SimulatedLine {
    Terminal terminal;
    DynamixelBus dynamixel;
    AlicatUnits alicat;
    FramedBoard framed;
    std::unique_ptr<MaestroBoards> maestro;
    std::array<std::int32_t, kMostChannels> sketch{};  // outputs
    std::size_t sketch_at = 0;                         // bytes of the frame that is arriving
};

class RigWires {
  public:
    // Throws std::runtime_error if no terminal can be had.
    RigWires(const ActuatorRig& rig, const WiresOptions& options);
    ~RigWires();
    RigWires(const RigWires&) = delete;
    RigWires& operator=(const RigWires&) = delete;

    // "motors=/dev/pts/3 sensor=udp:127.0.0.1:4021", as the command line takes it (set_port()).
    std::string ports() const;
    // Waits for bytes, 1 ms at most, takes them, and moves the devices on to the present.
    void run();
    // What the actuator does now, in its unit; where it is relaxed, by whatever reason, that value.
    double value(std::size_t channel) const;
    bool relaxed(std::size_t channel) const;
    // For how long bytes have come on any line without a pause of half a second.
    double talking_s() const;
    // Sends a reading if one is due at this moment.
    void show_displacement(double displacement_m);
    double elapsed_s() const { return time_s_; }
    // Targets that were ever outside of a channel's range; 0 is what a guard is for.
    std::int64_t out_of_range() const { return out_of_range_; }

  private:
    void plug(bool in);
    void talk(std::size_t port);
    void advance_all(double dt_s);
    void take_sketch(std::span<const std::uint8_t> bytes, SimulatedLine& line) const;
    double wanted(std::size_t channel) const;
    void send_reading(std::int32_t counts);

    ActuatorRig rig_;
    WiresOptions options_;
    std::vector<SimulatedLine> line_;
    Terminal sensor_;
    int udp_ = -1;
    int udp_port_ = 0;
    std::string listener_;  // address of who asked for readings
    double asked_s_ = -1e9;
    double began_s_ = 0.0;
    double time_s_ = 0.0;
    double shown_due_s_ = 0.0;
    double heard_s_ = -1e9;
    double talking_from_s_ = 0.0;
    bool plugged_ = false;
    std::int64_t out_of_range_ = 0;
    std::mt19937_64 random_;
};

}  // namespace palpa::devices::simulators
