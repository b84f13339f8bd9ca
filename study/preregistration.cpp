#include "study/preregistration.h"

#include <algorithm>

#include "files/text.h"
#include "study/comparisons.h"
#include "study/order_balance.h"
#include "study/protocol_checks.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

constexpr int kMostListed = 1000;

std::string sheet_row(const std::string& what, const std::string& value) {
    return "| " + what + " | " + markdown_cell(value) + " |\n";
}

std::string sheet_value(const std::string& value) { return value.empty() ? "NOT STATED" : value; }

std::string sheet_list(const std::vector<std::string>& items) {
    std::string out;
    for (const std::string& item : items) out += (out.empty() ? "" : "; ") + item;
    return out;
}

std::string sheet_limit(double limit_s) { return limit_s > 0.0 ? files::short_number(limit_s) + " s" : "none"; }

bool any_pairs(const Protocol& protocol, bool pairs) {
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        if (compares(task_of(protocol, i)) == pairs) return true;
    }
    return false;
}

// The test of free-response figures (obuchowski_rockette.h) takes those who judge several cases under every condition.
std::string free_response_test(const Protocol& protocol) {
    std::vector<std::size_t> searched;
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        if (!compares(task_of(protocol, i)) && !protocol.conditions[i].typed_in) searched.push_back(i);
    }
    const auto crosses = [&](const Group& group) {
        return std::all_of(searched.begin(), searched.end(), [&](std::size_t i) {
            return std::find(group.conditions.begin(), group.conditions.end(), i) != group.conditions.end();
        });
    };
    if (searched.size() < 2) return "no test: it needs several conditions";
    if (protocol.repeats < 2) return "no test: it needs several trials of a person under each condition";
    if (!protocol.groups.empty() && std::none_of(protocol.groups.begin(), protocol.groups.end(), crosses))
        return "no test: it needs people who take part under every condition";
    return "people and cases random (Obuchowski and Rockette, jackknife)";
}

// Whom the primary comparison takes.
std::string who_counts(const Protocol& protocol) {
    if (!protocol.primary) return "all who finished a test";
    const PrimaryComparison& one = *protocol.primary;
    if (one.of_groups)
        return "all in " + one.sides[0] + " and " + one.sides[1] + " who finished a test under " + one.condition;
    const auto has = [&](const Group& group, const std::string& id) {
        return std::any_of(group.conditions.begin(), group.conditions.end(),
                           [&](std::size_t i) { return protocol.conditions[i].id == id; });
    };
    const bool same_people = std::any_of(protocol.groups.begin(), protocol.groups.end(), [&](const Group& group) {
        return has(group, one.sides[0]) && has(group, one.sides[1]);
    });
    return same_people ? "all who finished a test of both sides" : "all who finished a test of one of the sides";
}

bool any_scene(const Protocol& protocol) {
    return std::any_of(protocol.conditions.begin(), protocol.conditions.end(),
                       [](const Condition& one) { return !one.scene.empty(); });
}

std::string study_part(const Protocol& protocol, const SheetOptions& options) {
    const DatasetAbout& about = protocol.about;
    return "\n## Study\n\n| | |\n| --- | --- |\n" +
           sheet_row("name, version", protocol.name + ", " + protocol.version) +
           sheet_row("SHA-256 of the protocol", protocol.sha256) +
           sheet_row("seed of all draws", std::to_string(protocol.seed)) +
           sheet_row("program", options.program + ", orders of version " + std::to_string(kOrdersVersion)) +
           sheet_row("authors", sheet_value(sheet_list(about.authors))) +
           sheet_row("registration", about.registration.empty() ? "not registered before this sheet was made"
                                                                : sheet_value(about.registration)) +
           sheet_row("ethics approvals", sheet_value(sheet_list(about.ethics_approvals))) +
           sheet_row("funding", sheet_value(sheet_list(about.funding))) +
           sheet_row("license of the data", sheet_value(about.license));
}

std::string conditions_part(const Protocol& protocol, const SheetOptions& options) {
    std::string out =
        "\n## Conditions\n\n| condition | title | task | modality | scene | tests of each person | files (SHA-256) |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n";
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const Condition& one = protocol.conditions[i];
        std::string files;
        if (i < options.identities.size()) {
            for (const auto& [key, value] : options.identities[i].items())
                files += (files.empty() ? "" : ", ") + key + " " +
                         (value.is_string() ? value.get<std::string>() : value.dump());
        }
        out += "| " + markdown_cell(one.id) + " | " + markdown_cell(one.title) + " | " + name_of(task_of(protocol, i)) +
               " | " + name_of(one.modality) + " | " + (one.scene.empty() ? "none" : markdown_cell(one.scene)) + " | " +
               std::to_string(tests_of(protocol, i)) + " | " + (files.empty() ? "none" : markdown_cell(files)) + " |\n";
    }
    return out;
}

