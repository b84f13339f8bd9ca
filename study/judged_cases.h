#pragma once
// The marks of one person in one case, as logs and tables give them, and their table for study/free_response.h.

#include <string>
#include <vector>

#include "study/free_response.h"

namespace palpa::study {

struct JudgedCase {
    int condition = 0;
    int participant = 0;
    std::string id;                    // of the case; in logs its tissue, which a person may meet several times
    std::vector<std::string> lesions;  // empty: none
    Reading reading;
    bool rated = true;  // false: some of the marks have no rating, which then is not in `reading`
};

// The ratings that a scale has, ends included; by default all numbers.
struct RatingScale {
    double low = -1e300;
    double high = 1e300;
};

// The table of all cases. A tissue that a person judged several times under one condition is several cases: "name",
// "name (2)" and so on, in the order of `judged`. Names are in the order of their indices; conditions and participants
// without a judged case are left out. Needs `rated` of all.
FreeResponse free_response_of(const std::vector<JudgedCase>& judged, const std::vector<std::string>& conditions,
                              const std::vector<std::string>& participants);

}  // namespace palpa::study
