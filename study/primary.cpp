#include "study/primary.h"

#include <algorithm>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::study {
namespace {

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

PrimaryComparison read_comparison(files::JsonReader json, const std::vector<std::string>& conditions,
                                  const std::vector<std::string>& groups, bool choices) {
    json.only({"quantity", "conditions", "groups", "condition", "test"});
    PrimaryComparison primary;
    primary.quantity = static_cast<Quantity>(json.choice("quantity", {"sensitivity", "ppv", "correct"}));
    if (choices != (primary.quantity == Quantity::correct)) {
        json.fail("quantity", files::shown(name_of(primary.quantity)),
                  choices ? "correct: people choose" : "sensitivity or ppv: people find nodules");
    }
    if (json.has("test")) primary.test = static_cast<PrimaryTest>(json.choice("test", {"t", "permutation"}));
    primary.of_groups = json.has("groups");
    if (!primary.of_groups) {
        primary.sides = read_two(json, "conditions", conditions);
    } else {
        primary.sides = read_two(json, "groups", groups);
        primary.condition = json.text("condition");
        if (std::find(conditions.begin(), conditions.end(), primary.condition) == conditions.end())
            json.fail("condition", files::shown(primary.condition), "the id of a condition of this protocol");
    }
    json.finish();
    return primary;
}

}  // namespace

std::optional<PrimaryComparison> read_primary(files::JsonReader json, const std::vector<std::string>& conditions,
                                              const std::vector<std::string>& groups, bool choices) {
    json.only({"primary"});
    std::optional<PrimaryComparison> primary;
    if (auto one = json.optional_object("primary")) primary = read_comparison(*one, conditions, groups, choices);
    json.finish();
    return primary;
}

const char* name_of(Quantity quantity) {
    constexpr const char* kNames[] = {"sensitivity", "ppv", "correct"};
    return kNames[static_cast<int>(quantity)];
}

const char* name_of(PrimaryTest test) { return test == PrimaryTest::t ? "t" : "permutation"; }

}  // namespace palpa::study
