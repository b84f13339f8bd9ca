#include "study/judged_cases.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <tuple>

namespace palpa::study {
namespace {

// Returns the new index of each old one, -1 for those that nobody uses, and takes over the names of the others.
std::vector<int> used(const std::vector<JudgedCase>& judged, int JudgedCase::*which,
                      const std::vector<std::string>& names, std::vector<std::string>& out) {
    std::vector<int> moved(names.size(), -1);
    for (const JudgedCase& one : judged) moved[static_cast<std::size_t>(one.*which)] = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (moved[i] < 0) continue;
        moved[i] = static_cast<int>(out.size());
        out.push_back(names[i]);
    }
    return moved;
}

}  // namespace

FreeResponse free_response_of(const std::vector<JudgedCase>& judged, const std::vector<std::string>& conditions,
                              const std::vector<std::string>& participants) {
    FreeResponse out;
    const std::vector<int> condition = used(judged, &JudgedCase::condition, conditions, out.conditions);
    const std::vector<int> participant = used(judged, &JudgedCase::participant, participants, out.participants);
    using Tissue = std::pair<std::string, std::vector<std::string>>;
    std::map<std::tuple<int, int, Tissue>, int> repeats;
    std::map<std::pair<Tissue, int>, std::size_t> places;
    std::vector<std::size_t> case_of;
    for (const JudgedCase& one : judged) {
        assert(one.rated);
        const Tissue tissue{one.id, one.lesions};
        const int repeat = ++repeats[{one.condition, one.participant, tissue}];
        const auto [it, fresh] = places.emplace(std::pair(tissue, repeat), out.cases.size());
        if (fresh) {
            const std::string id = repeat == 1 ? one.id : one.id + " (" + std::to_string(repeat) + ")";
            out.cases.push_back({id, one.lesions, {}});
        }
        case_of.push_back(it->second);
    }
    out.readings.resize(out.conditions.size() * out.participants.size() * out.cases.size());
    for (std::size_t r = 0; r < judged.size(); ++r) {
        const auto i = static_cast<std::size_t>(condition[static_cast<std::size_t>(judged[r].condition)]);
        const auto j = static_cast<std::size_t>(participant[static_cast<std::size_t>(judged[r].participant)]);
        out.readings[out.place(i, j, case_of[r])] = judged[r].reading;
    }
    return out;
}

}  // namespace palpa::study
