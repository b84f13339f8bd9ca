#include "study/protocol.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "files/input_error.h"
#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/names.h"
#include "study/protocol_checks.h"

namespace palpa::study {
namespace {

constexpr const char* kModalities[] = {"touchpad", "pen", "finger", "mouse", "tangible", "shape-display", "hand"};
constexpr const char* kOrders[] = {"fixed", "random", "latin", "williams"};
constexpr const char* kTasks[] = {"find", "choice", "staircase"};
constexpr const char* kTrialOrders[] = {"blocked", "interleaved", "shuffled"};
constexpr const char* kMethods[] = {"weighted-up-down", "quest-plus"};

std::string new_id(files::JsonReader& json, std::set<std::string>& known) {
    const std::string id = json.text("id");
    if (!is_name(id)) json.fail("id", files::shown(id), kNameRule);
    if (names_a_sum(id)) json.fail("id", files::shown(id), kSumRule);
    if (!known.insert(id).second) json.fail("id", files::shown(id) + " a second time", "each name once");
    return id;
}

std::vector<std::string> read_names(files::JsonReader& json, std::string_view key) {
    std::vector<std::string> names;
    const files::Json& list = json.any(key);
    if (!list.is_array() || list.empty()) json.fail(key, files::described(list), "an array of names");
    for (const files::Json& entry : list) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : "";
        if (!is_name(name)) json.fail(key, files::described(entry), kNameRule);
        if (std::count(names.begin(), names.end(), name) > 0)
            json.fail(key, files::shown(name) + " a second time", "each name once");
        names.push_back(name);
    }
    return names;
}

Condition read_condition(files::JsonReader json, TaskKind task, std::set<std::string>& known) {
    json.only({"id", "title", "modality", "task", "scene", "profile", "device", "instructions", "nodules", "cast_of"});
    Condition condition;
    condition.id = new_id(json, known);
    condition.title = json.text("title", condition.id);
    condition.modality = static_cast<Modality>(
        json.choice("modality", {"touchpad", "pen", "finger", "mouse", "tangible", "shape-display", "hand"}));
    if (json.has("task")) task = static_cast<TaskKind>(json.choice("task", {"find", "choice", "staircase"}));
    condition.task = task;
    condition.scene = json.text("scene", "");
    condition.profile = json.text("profile", "");
    condition.device = json.text("device", "n/a");
    if (condition.device != "n/a" && !is_name(condition.device))
        json.fail("device", files::shown(condition.device), kNameRule);
    condition.instructions = json.text("instructions", "");
    if (json.has("nodules")) condition.nodules = read_names(json, "nodules");
    if (json.has("cast_of")) json.text("cast_of");  // read_cast() knows the other conditions
    const bool by_hand = condition.modality == Modality::hand;
    condition.typed_in = by_hand;
    if (by_hand && !condition.scene.empty())
        json.fail("scene", files::shown(condition.scene), "none: a real phantom has no scene");
    if (!by_hand && condition.scene.empty() && task == TaskKind::find) json.fail("scene", "nothing", "a scene file");
    if (!by_hand && !condition.nodules.empty()) json.fail("nodules", "names", "none: a scene knows its nodules");
    if (compares(task) && !condition.nodules.empty())
        json.fail("nodules", "names", "none: two surfaces are compared, and nothing is to be found");
    if (condition.scene.empty() && !condition.profile.empty())
        json.fail("profile", files::shown(condition.profile), "none: there is no scene whose profile it could replace");
    json.finish();
    return condition;
}

Group read_group(files::JsonReader json, const std::vector<Condition>& conditions, std::set<std::string>& known) {
    json.only({"id", "conditions"});
    Group group;
    group.id = new_id(json, known);
    const files::Json& list = json.any("conditions");
    if (!list.is_array() || list.empty())
        json.fail("conditions", files::described(list), "an array of conditions' ids");
    for (const files::Json& entry : list) {
        const auto same = [&](const Condition& one) {
            return entry.is_string() && one.id == entry.get_ref<const std::string&>();
        };
        const auto it = std::find_if(conditions.begin(), conditions.end(), same);
        if (it == conditions.end())
            json.fail("conditions", files::described(entry), "the id of a condition of this protocol");
        const auto index = static_cast<std::size_t>(it - conditions.begin());
        if (std::count(group.conditions.begin(), group.conditions.end(), index) > 0) {
            json.fail("conditions", files::described(entry) + " a second time", "each condition once (use repeats)");
        }
        group.conditions.push_back(index);
    }
    json.finish();
    return group;
}

Item read_item(files::JsonReader json, std::set<std::string>& known) {
    json.only({"id", "text", "from", "to", "low", "high", "choices"});
    Item item;
    item.id = new_id(json, known);
    item.text = json.text("text");
    if (json.has("from") || json.has("to")) {
        item.from = json.integer("from", -100, 100);
        item.to = json.integer("to", *item.from + 1, 100);
    }
    for (const char* end : {"low", "high"}) {
        if (!json.has(end)) continue;
        if (!item.from) json.fail(end, "no scale", "it beside from and to");
        (end[0] == 'l' ? item.low : item.high) = json.text(end);
    }
    if (json.has("choices")) {
        if (item.from) json.fail("choices", "a scale too", "either choices or from and to");
        for (const std::string& text : json.texts("choices", 2, "texts")) {
            if (std::find(item.choices.begin(), item.choices.end(), text) != item.choices.end())
                json.fail("choices", "'" + text + "' a second time", "each text once");
            item.choices.push_back(text);
        }
    }
    json.finish();
    return item;
}

std::vector<Item> read_items(files::JsonReader& json, std::string_view key) {
    std::vector<Item> items;
    std::set<std::string> known;
    for (files::JsonReader& item : json.objects(key)) items.push_back(read_item(item, known));
    return items;
}

// Of a condition by hand: `conditions` are read already.
void read_cast(files::JsonReader& json, std::size_t index, std::vector<Condition>& conditions) {
    if (!json.has("cast_of")) return;
    Condition& cast = conditions[index];
    if (cast.modality != Modality::hand) json.fail("cast_of", "a value", "none: only a phantom felt by hand is a cast");
    if (compares(*cast.task))
        json.fail("cast_of", "a value", "none: two surfaces are compared, and nothing is to be found");
    if (!cast.nodules.empty()) json.fail("nodules", "names", "none beside cast_of, whose scene knows them");
    const std::string id = json.text("cast_of");
    const auto it = std::find_if(conditions.begin(), conditions.end(), [&](const auto& one) { return one.id == id; });
    if (it == conditions.end() || it->scene.empty())
        json.fail("cast_of", files::shown(id), "the id of a condition of this protocol that has a scene");
    cast.cast_of = static_cast<std::size_t>(it - conditions.begin());
}

// `conditions` are read already.
ChoiceTask read_choice(files::JsonReader json, const std::vector<Condition>& conditions) {
    json.only({"reference_kPa", "comparisons_kPa", "repeats", "alternate_conditions", "reference_on"});
    ChoiceTask task;
    task.reference_kPa = json.number("reference_kPa", {0.0, 1e6, true});
    task.comparisons_kPa = json.numbers("comparisons_kPa", 0, {0.0, 1e6, true});
    for (const double comparison : task.comparisons_kPa) {
        if (comparison == task.reference_kPa)
            json.fail("comparisons_kPa", files::short_number(comparison), "values unlike the reference");
    }
    task.repeats = json.integer("repeats", 1, 1000, task.repeats);
    task.alternate_conditions = json.boolean("alternate_conditions", false);
    if (json.has("reference_on")) {
        const std::string id = json.text("reference_on");
        const auto it =
            std::find_if(conditions.begin(), conditions.end(), [&](const auto& one) { return one.id == id; });
        if (it == conditions.end())
            json.fail("reference_on", files::shown(id), "the id of a condition of this protocol");
        task.reference_on = static_cast<std::size_t>(it - conditions.begin());
    }
    json.finish();
    return task;
}

StaircaseTask read_staircase(files::JsonReader json) {
    json.only({"method", "reference_kPa", "comparisons_kPa", "trials", "steps_after_wrong", "start_kPa"});
    StaircaseTask task;
    task.method = static_cast<StaircaseMethod>(json.choice("method", {"weighted-up-down", "quest-plus"}));
    task.reference_kPa = json.number("reference_kPa", {0.0, 1e6, true});
    std::vector<double>& levels = task.comparisons_kPa = json.numbers("comparisons_kPa", 0, {0.0, 1e6, true});
    const auto unlike = [&](double kPa) { return std::abs(std::log(kPa / task.reference_kPa)); };
    std::sort(levels.begin(), levels.end(), [&](double a, double b) { return unlike(a) < unlike(b); });
    task.trials = json.integer("trials", 1, 1000, task.trials);
    const bool one_side = std::all_of(levels.begin(), levels.end(), [&](double kPa) {
        return (kPa > task.reference_kPa) == (levels.front() > task.reference_kPa);
    });
    if (levels.size() < 3) json.fail("comparisons_kPa", std::to_string(levels.size()) + " levels", "three or more");
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (levels[i] == task.reference_kPa)
            json.fail("comparisons_kPa", files::short_number(levels[i]), "values unlike the reference");
        if (std::count(levels.begin(), levels.end(), levels[i]) > 1)
            json.fail("comparisons_kPa", files::short_number(levels[i]) + " a second time", "each level once");
    }
    task.start = static_cast<int>(levels.size()) - 1;
    if (task.method == StaircaseMethod::quest_plus) {
        for (const char* key : {"steps_after_wrong", "start_kPa"}) {
            if (json.has(key)) json.fail(key, "a value", "none: QUEST+ needs none");
        }
        json.finish();
        return task;
    }
    if (!one_side)
        json.fail("comparisons_kPa", "levels on both sides of the reference",
                  "all of them stiffer, or all of them softer: weighted up-down moves along one side");
    task.steps_after_wrong = json.integer("steps_after_wrong", 1, 20, task.steps_after_wrong);
    if (json.has("start_kPa")) {
        const auto at = std::find(levels.begin(), levels.end(), json.number("start_kPa", {0.0, 1e6, true}));
        if (at == levels.end()) json.fail("start_kPa", "another value", "one of comparisons_kPa");
        task.start = static_cast<int>(at - levels.begin());
    }
    json.finish();
    return task;
}

