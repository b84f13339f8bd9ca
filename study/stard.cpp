#include "study/stard.h"

#include <algorithm>

#include "files/text.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

const std::string kToFillIn = "TO BE FILLED IN";

class StardForm {
  public:
    void section(const std::string& title) {
        text_ += "\n## " + title + "\n\n| item | what is asked | this study |\n| --- | --- | --- |\n";
    }
    void item(const std::string& number, const std::string& asked, const std::string& answer = kToFillIn) {
        text_ += "| " + number + " | " + asked + " | " + (answer.empty() ? kToFillIn : markdown_cell(answer)) + " |\n";
    }
    std::string text() const { return text_; }

  private:
    std::string text_;
};

std::string known_or_open(bool there, const std::string& text) { return there ? text : kToFillIn; }

std::string stard_list(const std::vector<std::string>& items) {
    std::string out;
    for (const std::string& item : items) out += (out.empty() ? "" : "; ") + item;
    return out;
}

// What a study's trials are.
struct StardTasks {
    bool on_screen = false;  // nodules searched for, marks judged by the program
    bool typed_in = false;   // nodules searched for, the answers typed in
    bool choices = false;    // two surfaces compared
};

StardTasks tasks_in(const Protocol* protocol) {
    StardTasks out;
    for (std::size_t i = 0; protocol && i < protocol->conditions.size(); ++i) {
        const bool pairs = compares(task_of(*protocol, i)), typed = protocol->conditions[i].typed_in;
        out.choices |= pairs;
        out.on_screen |= !pairs && !typed;
        out.typed_in |= !pairs && typed;
    }
    return out;
}

// What holds for each kind of trial that the study has; empty: not for this kind. Nothing is known without a protocol.
std::string by_task(const StardTasks& tasks, const std::string& on_screen, const std::string& typed_in,
                    const std::string& choices) {
    std::string out;
    const auto add = [&](bool there, const std::string& text) {
        if (there) out += (out.empty() ? "" : "; ") + text;
    };
    add(tasks.on_screen, on_screen);
    add(tasks.typed_in, "answers typed in: " + typed_in);
    add(tasks.choices, tasks.on_screen || tasks.typed_in ? "choices: " + choices : choices);
    return out;
}

bool only_choices(const Report& report) { return report.trials == 0 && report.forced_choices > 0; }

// Trials on the screen have files of settings, but no choices without a scene, or of simulated people.
bool has_settings(const Report& report, const Protocol* protocol) {
    bool out = false;
    for (std::size_t i = 0; protocol && i < protocol->conditions.size(); ++i) {
        const bool pairs = compares(task_of(*protocol, i));
        out |= !protocol->conditions[i].scene.empty() && !protocol->conditions[i].typed_in &&
               (!pairs || !report.simulated);
    }
    return out;
}

std::string index_tests(const Report& report, const Protocol* protocol) {
    if (!protocol) return "";
    std::string out;
    for (const Condition& one : protocol->conditions) {
        out += (out.empty() ? "" : "; ") + one.id + ": " + name_of(one.modality) +
               (one.scene.empty() ? "" : ", scene " + one.scene) + (one.device == kNone ? "" : ", " + one.device);
    }
    return "palpation under " + out +
           (has_settings(report, protocol) ? ". Settings of the trials on the screen are in the logs" : "");
}

std::string took_part(const Report& report) {
    if (report.participants + report.people_without == 0) return kToFillIn + " took part";  // counts without names
    const int began = report.participants + report.people_without;
    std::string out = whole(began) + " took part, " + whole(report.participants) + " are analysed";
    if (report.people_without_trial > 0)
        out = whole(began + report.people_without_trial) + " agreed or gave their code, " +
              whole(report.people_without_trial) + " of whom have no trial; " + out;
    return out;
}

std::string stard_flow(const Report& report, const Protocol* protocol) {
    if (!protocol) return took_part(report) + "; who left, and which tests were left out: " + kToFillIn;
    const int broken_off =
        report.people_without - report.withdrawn_people - report.excluded_people - report.replaced_people;
    const std::int64_t analysed = report.trials + report.forced_choices;
    std::string out = took_part(report) + " (" + whole(report.withdrawn_people) + " withdrew their data, " +
                      whole(report.excluded_people) + " left out by the experimenter, " +
                      whole(report.replaced_people) + " replaced, " + whole(broken_off) +
                      " without a finished test); " + whole(analysed + report.excluded_trials) +
                      " finished tests, of which " + whole(analysed) + " are analysed and " +
                      whole(report.excluded_trials) + " left out (" + whole(report.withdrawn_trials) +
                      " of them withdrawn); " + whole(report.interrupted_trials) + " interrupted";
    return out +
           (report.progress.empty() ? "" : "; by condition in plan.tsv, by participant in plan_participants.tsv") +
           ". Who was asked and refused: " + kToFillIn;
}

