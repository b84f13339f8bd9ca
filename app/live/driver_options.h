#pragma once

#include <filesystem>

namespace palpa::app {

// How a trial drives its devices.
struct DriverOptions {
    bool simulate = false;       // starts the simulators, and connects to them instead
    std::filesystem::path rows;  // file of the loop's input rows; empty: not recorded
};

}  // namespace palpa::app