void read_practice(files::JsonReader json, Protocol& protocol) {
    json.only({"trials", "time_limit_s"});
    protocol.practice_trials = json.integer("trials", 0, 100);
    protocol.practice_limit_s = json.number("time_limit_s", {0.0, 86400.0}, 0.0);
    if (protocol.practice_limit_s > 0.0 && protocol.practice_trials == 0)
        json.fail("time_limit_s", "a value", "none: there are no practice trials");
    json.finish();
}

// Without words nobody can agree, so a text of nothing is a slip and not a study without consent.
std::string read_consent(files::JsonReader& json) {
    std::string text = json.text("consent");
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
        json.fail("consent", files::shown(text), "the text that a participant agrees to, or no such key");
    return text;
}

void read_analysis(files::JsonReader json, Protocol& protocol) {
    json.only({"primary", "participants", "stopping_rule"});
    if (auto primary = json.optional_object("primary")) protocol.primary = read_primary(*primary, protocol);
    protocol.planned_participants = json.integer("participants", 1, 100000, 0);
    protocol.stopping_rule = json.text("stopping_rule", "");
    json.finish();
}

std::vector<std::string> read_texts(files::JsonReader& json, const char* key) {
    if (!json.has(key)) return {};
    const std::vector<std::string> texts = json.texts(key, 1, "texts");
    if (std::find(texts.begin(), texts.end(), "") != texts.end()) json.fail(key, "an empty text", "an array of texts");
    return texts;
}

