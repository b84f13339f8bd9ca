#pragma once
// A simulator as a process of its own, ended with its owner.

#include <cstdio>
#include <string>
#include <sys/types.h>
#include <vector>

namespace palpa::devices::simulators {

class SimulatorProcess {
  public:
    // Starts it and waits for its first line, "port ...". Throws std::runtime_error if that is not what it says. It ends
    // with this process too, however that ends, unless `outlives` is set.
    SimulatorProcess(const std::string& program, std::vector<std::string> arguments, bool outlives = false);
    ~SimulatorProcess();
    SimulatorProcess(const SimulatorProcess&) = delete;
    SimulatorProcess& operator=(const SimulatorProcess&) = delete;

    const std::string& port() const { return port_; }
    pid_t pid() const { return pid_; }
    // The next line that it prints, without the newline; waits for it.
    std::string line();
    void end();

  private:
    pid_t pid_ = -1;
    std::FILE* out_ = nullptr;
    std::string port_;
};

// Path of a simulator by its name: beside the running program in a build folder, or where the package puts it. Throws
// std::runtime_error that names the places if it is not there.
std::string simulator_program(const std::string& name);

}  // namespace palpa::devices::simulators