std::string stard_cross(const Report& report) {
    std::string out;
    for (const ConditionResult& one : report.conditions) {
        out += (out.empty() ? "" : "; ") + one.name + ": " + whole(one.tp) + " nodules found, " + whole(one.fn) +
               " missed, " + whole(one.fp) + " false marks";
    }
    const FreeResponseReport& rated = report.free_response;
    if (!rated.figures.empty())
        out += ". Cases: " + whole(rated.cases_with) + " with lesions, " + whole(rated.cases_without) + " without";
    return out;
}

std::string stard_precision(const Report& report) {
    std::string out;
    for (const ConditionResult& one : report.conditions) {
        if (!one.se) continue;
        const Interval ci = one.se->bootstrap.value_or(one.se->wilson);
        out += (out.empty() ? "" : "; ") + one.name + ": sensitivity " + share_text(one.se->x.p()) + " (" +
               share_text(ci.low) + " to " + share_text(ci.high) + ", " +
               (one.se->bootstrap ? "bootstrap over participants" : std::string("Wilson, ") + wilson_is(*one.se)) + ")";
    }
    const auto in_table = [&](bool there, const char* text) {
        if (there) out += (out.empty() ? "" : "; ") + std::string(text);
    };
    in_table(!report.choices.empty(), "choices: choices.tsv");
    if (!out.empty()) out += ", intervals at " + files::short_number(100.0 * report.options.bootstrap.level) + " %";
    in_table(!report.staircases.empty(), "staircases: staircases.tsv, credible intervals at 95 %");
    if (out.empty()) return out;
    if (!report.pairs.empty()) return out + "; comparisons in pairs.tsv";
    return report.choice_pairs.empty() ? out : out + "; comparisons in choice_pairs.tsv";
}

std::string stard_sample(const Report& report, const Protocol* protocol) {
    std::string out = took_part(report);
    if (protocol && protocol->planned_participants > 0)
        out += ", " + whole(protocol->planned_participants) + " were planned";
    if (protocol && !protocol->stopping_rule.empty()) out += ". Rule for stopping: " + protocol->stopping_rule;
    return out + ". How the number was chosen (`palpa study power`): " + kToFillIn;
}

void stard_methods(const Report& report, const Protocol* protocol, StardForm& form) {
    const StardTasks tasks = tasks_in(protocol);
    form.section("Methods");
    form.item("5", "data collection planned before or after tests and reference were done",
              known_or_open(protocol, "before: the protocol and its orders were fixed (SHA-256 in study.json)"));
    form.item("6", "who could take part");
    form.item("7", "how participants were found");
    form.item("8", "where and when (places, dates)",
              known_or_open(protocol,
                            "dates are in ..._performance.json of each trial on the screen, but of trials by hand and "
                            "of choices without a scene there are none; places: " +
                                kToFillIn));
    form.item("9", "consecutive, random or convenience series");
    form.item("10a", "index test, so that it can be repeated", index_tests(report, protocol));
    form.item("10b", "reference standard, so that it can be repeated",
              by_task(tasks,
                      "the nodules in the map of each trial's tissue (..._settings.json): placed ones are known by "
                      "construction, detected ones are those that a computation found in the map",
                      "the nodules of the phantom: " + kToFillIn,
                      "which of both surfaces is stiffer, known by construction"));
    form.item("11", "why this reference standard",
              by_task(tasks, "the places of placed nodules are known exactly; of detected ones: " + kToFillIn,
                      kToFillIn, "both stiffnesses are known; of real samples: " + kToFillIn));
    form.item("12a", "cut-offs of the index test, and whether fixed before",
              by_task(tasks,
                      "a mark within the nodule's diameter or 8 mm of its axis, whichever is larger, is a hit; "
                      "every mark counts, whatever its confidence; fixed by the program before the study",
                      "what the experimenter took for found: " + kToFillIn, "none: one of both surfaces is chosen"));
    form.item("12b", "cut-offs of the reference standard",
              by_task(tasks, "none of placed nodules: they are there or not", "none: a nodule is there or not",
                      "none: one surface is stiffer"));
    const std::string told =
        protocol && (tasks.on_screen || tasks.typed_in)
            ? std::string("; the number of nodules was ") + (protocol->count_told ? "told" : "not told")
            : "";
    form.item("13a", "what those who did the index test knew of the reference",
              known_or_open(protocol, "nothing during tests" + told));
    form.item("13b", "what those who judged the reference knew of the index test",
              by_task(tasks, "nobody judged it: hits are counted by the program",
                      "the experimenter, who judges and types: " + kToFillIn,
                      "nobody judged it: right answers are counted by the program"));
    form.item("14", "how accuracy was estimated and compared", "report.md, first paragraphs");
    form.item("15", "how indeterminate results were handled",
              by_task(tasks, "there are none: a mark is a hit, is on a nodule already found, or is false",
                      "the experimenter's decision: " + kToFillIn, "there are none: one of both is chosen"));
    form.item(
        "16", "how missing data were handled",
        "nothing was filled in; comparisons are of participants with both conditions, others are counted as left out");
    const bool mixed = !only_choices(report) && report.mixed.status.empty();
    const std::string spreads = mixed ? "spreads of people and nodules in the mixed model" : "";
    const std::string groups = report.groups.empty() ? "" : "groups compared in groups.tsv";
    form.item("17", "analyses of variability, planned or exploratory",
              spreads.empty() && groups.empty() ? "none"
                                                : groups + (groups.empty() || spreads.empty() ? "" : "; ") + spreads);
    form.item("18", "sample size and how it was chosen", stard_sample(report, protocol));
}

