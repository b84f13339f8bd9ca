#include "study/protocol_checks.h"

#include <algorithm>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::study {

bool any_task(const Protocol& protocol, TaskKind task) {
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        if (task_of(protocol, i) == task) return true;
    }
    return false;
}

namespace {

void check_tasks(const files::JsonReader& json, const Protocol& protocol) {
    for (const TaskKind task : {TaskKind::choice, TaskKind::staircase}) {
        const bool used = any_task(protocol, task);
        if (json.has(name_of(task)) && !used)
            json.fail(name_of(task), "settings", "none: no condition has the task " + files::shown(name_of(task)));
        if (!json.has(name_of(task)) && used)
            json.fail(name_of(task), "nothing", "the settings of the task that a condition names");
    }
    const bool mixed = any_task(protocol, TaskKind::find) || any_task(protocol, TaskKind::staircase);
    if (protocol.choice.alternate_conditions && mixed)
        json.fail("choice.alternate_conditions", "true", "trial_order instead, since there are other tasks too");
    const auto stays = protocol.choice.reference_on;
    if (stays && task_of(protocol, *stays) != TaskKind::choice)
        json.fail("choice.reference_on", files::shown(protocol.conditions[*stays].id),
                  "a condition with the task choice");
    if (protocol.choice.alternate_conditions && json.has("trial_order"))
        json.fail("trial_order", "a value", "none beside choice.alternate_conditions, which says it");
}

void check_find_keys(const files::JsonReader& json, const Protocol& protocol) {
    const auto has_scene = [](const Condition& one) { return !one.scene.empty(); };
    const bool any_scene = std::any_of(protocol.conditions.begin(), protocol.conditions.end(), has_scene);
    for (const char* key : {"turn_maps", "flip_maps"}) {
        if (!any_scene && json.has(key)) json.fail(key, "a value", "none: no condition has a scene");
    }
    if (any_task(protocol, TaskKind::find)) return;
    if (json.has("repeats"))
        json.fail("repeats", "a value", "none: choice.repeats and staircase.trials tell how many pairs there are");
    if (json.has("nodule_count_told")) json.fail("nodule_count_told", "a value", "none: nothing is to be found");
    if (any_scene) return;
    if (json.has("time_limit_s")) json.fail("time_limit_s", "a value", "none: no condition has a scene");
    if (protocol.practice_limit_s > 0.0)
        json.fail("practice.time_limit_s", "a value", "none: no condition has a scene");
}

void check_groups(const files::JsonReader& json, const Protocol& protocol) {
    if (json.has("assignment") && protocol.groups.size() < 2)
        json.fail("assignment", "a value", "none: there is one group");
    if (json.has("people_per_block") && protocol.assignment != Assignment::random)
        json.fail("people_per_block", "a value", "none: only random assignment has blocks");
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const auto has = [&](const Group& group) {
            return std::count(group.conditions.begin(), group.conditions.end(), i) > 0;
        };
        if (std::none_of(protocol.groups.begin(), protocol.groups.end(), has))
            json.fail("groups", files::shown(protocol.conditions[i].id) + " in none of them",
                      "each condition in one group at least");
    }
}

// Answers to these two are kept by the program itself (study/withdrawal.h).
void check_items(const files::JsonReader& json, const char* key, const std::vector<Item>& items) {
    for (const Item& item : items) {
        if (item.id == "consent" || item.id == "withdrawal")
            json.fail(key, files::shown(item.id), "another id: the program asks for this one itself");
    }
}

}  // namespace

void refuse_ignored_keys(const files::JsonReader& json, const Protocol& protocol) {
    check_tasks(json, protocol);
    check_find_keys(json, protocol);
    check_groups(json, protocol);
    check_items(json, "demographics", protocol.demographics);
    check_items(json, "ratings", protocol.ratings);
}

void refuse_mixed_ratings(const Protocol& protocol) {
    const auto several = [](const Group& group) { return group.conditions.size() > 1; };
    const bool mixed = protocol.trial_order != TrialOrder::blocked &&
                       std::any_of(protocol.groups.begin(), protocol.groups.end(), several);
    if (protocol.ratings.empty() || !mixed) return;
    throw files::bad_input(protocol.file.string(), "ratings", "ratings of conditions whose trials are mixed", "none");
}

}  // namespace palpa::study