std::string groups_text(const Protocol& protocol) {
    std::string out;
    for (const Group& group : protocol.groups) {
        std::string ids;
        for (const std::size_t i : group.conditions) ids += (ids.empty() ? "" : ", ") + protocol.conditions[i].id;
        out += (out.empty() ? "" : "; ") + group.id + ": " + ids;
    }
    return out;
}

std::string design_part(const Protocol& protocol) {
    const bool random = protocol.assignment == Assignment::random;
    std::string out =
        "\n## Design\n\n| | |\n| --- | --- |\n" + sheet_row("groups and their conditions", groups_text(protocol));
    if (protocol.groups.size() > 1) {
        out += sheet_row("assignment", random ? "random, in shuffled blocks of " +
                                                    std::to_string(protocol.people_per_block) + " people of each group"
                                              : "in turn");
    }
    out +=
        sheet_row("order of conditions, of trials",
                  std::string(name_of(protocol.order)) + ", " + name_of(protocol.trial_order)) +
        sheet_row(
            any_pairs(protocol, true) ? "time limit of a test, of a pair for each surface" : "time limit of a test",
            sheet_limit(protocol.time_limit_s)) +
        sheet_row("practice", protocol.practice_trials == 0
                                  ? "none"
                                  : std::to_string(protocol.practice_trials) + " trials " + practice_comes(protocol) +
                                        ", time limit " + sheet_limit(protocol.practice_limit_s)) +
        sheet_row("break after",
                  protocol.break_every_trials > 0 ? std::to_string(protocol.break_every_trials) + " tests" : "no test");
    if (any_scene(protocol))
        out += sheet_row("views", std::string(protocol.turn_maps ? "maps in four quarter turns" : "maps never turned") +
                                      (protocol.flip_maps ? ", also mirrored" : ""));
    if (any_pairs(protocol, false)) {
        out += sheet_row("number of nodules told", protocol.count_told ? "yes" : "no");
    }
    out += sheet_row(
        "blinding",
        "no screen of a participant names a condition, or says during tests what was found or was correct; the "
        "analysis names conditions");
    return out;
}

std::string primary_text(const Protocol& protocol) {
    if (!protocol.primary) return "";
    const PrimaryComparison& one = *protocol.primary;
    const std::string sides = one.sides[0] + " - " + one.sides[1];
    const std::string who = one.of_groups
                                ? "groups " + sides + ", under " + one.condition
                                : "conditions " + sides + ", differences of the same people where they did both";
    const bool t = one.test == PrimaryTest::t;
    return std::string(name_of(one.quantity)) + ", " + who + "; two-sided " +
           (t ? one.quantity == Quantity::ppv
                    ? "t test over participants of the pooled ratios (standard error by the jackknife; Welch's degrees "
                      "of "
                      "freedom between groups)"
                    : "t test over participants (Student's of differences, Welch's between groups)"
              : "permutation test over participants (signs of differences, or groups)") +
           ", not corrected";
}

std::string analysis_part(const Protocol& protocol) {
    std::string out = "\n## Analysis\n\n| | |\n| --- | --- |\n" +
                      sheet_row("primary comparison", sheet_value(primary_text(protocol)));
    const bool compared = protocol.conditions.size() > 1 || protocol.groups.size() > 1;
    if (compared && (any_pairs(protocol, false) || any_task(protocol, TaskKind::choice)))
        out += sheet_row(
            "all other comparisons",
            std::string(protocol.primary ? "as the primary one" : "t and permutation tests over participants") +
                ", exploratory; p corrected by Holm " + kHolmFamilies +
                (protocol.groups.size() > 1 ? "; interactions of PPV are not tested" : ""));
    out += sheet_row("intervals", "95 %: t, Wilson where nobody counts twice, else bootstrap over participants");
    const auto searched = [&](bool by_hand) {
        for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
            if (!compares(task_of(protocol, i)) && protocol.conditions[i].typed_in == by_hand) return true;
        }
        return false;
    };
    if (searched(true))
        out += sheet_row("found nodules and false marks that are typed in", "as the experimenter types them in");
    if (searched(false)) {
        out += sheet_row(
                   "a mark is a hit",
                   "within the nodule's diameter or 8 mm of its axis, whichever is larger; as many nodules as possible "
                   "are found, each by one mark") +
               sheet_row("several marks on one nodule", "one hit; the highest confidence counts as its rating") +
               sheet_row("free response", "wAFROC1, since each condition has one tissue, where that has nodules; " +
                                              free_response_test(protocol));
    }
    if (any_pairs(protocol, false))
        out += sheet_row(
            "nodules as a sample",
            "mixed logistic model with people and nodules crossed, where there are several of both; likelihood-ratio "
            "test");
    if (any_task(protocol, TaskKind::choice))
        out += sheet_row("choices",
                         "share of right answers against one half; psychometric functions with lapses up to 0.05");
    if (any_task(protocol, TaskKind::staircase))
        out += sheet_row(
            "staircases",
            "threshold and JND of each person under each condition, 95 % credible interval; for groups "
            "psychometric functions with lapses up to 0.05; no share of right answers, which follows from the "
            "method");
    return out +
           sheet_row("participants who count",
                     who_counts(protocol) + "; dropouts replaced by `palpa study replace` are left out") +
           sheet_row(
               "trials that do not count",
               "interrupted ones, which are repeated; finished ones only by `palpa study exclude`, with a reason, "
               "listed in "
               "the report; those of participants who withdraw their data") +
           sheet_row("missing values", "nothing is filled in");
}

