#pragma once
// The invented sets of free-response data, data/statistics/froc_*.json beside the checkout: "nl|ll" of each case, where a
// rating 0 of a lesion stands for an unmarked one. All lesions weigh the same.

#include <string>

#include "files/json.h"
#include "study/free_response.h"

namespace palpa::test {

inline files::Json froc_json(const std::string& name) {
    return files::read_json(std::string(PALPA_RECORDINGS) + "/statistics/" + name);
}

inline study::FreeResponse froc_set(const files::Json& json) {
    const files::Json& data = json["data"];
    study::FreeResponse out;
    for (std::size_t i = 0; i < data.size(); ++i) out.conditions.push_back(std::string(1, static_cast<char>('A' + i)));
    for (std::size_t j = 0; j < data[0].size(); ++j) out.participants.push_back("p" + std::to_string(j + 1));
    for (std::size_t k = 0; k < data[0][0].size(); ++k) {
        study::FreeResponseCase one{"c" + std::to_string(k + 1), {}, {}};
        const files::Json& ll = data[0][0][k]["ll"];
        for (std::size_t l = 0; l < (ll.is_null() ? 0 : ll.size()); ++l) one.lesions.push_back("l" + std::to_string(l));
        out.cases.push_back(one);
    }
    for (const files::Json& condition : data) {
        for (const files::Json& person : condition) {
            for (const files::Json& one : person) {
                study::Reading reading;
                for (const files::Json& rating : one["nl"]) reading.nl.push_back(rating.get<double>());
                for (const files::Json& rating : one["ll"].is_null() ? files::Json::array() : one["ll"])
                    reading.ll.push_back(rating == 0 ? study::kUnmarked : rating.get<double>());
                out.readings.emplace_back(reading);
            }
        }
    }
    return out;
}

}  // namespace palpa::test
