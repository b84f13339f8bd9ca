#include "study/check_logs.h"

#include <algorithm>
#include <cmath>

#include "files/input_error.h"
#include "files/text.h"
#include "study/withdrawal.h"

namespace palpa::study {
namespace {

const Item* item_of(const Protocol& protocol, const Rating& answer) {
    const bool before = answer.condition == "n/a";
    const auto is_it = [&](const Condition& one) { return one.id == answer.condition; };
    if (!before && std::none_of(protocol.conditions.begin(), protocol.conditions.end(), is_it)) return nullptr;
    const std::vector<Item>& items = before ? protocol.demographics : protocol.ratings;
    const auto it = std::find_if(items.begin(), items.end(), [&](const Item& one) { return one.id == answer.item; });
    return it == items.end() ? nullptr : &*it;
}

bool offers(const Item& item, const std::string& answer) {
    if (answer == "n/a") return true;
    if (item.from) return is_step_of(item, answer);
    const auto is_it = [&](const std::string& choice) { return answer_text(choice) == answer; };
    return item.choices.empty() || std::any_of(item.choices.begin(), item.choices.end(), is_it);
}

std::string question_of(const Rating& answer) {
    return files::shown(answer.item) + (answer.condition == "n/a" ? "" : " under " + files::shown(answer.condition));
}

std::string ids_of(const std::vector<RunSettings::Nodule>& nodules) {
    std::vector<std::string> ids;
    for (const RunSettings::Nodule& nodule : nodules) ids.push_back(nodule.id);
    std::sort(ids.begin(), ids.end());
    std::string out;
    for (const std::string& id : ids) out += (out.empty() ? "" : ", ") + id;
    return ids.empty() ? "none" : out;
}

}  // namespace

std::vector<Rating> answers_to_questions(const Protocol* protocol, const std::string& code,
                                         const std::vector<Rating>& all, std::vector<std::string>& notes) {
    std::vector<Rating> out;
    std::map<std::pair<std::string, std::string>, std::size_t> place;
    for (const Rating& answer : all) {
        if (tells_participation(answer)) continue;
        const Item* item = protocol == nullptr ? nullptr : item_of(*protocol, answer);
        if (protocol != nullptr && (item == nullptr || !offers(*item, answer.value))) {
            notes.push_back("sub-" + code + ": the answer " + files::shown(answer.value) + " to " +
                            question_of(answer) + " is left out: the protocol has no such " +
                            (item == nullptr ? "question" : "answer"));
            continue;
        }
        const auto [it, fresh] = place.emplace(std::pair(answer.condition, answer.item), out.size());
        const bool chosen = item != nullptr && !item->choices.empty();
        if (fresh) {
            out.push_back(answer);
            out.back().chosen = chosen;
            continue;
        }
        notes.push_back("sub-" + code + ": " + question_of(answer) + " is answered more than once, " +
                        files::shown(out[it->second].value) + " and then " + files::shown(answer.value) +
                        ": the last answer counts");
        out[it->second] = answer;
        out[it->second].chosen = chosen;
    }
    return out;
}

void check_pair(const Protocol& protocol, const std::string& place, const RunLog::Choice& choice, Logged& logged) {
    const auto condition = static_cast<std::size_t>(logged.condition);
    if (!compares(task_of(protocol, condition))) {
        throw files::bad_input(place, "condition", files::shown(choice.condition),
                               "a condition in which two surfaces are compared, by the protocol");
    }
    if (choice.reference_kPa != reference_kPa_of(protocol, condition)) {
        throw files::bad_input(place, "reference_kPa", files::short_number(choice.reference_kPa),
                               files::short_number(reference_kPa_of(protocol, condition)) + " as in the protocol");
    }
    const auto& all = comparisons_kPa_of(protocol, condition);
    const auto it = std::find(all.begin(), all.end(), choice.comparison_kPa);
    if (it == all.end()) {
        throw files::bad_input(place, "comparison_kPa", files::shown(choice.comparison),
                               "one of the protocol's comparisons");
    }
    const auto on = reference_condition_of(protocol, condition);
    const std::string stays = on ? protocol.conditions[*on].id : "";
    if (choice.reference_on != stays) {
        throw files::bad_input(place, "reference_on",
                               choice.reference_on.empty() ? "n/a" : files::shown(choice.reference_on),
                               (stays.empty() ? "n/a" : files::shown(stays)) + " as in the protocol");
    }
    logged.comparison = static_cast<int>(it - all.begin());
    logged.reference_first = choice.reference_first;
}

void check_group(const std::filesystem::path& directory, const std::string& code, const std::string& told,
                 const std::string& planned) {
    if (told == planned) return;
    throw files::bad_input((directory / "participants.tsv").string(), "sub-" + code + ", group", files::shown(told),
                           files::shown(planned) + ", as this participant's logs and the plan say");
}

void check_exclusions(const std::filesystem::path& directory, const std::set<std::string>& left_out,
                      const std::set<std::pair<std::string, int>>& left_out_trials, const std::set<std::string>& codes,
                      const std::set<std::pair<std::string, int>>& finished) {
    const std::string file = (directory / "exclusions.tsv").string();
    for (const std::string& code : left_out) {
        if (codes.count(code) == 0)
            throw files::bad_input(file, "participant", files::shown(code), "a participant of this study");
    }
    for (const auto& [code, trial] : left_out_trials) {
        if (finished.count({code, trial}) > 0) continue;
        throw files::bad_input(file, "trial", std::to_string(trial) + " of " + files::shown(code),
                               "a trial that this participant has finished");
    }
}

void NodulesOfConditions::compare(const std::string& condition, const std::string& settings_file,
                                  const std::vector<RunSettings::Nodule>& nodules, std::vector<std::string>& notes) {
    const std::string ids = ids_of(nodules);
    const First& first = first_.emplace(condition, First{ids, settings_file}).first->second;
    if (first.nodules == ids) return;
    notes.push_back(settings_file + ": the nodules are " + ids + ", but " + first.nodules + " in " + first.file +
                    ", of the same condition");
}

}  // namespace palpa::study