std::string sample_part(const Protocol& protocol) {
    const char* refused = any_task(protocol, TaskKind::staircase) ? "staircases" : nullptr;
    bool any = false;  // that is simulated in memory
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const bool choice = task_of(protocol, i) == TaskKind::choice, scene = !protocol.conditions[i].scene.empty();
        if (choice && scene && refused == nullptr) refused = "choices that are felt through a scene";
        any = any || choice || scene;
    }
    if (!any && refused == nullptr) refused = "conditions by hand only";
    if (protocol.planned_participants == 1) refused = "single participant";
    const std::string n = protocol.planned_participants > 0 ? std::to_string(protocol.planned_participants) : "";
    return "\n## Sample size\n\n| | |\n| --- | --- |\n" + sheet_row("planned participants", sheet_value(n)) +
           sheet_row("stopping rule", sheet_value(protocol.stopping_rule)) +
           sheet_row("power", refused != nullptr ? "`palpa study power` takes no " + std::string(refused) +
                                                       ": how the number was found is to be written here"
                                                 : "`palpa study power`, with its output beside this sheet");
}

// Tests in their order; equal ones in a row are counted.
std::string order_text(const Protocol& protocol, const PlannedParticipant& who) {
    std::string out;
    int times = 0;
    const PlannedTrial* last = nullptr;
    const auto close = [&] {
        if (last) out += (out.empty() ? "" : ", ") + protocol.conditions[last->condition].id;
        if (times > 1) out += " x " + std::to_string(times);
    };
    for (const PlannedTrial& trial : who.trials) {
        if (trial.practice) continue;
        if (last && last->condition == trial.condition) {
            ++times;
            continue;
        }
        close();
        last = &trial;
        times = 1;
    }
    close();
    return out;
}

int listed_people(const Protocol& protocol, const SheetOptions& options) {
    if (options.participants > 0) return options.participants;
    if (protocol.planned_participants > 0) return protocol.planned_participants;
    int round = 1;
    for (const Imbalance& one : imbalance_of(protocol, {plan_participant(protocol, 1)}))
        round = std::max(round, one.full_rounds_of);
    return round * static_cast<int>(protocol.groups.size());
}

std::string orders_part(const Protocol& protocol, const SheetOptions& options) {
    const int n = std::min(listed_people(protocol, options), kMostListed);
    std::string out =
        "\n## Orders\n\nThe tests of the first " + std::to_string(n) +
        " participants, practice left out; `palpa study order` gives all of them with views and seeds.\n\n"
        "| participant | group | order | tests |\n| --- | --- | --- | --- |\n";
    for (int number = 1; number <= n; ++number) {
        const PlannedParticipant who = plan_participant(protocol, number);
        out += "| " + std::to_string(number) + " | " + markdown_cell(protocol.groups[who.group].id) + " | " +
               std::to_string(who.order_id) + " | " + markdown_cell(order_text(protocol, who)) + " |\n";
    }
    return out;
}

}  // namespace

std::vector<std::string> missing_statements(const Protocol& protocol) {
    std::vector<std::string> out;
    const auto need = [&](bool there, const char* what) {
        if (!there) out.emplace_back(what);
    };
    need(protocol.primary.has_value(), "analysis.primary: the one comparison that is not corrected");
    need(protocol.planned_participants > 0, "analysis.participants: the planned number");
    need(!protocol.stopping_rule.empty(), "analysis.stopping_rule: when the study ends");
    need(!protocol.about.authors.empty(), "dataset.authors: who makes the study");
    need(!protocol.about.ethics_approvals.empty(), "dataset.ethics_approvals: committee and number");
    need(!protocol.about.funding.empty(), "dataset.funding: who pays for it");
    need(!protocol.about.license.empty(), "dataset.license: how the data may be used");
    return out;
}

std::string preregistration_sheet(const Protocol& protocol, const SheetOptions& options) {
    std::string out = "# Preregistration: " + markdown_cell(protocol.name) + "\n\nMade from the protocol by " +
                      options.program +
                      ". The protocol belongs beside this sheet; its SHA-256 says that it is the one.\n";
    const std::vector<std::string> missing = missing_statements(protocol);
    if (!missing.empty()) out += "\n**Not stated in the protocol:**\n\n";
    for (const std::string& one : missing) out += "- " + one + "\n";
    return out + study_part(protocol, options) + design_part(protocol) + conditions_part(protocol, options) +
           sample_part(protocol) + analysis_part(protocol) + orders_part(protocol, options);
}

}  // namespace palpa::study