void stard_results(const Report& report, const Protocol* protocol, StardForm& form) {
    form.section("Results");
    form.item("19", "flow of participants, with a diagram", stard_flow(report, protocol));
    form.item(
        "20", "who they were",
        known_or_open(protocol, "participants.tsv, and ratings.tsv where questions were asked; summary: " + kToFillIn));
    form.item("21a", "how severe the target condition was",
              !protocol ? kToFillIn
              : only_choices(report)
                  ? "the levels that were compared are in the protocol; what else the samples were: " + kToFillIn
                  : "nodules.tsv names the nodules; sizes and depths: " + kToFillIn);
    form.item("21b", "what else was there in those without it");
    form.item("22", "time and events between test and reference",
              known_or_open(protocol, "none: the reference is part of the tissue"));
    form.item("23", "cross table of test and reference", stard_cross(report));
    form.item("24", "estimates with their precision", stard_precision(report));
    form.item("25", "harm from test or reference");
}

void stard_simulation(const Report& report, const Protocol* protocol, StardForm& form) {
    form.section("Simulation-based research (Cheng et al. 2016)");
    form.item("S1", "orientation of participants to the simulator",
              !protocol ? kToFillIn
                        : (protocol->practice_trials == 0
                               ? std::string("no practice")
                               : whole(protocol->practice_trials) + " practice trials " + practice_comes(*protocol)) +
                              "; instructions in protocol.json; what was said besides: " + kToFillIn);
    form.item("S2", "simulator: make, model, functions",
              known_or_open(protocol,
                            std::string("Palpa") +
                                (has_settings(report, protocol) ? "; devices in ..._settings.json of each trial" : "") +
                                "; screen and pen: " + kToFillIn));
    form.item("S3", "surroundings of the simulation");
    form.item("S4", "event: scenario, duration, what was given to participants",
              known_or_open(protocol && protocol->time_limit_s > 0.0,
                            "tests of at most " + files::short_number(protocol ? protocol->time_limit_s : 0.0) + " s" +
                                (tasks_in(protocol).choices ? ", of a pair for each surface" : "")));
    form.item("S5", "feedback and instruction",
              known_or_open(protocol, protocol && protocol->practice_trials > 0 ? "after practice only" : "none"));
    form.item("S6", "pilot");
    form.item("S7", "limits of the simulation against real palpation");
}

}  // namespace

std::string stard_checklist(const Report& report, const Protocol* protocol) {
    StardForm form;
    form.section("Title, abstract, introduction");
    form.item("1", "named as a study of accuracy, with its measure");
    form.item("2", "structured abstract");
    form.item("3", "background, intended use and role of the test");
    form.item("4", "aims and hypotheses",
              report.primary
                  ? "primary comparison: " + std::string(name_of(report.primary->stated.quantity)) + ", " +
                        report.primary->stated.sides[0] + " against " + report.primary->stated.sides[1] +
                        (report.primary->stated.of_groups ? ", under " + report.primary->stated.condition : "")
                  : kToFillIn);
    stard_methods(report, protocol, form);
    stard_results(report, protocol, form);
    form.section("Discussion and other information");
    form.item(
        "26", "limits: bias, uncertainty, how far results carry over",
        report.simulated ? "NO PERSON TOOK PART: simulated hands and eyes, fitted to no person's data" : kToFillIn);
    form.item("27", "what follows for practice");
    form.item("28", "registration", protocol ? protocol->about.registration : "");
    form.item("29", "where the protocol is", known_or_open(protocol, "protocol.json in the folder of the logs"));
    form.item("30", "funding and its role", protocol ? stard_list(protocol->about.funding) : "");
    stard_simulation(report, protocol, form);
    return std::string("# Checklist: STARD 2015") + (report.simulated ? " (SIMULATED participants)" : "") +
           "\n\nFilled in from protocol and logs as far as they know; the rest is marked " + kToFillIn +
           ". Items in our words; the statement is Bossuyt et al., BMJ 351 (2015) h5527.\n" + form.text();
}

}  // namespace palpa::study