DatasetAbout read_about(files::JsonReader json) {
    json.only({"authors", "license", "funding", "ethics_approvals", "registration"});
    DatasetAbout about;
    about.authors = read_texts(json, "authors");
    about.funding = read_texts(json, "funding");
    about.ethics_approvals = read_texts(json, "ethics_approvals");
    about.license = json.text("license", "");
    about.registration = json.text("registration", "");
    json.finish();
    return about;
}

}  // namespace

std::string practice_comes(const Protocol& protocol) {
    return protocol.trial_order == TrialOrder::blocked ? "before each condition" : "of each condition before all tests";
}

Protocol read_protocol(const std::filesystem::path& file) {
    Protocol protocol;
    protocol.file = file;
    protocol.text = files::read_text(file, 1 << 24);
    protocol.sha256 = files::sha256_hex(protocol.text);
    const files::Json root = files::parse_json(protocol.text, file.string());
    files::JsonReader json(root, file.string());
    json.only({"name",
               "version",
               "seed",
               "choice",
               "staircase",
               "conditions",
               "groups",
               "assignment",
               "people_per_block",
               "order",
               "trial_order",
               "repeats",
               "turn_maps",
               "flip_maps",
               "time_limit_s",
               "practice",
               "break_every_trials",
               "nodule_count_told",
               "consent",
               "instructions",
               "demographics",
               "ratings",
               "analysis",
               "dataset"});
    protocol.name = json.text("name");
    protocol.version = json.text("version");
    protocol.seed = static_cast<std::uint32_t>(json.integer("seed", 0, 2000000000));
    if (auto staircase = json.optional_object("staircase")) {
        protocol.task = TaskKind::staircase;
        protocol.staircase = read_staircase(*staircase);
    }
    if (json.has("choice")) protocol.task = TaskKind::choice;
    std::set<std::string> conditions, groups;
    std::vector<files::JsonReader> entries = json.objects("conditions");
    for (files::JsonReader& entry : entries)
        protocol.conditions.push_back(read_condition(entry, protocol.task, conditions));
    for (std::size_t i = 0; i < entries.size(); ++i) read_cast(entries[i], i, protocol.conditions);
    if (protocol.conditions.empty()) json.fail("conditions", "nothing", "one condition at least");
    if (auto choice = json.optional_object("choice")) protocol.choice = read_choice(*choice, protocol.conditions);
    for (files::JsonReader& entry : json.objects("groups"))
        protocol.groups.push_back(read_group(entry, protocol.conditions, groups));
    if (protocol.groups.empty()) {
        protocol.groups.push_back({"all", {}});
        for (std::size_t i = 0; i < protocol.conditions.size(); ++i) protocol.groups[0].conditions.push_back(i);
    }
    if (json.has("assignment"))
        protocol.assignment = static_cast<Assignment>(json.choice("assignment", {"alternate", "random"}));
    protocol.people_per_block = json.integer("people_per_block", 2, 100, protocol.people_per_block);
    protocol.order = static_cast<OrderKind>(json.choice("order", {"fixed", "random", "latin", "williams"}));
    if (json.has("trial_order"))
        protocol.trial_order =
            static_cast<TrialOrder>(json.choice("trial_order", {"blocked", "interleaved", "shuffled"}));
    else if (protocol.choice.alternate_conditions)  // says the same
        protocol.trial_order = TrialOrder::interleaved;
    protocol.repeats = json.integer("repeats", 1, 1000, 1);
    protocol.turn_maps = json.boolean("turn_maps", true);
    protocol.flip_maps = json.boolean("flip_maps", false);
    protocol.time_limit_s = json.number("time_limit_s", {0.0, 86400.0}, 0.0);
    if (auto practice = json.optional_object("practice")) read_practice(*practice, protocol);
    protocol.break_every_trials = json.integer("break_every_trials", 0, 10000, 0);
    protocol.count_told = json.boolean("nodule_count_told", false);
    if (json.has("consent")) protocol.consent = read_consent(json);
    protocol.instructions = json.text("instructions", "");
    protocol.demographics = read_items(json, "demographics");
    protocol.ratings = read_items(json, "ratings");
    if (auto analysis = json.optional_object("analysis")) read_analysis(*analysis, protocol);
    if (auto about = json.optional_object("dataset")) protocol.about = read_about(*about);
    refuse_ignored_keys(json, protocol);
    json.finish();
    return protocol;
}

