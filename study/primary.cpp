#include "study/primary.h"

#include <algorithm>

#include "files/input_error.h"
#include "files/text.h"
#include "study/protocol.h"

namespace palpa::study {
namespace {

template <class Things>
std::vector<std::string> ids_in(const Things& things) {
    std::vector<std::string> ids;
    for (const auto& one : things) ids.push_back(one.id);
    return ids;
}

std::array<std::string, 2> read_two(files::JsonReader& json, std::string_view key,
                                    const std::vector<std::string>& known) {
    const files::Json& list = json.any(key);
    if (!list.is_array() || list.size() != 2) json.fail(key, files::described(list), "an array of two ids");
    std::array<std::string, 2> two;
    for (std::size_t i = 0; i < 2; ++i) {
        two[i] = list[i].is_string() ? list[i].get<std::string>() : "";
        if (std::find(known.begin(), known.end(), two[i]) == known.end())
            json.fail(key, files::described(list[i]), "an id that this protocol defines");
    }
    if (two[0] == two[1]) json.fail(key, files::shown(two[0]) + " twice", "two different ids");
    return two;
}

// Refuses a quantity that this condition does not have.
void check_quantity(const files::JsonReader& json, const Protocol& protocol, const std::string& id, Quantity quantity) {
    const auto& all = protocol.conditions;
    const auto it = std::find_if(all.begin(), all.end(), [&](const Condition& one) { return one.id == id; });
    const TaskKind task = task_of(protocol, static_cast<std::size_t>(it - all.begin()));
    const bool choices = quantity == Quantity::correct;
    if (task == (choices ? TaskKind::choice : TaskKind::find)) return;
    const std::string under = " under " + files::shown(id);
    const std::string found = files::shown(name_of(quantity));
    if (task == TaskKind::choice) json.fail("quantity", found, "correct: people choose" + under);
    if (task == TaskKind::find) json.fail("quantity", found, "sensitivity or ppv: people find nodules" + under);
    json.fail("quantity", found, "other conditions: the method sets the share of right answers" + under);
}

void check_both_have(const files::JsonReader& json, const Protocol& protocol, const PrimaryComparison& primary) {
    for (const Group& group : protocol.groups) {
        if (std::find(primary.sides.begin(), primary.sides.end(), group.id) == primary.sides.end()) continue;
        const auto is_it = [&](std::size_t i) { return protocol.conditions[i].id == primary.condition; };
        if (std::any_of(group.conditions.begin(), group.conditions.end(), is_it)) continue;
        json.fail("condition", files::shown(primary.condition) + ", which group " + files::shown(group.id) + " lacks",
                  "a condition of both groups");
    }
}

}  // namespace

PrimaryComparison read_primary(files::JsonReader json, const Protocol& protocol) {
    json.only({"quantity", "conditions", "groups", "condition", "test"});
    const std::vector<std::string> conditions = ids_in(protocol.conditions);
    PrimaryComparison primary;
    primary.quantity = static_cast<Quantity>(json.choice("quantity", {"sensitivity", "ppv", "correct"}));
    if (json.has("test")) primary.test = static_cast<PrimaryTest>(json.choice("test", {"t", "permutation"}));
    primary.of_groups = json.has("groups");
    if (!primary.of_groups) {
        primary.sides = read_two(json, "conditions", conditions);
        for (const std::string& side : primary.sides) check_quantity(json, protocol, side, primary.quantity);
    } else {
        primary.sides = read_two(json, "groups", ids_in(protocol.groups));
        primary.condition = json.text("condition");
        if (std::find(conditions.begin(), conditions.end(), primary.condition) == conditions.end())
            json.fail("condition", files::shown(primary.condition), "the id of a condition of this protocol");
        check_quantity(json, protocol, primary.condition, primary.quantity);
        check_both_have(json, protocol, primary);
    }
    json.finish();
    return primary;
}

const char* name_of(Quantity quantity) {
    constexpr const char* kNames[] = {"sensitivity", "ppv", "correct"};
    return kNames[static_cast<int>(quantity)];
}

const char* name_of(PrimaryTest test) { return test == PrimaryTest::t ? "t" : "permutation"; }

}  // namespace palpa::study
