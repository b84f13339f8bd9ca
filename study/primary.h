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

// Reads the key `analysis` of a protocol: {"primary": {"quantity": "sensitivity", "conditions": ["a", "b"], "test":
// "t"}}, or with "groups": ["I", "II"] and "condition": "a" instead of "conditions". `choices` tells whether people
// choose (quantity "correct") or find ("sensitivity", "ppv"). Throws InputError for names that the protocol does not
// have.
std::optional<PrimaryComparison> read_primary(files::JsonReader json, const std::vector<std::string>& conditions,
                                              const std::vector<std::string>& groups, bool choices);

const char* name_of(Quantity quantity);
const char* name_of(PrimaryTest test);

}  // namespace palpa::study
