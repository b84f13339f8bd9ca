// palpa study order PROTOCOL.json --participants N

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "app/study/study_scenes.h"
#include "files/json.h"
#include "files/text.h"
#include "study/order_balance.h"
#include "study/protocol_checks.h"

namespace palpa::app {
namespace {

struct OrderOptions {
    std::string protocol;
    int participants = 0;
    bool json = false;
};

double comparison_kPa(const study::Protocol& protocol, const study::PlannedTrial& trial) {
    return study::comparisons_kPa_of(protocol, trial.condition)[static_cast<std::size_t>(trial.comparison)];
}

files::Json trial_json(const study::Protocol& protocol, const study::PlannedTrial& trial) {
    files::Json json{{"trial", trial.trial},
                     {"block", trial.practice ? "practice" : "test"},
                     {"condition", protocol.conditions[trial.condition].id},
                     {"repeat", trial.repeat + 1}};
    const study::TaskKind task = study::task_of(protocol, trial.condition);
    json["task"] = name_of(task);
    if (!protocol.conditions[trial.condition].scene.empty()) {  // others show no tissue that could be turned
        json["map_rotation_deg"] = trial.rotate_deg;
        json["map_flip"] = trial.flip;
    }
    if (compares(task)) {
        json["comparison_kPa"] = nullptr;  // follows from the answers
        if (trial.comparison >= 0) json["comparison_kPa"] = comparison_kPa(protocol, trial);
        json["reference_first"] = trial.reference_first;
    }
    json["seed"] = trial.seed;
    json["break_before"] = trial.break_before;
    return json;
}

files::Json order_json(const study::Protocol& protocol, const std::vector<study::PlannedParticipant>& people) {
    files::Json json{{"protocol", protocol.name},
                     {"version", protocol.version},
                     {"sha256", protocol.sha256},
                     {"seed", protocol.seed},
                     {"order", name_of(protocol.order)},
                     {"task", name_of(protocol.task)},
                     {"trial_order", name_of(protocol.trial_order)}};
    if (protocol.choice.reference_on) json["reference_on"] = protocol.conditions[*protocol.choice.reference_on].id;
    json["participants"] = files::Json::array();
    for (const study::PlannedParticipant& who : people) {
        files::Json trials = files::Json::array();
        for (const study::PlannedTrial& trial : who.trials) trials.push_back(trial_json(protocol, trial));
        json["participants"].push_back({{"number", who.number},
                                        {"group", protocol.groups[who.group].id},
                                        {"order_id", who.order_id},
                                        {"trials", trials}});
    }
    json["imbalance"] = files::Json::array();
    for (const study::Imbalance& one : study::imbalance_of(protocol, people)) {
        json["imbalance"].push_back({{"group", one.group},
                                     {"participants", one.participants},
                                     {"position", one.position},
                                     {"carry_over", one.carry_over},
                                     {"turns", one.turns},
                                     {"full_rounds_of", one.full_rounds_of}});
    }
    return json;
}

void print_trial(const study::Protocol& protocol, const study::PlannedTrial& trial) {
    const std::string& condition = protocol.conditions[trial.condition].id;
    std::printf("%s  %3d  %-8s  %-20s", trial.break_before ? "  -- break --\n" : "", trial.trial,
                trial.practice ? "practice" : "test", condition.c_str());
    if (compares(study::task_of(protocol, trial.condition))) {
        const std::string level = trial.comparison < 0 ? "level by the answers"
                                                       : files::short_number(comparison_kPa(protocol, trial)) + " kPa";
        std::printf("  %s, reference %s\n", level.c_str(), trial.reference_first ? "first" : "second");
        return;
    }
    if (protocol.conditions[trial.condition].scene.empty())
        std::printf("\n");
    else
        std::printf("  turned %3d deg%s\n", trial.rotate_deg, trial.flip ? ", flipped" : "");
}

void print_imbalance(const study::Protocol& protocol, const std::vector<study::PlannedParticipant>& people) {
    for (const study::Imbalance& one : study::imbalance_of(protocol, people)) {
        std::printf("group %s, %d people: positions differ by %d, carry-over by %d, views by %d", one.group.c_str(),
                    one.participants, one.position, one.carry_over, one.turns);
        if (one.participants % one.full_rounds_of != 0) {
            std::printf("; a multiple of %d people would balance the positions", one.full_rounds_of);
        }
        std::printf("\n");
    }
}

void print_order(const OrderOptions& options) {
    const study::Protocol protocol = study::read_protocol(options.protocol);
    study::refuse_mixed_ratings(protocol);
    load_study_scenes(protocol);  // finds a missing map now rather than during the study
    std::vector<study::PlannedParticipant> people;
    for (int number = 1; number <= options.participants; ++number)
        people.push_back(study::plan_participant(protocol, number));
    if (options.json) {
        std::fputs(files::json_text(order_json(protocol, people)).c_str(), stdout);
        return;
    }
    std::printf("%s, version %s, seed %u, order %s\n", protocol.name.c_str(), protocol.version.c_str(), protocol.seed,
                name_of(protocol.order));
    for (const study::PlannedParticipant& who : people) {
        std::printf("participant %d, group %s, order %d\n", who.number, protocol.groups[who.group].id.c_str(),
                    who.order_id);
        for (const study::PlannedTrial& trial : who.trials) print_trial(protocol, trial);
    }
    print_imbalance(protocol, people);
}

}  // namespace

void add_study_order(CLI::App& study) {
    auto options = std::make_shared<OrderOptions>();
    CLI::App* command = study.add_subcommand(
        "order", "Show each participant's conditions and their order, and how balanced the orders are");
    command->add_option("PROTOCOL", options->protocol, "protocol JSON, or the name of a shipped one")
        ->required()
        ->transform(protocol_or_name());
    command->add_option("--participants", options->participants, "number of participants")
        ->required()
        ->check(CLI::Range(1, 100000));
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { print_order(*options); });
}

}  // namespace palpa::app
