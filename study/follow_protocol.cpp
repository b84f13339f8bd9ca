#include "study/follow_protocol.h"

#include <algorithm>
#include <map>

namespace palpa::study {
namespace {

// Moves the names that stand in `first` to the front, in its order. Returns the new index of each old one.
std::vector<int> reorder(const std::vector<std::string>& first, std::vector<std::string>& names) {
    std::vector<std::string> ordered;
    for (const std::string& name : first) {
        if (std::find(names.begin(), names.end(), name) != names.end()) ordered.push_back(name);
    }
    std::vector<int> moved;
    for (const std::string& name : names) moved.push_back(index_of(name, ordered));
    names = std::move(ordered);
    return moved;
}

template <class Rows>
void move_conditions(const std::vector<int>& moved, Rows& rows) {
    for (auto& row : rows) row.condition = moved[static_cast<std::size_t>(row.condition)];
}

template <class Things>
std::vector<std::string> ids_of(const Things& things) {
    std::vector<std::string> ids;
    for (const auto& one : things) ids.push_back(one.id);
    return ids;
}

}  // namespace

void follow_protocol(const Protocol& protocol, Observations& seen) {
    const std::vector<int> moved = reorder(ids_of(protocol.conditions), seen.conditions);
    move_conditions(moved, seen.rows);
    move_conditions(moved, seen.trials);
    move_conditions(moved, seen.choices);
    move_conditions(moved, seen.stiffer);
    move_conditions(moved, seen.judged);
    seen.primary = protocol.primary;
    for (const Condition& condition : protocol.conditions) {
        seen.displays.push_back({condition.id, name_of(condition.modality), condition.scene.empty()});
    }
    const std::vector<int> moved_groups = reorder(ids_of(protocol.groups), seen.groups);
    for (int& group : seen.group_of) {
        if (group >= 0) group = moved_groups[static_cast<std::size_t>(group)];
    }
}

void take_staircases(const std::filesystem::path& directory, const std::set<std::string>& left_out,
                     const std::set<std::pair<std::string, int>>& left_out_trials, Observations& seen) {
    std::vector<std::string> counted;
    for (const std::string& code : seen.participants) {
        if (left_out.count(code) == 0) counted.push_back(code);
    }
    seen.staircases = staircase_results(directory, counted, left_out_trials, seen.notes);
    std::set<std::string> conditions;
    for (const StaircaseResult& one : seen.staircases) conditions.insert(one.condition);
    std::erase_if(seen.choices, [&](const Choices& row) {
        return conditions.count(seen.conditions[static_cast<std::size_t>(row.condition)]) > 0;
    });
}

void take_groups(const std::vector<Person>& people, Observations& seen) {
    std::map<std::string, std::string> group_of;
    for (const Person& person : people) group_of[person.code] = person.group;
    for (const std::string& code : seen.participants) {
        const auto it = group_of.find(code);
        const bool told = it != group_of.end() && it->second != "n/a" && !it->second.empty();
        seen.group_of.push_back(told ? index_of(it->second, seen.groups) : -1);
    }
}

}  // namespace palpa::study
