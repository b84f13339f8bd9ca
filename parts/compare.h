#pragma once
// Two designs of a part, side by side.

#include <array>
#include <optional>
#include <string>

#include "parts/stiffness.h"

namespace palpa::parts {

// A difference of compliance that people can just tell, as a share of it; measured with real objects, not with Palpa.
struct WeberFraction {
    double share;
    const char* measured_with;
};
// Bergmann Tiest and Kappers, IEEE Trans. Haptics 2 (2009), 189-199; Tan, Durlach, Beauregard and Srinivasan, Perception &
// Psychophysics 57 (1995), 495-510.
inline constexpr std::array<WeberFraction, 2> kWeberFractions{
    WeberFraction{0.15, "silicone pressed by a finger, whose surface is felt to give way"},
    WeberFraction{0.22, "compliance by the fingers without cues of work and of the last force"}};

struct ComparedDesign {
    MethodResult stiffness;
    double mass_kg = 0.0;
    std::optional<double> switch_force_N;  // the peak that its button's force passes
};

struct PartComparison {
    std::string load;
    double force_N = 0.0;
    ComparedDesign a, b;
    double stiffness_ratio = 0.0;  // of b over a, as are the others
    double mass_ratio = 0.0;
    std::optional<double> switch_force_ratio;  // if both have a button
    double difference = 0.0;                   // the larger compliance over the smaller one, less 1
};

// Compares the parts under the load of that name ("": the only one that both have), by one method. Throws InputError as
// stiffness_of() does, for a load that one of them lacks, for loads of different forces or directions, and if
// the method has no answer.
PartComparison compare_parts(const Part& a, const Part& b, const std::string& load, const StiffnessOptions& options);

}  // namespace palpa::parts
