#pragma once
// The one comparison that a study is made for, which its protocol states before anybody takes part. All others are
// corrected for their number.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/json.h"
#include "study/people.h"

namespace palpa::study {

enum class PrimaryTest { t, permutation };

struct PrimaryComparison {
    Quantity quantity = Quantity::sensitivity;
    bool of_groups = false;
    std::array<std::string, 2> sides;  // two conditions, or two groups under one condition; the difference is 0 - 1
    std::string condition;             // with groups
    PrimaryTest test = PrimaryTest::t;
};

struct Protocol;

// Reads the key `analysis.primary` of a protocol: {"quantity": "sensitivity", "conditions": ["a", "b"], "test":
// "t"}, or with "groups": ["I", "II"] and "condition": "a" instead of "conditions". `protocol` knows its conditions,
// their tasks and its groups: "correct" compares conditions with the task choice, "sensitivity" and "ppv" those in which
// nodules are found. Throws InputError for names that the protocol does not have.
PrimaryComparison read_primary(files::JsonReader json, const Protocol& protocol);

const char* name_of(Quantity quantity);
const char* name_of(PrimaryTest test);

}  // namespace palpa::study
