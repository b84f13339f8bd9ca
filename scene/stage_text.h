#pragma once
// One line of `palpa explain` about a device that a scene drives.

#include <string>

namespace palpa::scene {

struct StageText {
    std::string name;
    std::string per;       // step, tick, frame or start
    std::string fidelity;  // how it is computed
    std::string error;     // how large its error is, and against what
    double cost_us = 0.0;
};

}  // namespace palpa::scene
