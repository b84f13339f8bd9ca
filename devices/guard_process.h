#pragma once
// The guard as a process of its own, which alone holds the ports of a soft device and the limits of what goes there
// (rig_guard.h). It relaxes everything, for good, after 100 ms without a command, a command that is not a number, a fault of a
// line or of the sensor, stop(), and when this program ends, however that happens.
//
// If the guard itself is killed, the devices' own watchdogs remain (framed, dynamixel by force, maestro). A pressure
// controller and a sketch board have none and keep what they were told last, until a new guard starts and relaxes them.

#include <memory>
#include <span>
#include <string>
#include <sys/types.h>

#include "devices/guard_link.h"

namespace palpa::devices {

// Path of the program palpa_guard: beside the running program in a build folder, or where the package puts it. Throws
// std::runtime_error that names the places if it is not there.
std::string guard_program();

// The process and the way to it. send() may be called by any thread.
class GuardLink {
  public:
    // Throws std::runtime_error with the guard's own words if it cannot start: a port that cannot be opened, for one.
    // `start`: the JSON that it begins with.
    GuardLink(const std::string& program, const std::string& start);
    ~GuardLink();  // everything relaxes; waits for it, two seconds at most
    GuardLink(const GuardLink&) = delete;
    GuardLink& operator=(const GuardLink&) = delete;

    void send(GuardWord word, std::span<const double> values = {}) noexcept;  // never waits
    // The size of the oldest message that was not received yet, 0 if there is none, -1 once the guard has ended.
    int receive(void* bytes, std::size_t room) noexcept;
    pid_t pid() const { return pid_; }

  private:
    void wait_for_start(const std::string& program);
    int socket_ = -1;
    pid_t pid_ = -1;
};

class GuardProcess {
  public:
    // Throws like GuardLink. The lines are being proved when it returns.
    explicit GuardProcess(const ActuatorRig& rig, const std::string& program = guard_program());

    // Waits until every line is proved and the sensor has been heard. Throws std::runtime_error that says what is missing after
    // `most_s`.
    void wait_until_ready(double most_s);

    // One value for each actuator of the rig, in its order and unit: N, m of cable, Pa. Never waits.
    void send(std::span<const double> values) noexcept { link_.send(GuardWord::command, values); }
    // The newest report, by the loop's thread. Returns false, and leaves `out` as it is, if there is nothing new. Once the guard
    // has ended its fault is guard_gone; while it tells nothing, guard_silent.
    bool poll(RigReport& out) noexcept;

    void stop() noexcept { link_.send(GuardWord::stop); }        // F12: latched; by any thread
    void release() noexcept { link_.send(GuardWord::release); }  // a person's wish to go on; by any thread
    pid_t pid() const { return link_.pid(); }

  private:
    ActuatorRig rig_;
    GuardLink link_;
    RigReport newest_;
    double reported_s_ = 0.0;  // when that came
    bool again_ = false;       // wait_until_ready() has taken it, the loop has not
};

// What keeps a line from being driven, for messages: "port 'motors' at /dev/ttyUSB0: nothing answers".
std::string trouble_of(const RigPort& port, const LineHealth& health);

}  // namespace palpa::devices
