#pragma once
// The body of a simulated soft device between its drives and its sensor: drives that lag, guides with friction, the tabulated
// answers, and a finger that follows a motion or is pushed by a hand. In steps of a millisecond.

#include "tangible/plant/plant_table.h"
#include "tangible/plant_model.h"

namespace palpa::tangible {

struct FingerMotion {
    double depth_m = 6e-3;
    double speed_m_per_s = 5e-3;  // greatest one on the way
    double pause_s = 1.0;         // between two presses
    double hand_N = 0.5;          // of a hand, at the deepest
};

// How far the press is: 0 lifted, 1 deepest; smooth in speed and acceleration (minimum jerk), to and fro, then a pause.
double press_share(const FingerMotion& motion, double time_s) noexcept;

struct PlantDrive {
    bool by_length = false;  // the cables' lengths are commanded, not their tensions
};

struct PlantBody {
    const PlantTable* table = nullptr;
    Plant plant;  // its options
    FingerMotion motion;
    PlantDrive drive;
    // what a step changes
    double time_s = 0.0;
    Actuation command{};    // N, Pa; m of cables by length
    Actuation actuation{};  // N, Pa, on the body
    Lengths length{};
    double driven_s = -1.0;  // when the first command came; negative: none yet
    double zero_m = 0.0;     // surface at the moment when the sensor is zeroed
    bool zeroed = false;
    double finger_m = 0.0;  // depth of the finger from there
    double speed_m_per_s = 0.0;
    double force_N = 0.0;
    PlantState sensor;  // of which the sensor's part alone
};

// `driven`: the drives are not at rest. Half a second after they first were not, the sensor is zeroed on the surface, as a
// person does, and the presses begin.
void step_body(double dt_s, const Actuation& drives, bool driven, PlantBody& body) noexcept;
// What the sensor shows now, m.
double displacement_m(PlantBody& body) noexcept;

}  // namespace palpa::tangible