const char* name_of(Modality modality) { return kModalities[static_cast<int>(modality)]; }
const char* name_of(OrderKind order) { return kOrders[static_cast<int>(order)]; }
const char* name_of(TaskKind task) { return kTasks[static_cast<int>(task)]; }
const char* name_of(TrialOrder order) { return kTrialOrders[static_cast<int>(order)]; }
const char* name_of(StaircaseMethod method) { return kMethods[static_cast<int>(method)]; }

TaskKind task_of(const Protocol& protocol, std::size_t condition) {
    return protocol.conditions[condition].task.value_or(protocol.task);
}

bool is_step_of(const Item& scale, const std::string& answer) {
    double value = 0.0;
    return files::parse_number(answer, value) && value >= *scale.from && value <= *scale.to &&
           value == std::trunc(value);
}

bool compares(TaskKind task) { return task != TaskKind::find; }

std::optional<std::size_t> reference_condition_of(const Protocol& protocol, std::size_t condition) {
    return task_of(protocol, condition) == TaskKind::choice ? protocol.choice.reference_on : std::nullopt;
}

double reference_kPa_of(const Protocol& protocol, std::size_t condition) {
    return task_of(protocol, condition) == TaskKind::staircase ? protocol.staircase.reference_kPa
                                                               : protocol.choice.reference_kPa;
}

const std::vector<double>& comparisons_kPa_of(const Protocol& protocol, std::size_t condition) {
    return task_of(protocol, condition) == TaskKind::staircase ? protocol.staircase.comparisons_kPa
                                                               : protocol.choice.comparisons_kPa;
}

}  // namespace palpa::study
