// palpa study power PROTOCOL.json --participants N,...

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "app/study/power_run.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "stiffnessmaps/generate/generate.h"
#include "study/protocol_checks.h"
#include "study/table_text.h"

namespace palpa::app {
namespace {

struct PowerArguments {
    PowerOptions options;
    std::string protocol, output, part;
    bool json = false;
};

// Of the primary comparison's sides, or of all conditions without one; no test that ignores clustering.
bool is_shown(const study::PowerResult& one, const study::Protocol& protocol) {
    if (!one.what.label.empty() && one.what.method != "primary") return false;
    if (!protocol.primary || protocol.primary->of_groups) return true;
    const auto& sides = protocol.primary->sides;
    const auto among = [&](const std::string& name) {
        return std::find(sides.begin(), sides.end(), name) != sides.end();
    };
    return among(one.what.a) && (one.what.b.empty() || among(one.what.b));
}

std::string rate_text(const study::PowerShare& share) {
    if (share.n == 0) return "n/a";
    char text[64];
    std::snprintf(text, sizeof text, "%.1f +- %.1f", 100.0 * share.rate(), 100.0 * share.standard_error());
    return text;
}

// Zero of 500 that were tested is something else than zero because nothing could be tested.
std::string rejected_text(const study::PowerResult& one) {
    if (one.rejections.n == 0 || one.tested == one.rejections.n) return rate_text(one.rejections);
    if (one.tested == 0) return "never computed";
    return rate_text(one.rejections) + " (" + std::to_string(one.tested) + " computed)";
}

std::string coverage_text(const study::PowerResult& one, std::int64_t studies) {
    const std::int64_t n = one.coverage.n;
    return rate_text(one.coverage) + (n == 0 || n == studies ? "" : " (" + std::to_string(n) + " computed)");
}

std::string markdown(const study::Protocol& protocol, const PowerOptions& options, const PowerOutcome& outcome,
                     bool all) {
    std::string out =
        "# Power of " + protocol.name + ", version " + protocol.version + " (SIMULATED)\n\n" +
        std::to_string(options.runs) +
        " simulated studies of each kind, through the loop and the analysis of a real one; seed " +
        std::to_string(options.seed) +
        ". No person took part. Effect: share of the tests that show the condition's own scene, the others show that "
        "of `" +
        outcome.reference + "`; in choices the noise is exp(effect) times that of `" + outcome.reference +
        "`. Rejected: p < " + files::short_number(options.alpha) +
        ", which without an effect is the type I error; a test that cannot be computed in a study does not reject "
        "there. Both rates are in per cent with their Monte Carlo standard "
        "error.\n\nSimulated people: " +
        simulated_people_text() + ".\n\n";
    if (!all)
        out += "Tests and intervals of the primary comparison's conditions; all others are in power.tsv of `-o`.\n\n";
    out +=
        "| effect | noise | participants | quantity | a | b | method | rejected | interval covers | mean estimate | "
        "true "
        "value |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const study::PowerResult& one : outcome.results) {
        if (!all && !is_shown(one, protocol)) continue;
        const auto number = [](double x) {
            return std::isfinite(x) ? files::short_number(std::round(1e4 * x) / 1e4) : "n/a";
        };
        out += "| " + files::short_number(one.effect) + " | " + files::short_number(one.noise) + " | " +
               std::to_string(one.participants) + " | " + one.what.quantity + " | " + study::markdown_cell(one.what.a) +
               " | " + (one.what.b.empty() ? "n/a" : study::markdown_cell(one.what.b)) + " | " + one.what.method +
               (one.what.label.empty() ? "" : " (" + one.what.label + ")") + " | " + rejected_text(one) + " | " +
               coverage_text(one, options.runs) + " | " + number(one.mean_estimate) + " | " + number(one.truth) +
               " |\n";
    }
    return out;
}

files::Json outcome_json(const study::Protocol& protocol, const PowerOptions& options, const PowerOutcome& outcome) {
    files::Json json{{"simulated", true},
                     {"protocol", protocol.name},
                     {"protocol_sha256", protocol.sha256},
                     {"runs", options.runs},
                     {"computed", outcome.computed},
                     {"already_there", outcome.already_there},
                     {"complete", outcome.complete},
                     {"participants", options.participants},
                     {"effects", options.effects},
                     {"noises", options.noises},
                     {"reference", outcome.reference},
                     {"simulated_people", simulated_people_text()},
                     {"seed", options.seed},
                     {"alpha", options.alpha},
                     {"level", options.report.bootstrap.level},
                     {"resamples", options.report.bootstrap.resamples}};
    json["results"] = study::power_json(outcome.results);
    return json;
}

void take_part(const PowerArguments& arguments, PowerOptions& options) {
    std::optional<stiffnessmaps::Part> part;
    if (!arguments.part.empty()) part = stiffnessmaps::parse_part(arguments.part);
    if (!part && !options.merge) part = stiffnessmaps::part_from_environment();
    if (!part) return;
    options.part = part->index;
    options.parts = part->count;
    if (options.output.empty()) throw files::bad_input("--output", "", "nothing", "the folder that all parts share");
}

// A study that is simulated twice would be counted twice.
template <class Number>
void check_once(const char* option, std::vector<Number> numbers) {
    std::sort(numbers.begin(), numbers.end());
    const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
    if (twice == numbers.end()) return;
    throw files::bad_input(option, "", files::short_number(static_cast<double>(*twice)) + " twice", "each number once");
}

void measure(const PowerArguments& arguments) {
    PowerOptions options = arguments.options;
    options.output = arguments.output;
    std::sort(options.participants.begin(), options.participants.end());
    check_once("--participants", options.participants);
    check_once("--effect", options.effects);
    check_once("--noise", options.noises);
    take_part(arguments, options);
    if (options.merge && options.output.empty())
        throw files::bad_input("--output", "", "nothing", "the folder whose parts are to be merged");
    if (!arguments.output.empty()) {
        files::check_output_folder(arguments.output);
        files::check_own_results(arguments.output, "power_report.json", {"power.tsv", "power.json", "power.md"});
    }
    const study::Protocol protocol = study::read_protocol(arguments.protocol);
    study::refuse_mixed_ratings(protocol);
    const PowerOutcome outcome = measure_power(protocol, options);
    if (outcome.complete && !options.output.empty()) {
        const study::ReportTable table = study::power_table(outcome.results);
        files::write_text_atomically(options.output / "power_report.json",
                                     files::json_text(outcome_json(protocol, options, outcome)));
        files::write_text_atomically(options.output / "power.tsv", study::tsv_text(table));
        files::write_text_atomically(options.output / "power.json", files::json_text(study::power_dictionary()));
        files::write_text_atomically(options.output / "power.md", markdown(protocol, options, outcome, true));
    }
    if (arguments.json) {
        std::fputs(files::json_text(outcome_json(protocol, options, outcome)).c_str(), stdout);
    } else if (outcome.complete) {
        std::fputs(markdown(protocol, options, outcome, false).c_str(), stdout);
    } else {
        std::printf("%s: part %d/%d: %d studies now, %d of %d were there; --merge summarises all of them\n",
                    arguments.output.c_str(), options.part, options.parts, outcome.computed, outcome.already_there,
                    options.runs);
    }
}

}  // namespace

void add_study_power(CLI::App& study) {
    auto arguments = std::make_shared<PowerArguments>();
    PowerOptions& options = arguments->options;
    CLI::App* command = study.add_subcommand(
        "power", "Simulate many studies: power, type I error, and how often each interval holds the true value");
    command->add_option("PROTOCOL", arguments->protocol, "protocol JSON, or the name of a shipped one")
        ->required()
        ->transform(protocol_or_name());
    command->add_option("--participants", options.participants, "numbers of participants, such as 6,12,20")
        ->required()
        ->delimiter(',')
        ->check(CLI::Range(2, 1000));
    command
        ->add_option("--effect", options.effects,
                     "share of the tests that show their condition's own scene, 0 to 1; 0 gives the type I error "
                     "(default 0,1)")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 1.0));
    command->add_option("--reference", options.reference,
                        "condition whose scene the other tests show (default: the first of a primary comparison of "
                        "conditions, else the protocol's first)");
    command
        ->add_option("--noise", options.noises,
                     "factors on the noise of the simulated eye, and of the felt stiffness in choices without a scene "
                     "(default 1)")
        ->delimiter(',')
        ->check(CLI::Range(0.05, 20.0));
    command->add_option("--runs", options.runs, "number of simulated studies of each kind (default 100)")
        ->check(CLI::Range(2, 99999));
    command->add_option("-j,--jobs", options.jobs, "studies at a time (default 1)")->check(CLI::Range(1, 256));
    command->add_option("-o,--output", arguments->output,
                        "folder for the studies and for power.md, power.tsv, power_report.json; an interrupted call is "
                        "resumed there");
    command->add_option("--part", arguments->part,
                        "i/n: compute only this share of the studies (default on a cluster: from Slurm or OpenMPI)");
    command->add_flag("--merge", options.merge, "summarise the studies that the parts have computed")
        ->excludes("--part");
    command->add_option("--seed", options.seed, "of all studies (default 1)")->check(CLI::Range(0, 2000000000));
    command->add_option("--alpha", options.alpha, "a test rejects below it (default 0.05)")
        ->check(CLI::Range(1e-6, 0.5));
    command->add_option("--level", options.report.bootstrap.level, "confidence level of the intervals (default 0.95)")
        ->check(CLI::Range(0.5, 0.9999));
    command
        ->add_option("--resamples", options.report.bootstrap.resamples,
                     "resamples of each bootstrap (default 2000, as in analyse)")
        ->check(CLI::Range(100, 1000000));
    command->add_option("--rate-Hz", options.rate_Hz, "sample rate of the pen (default 60)")
        ->check(CLI::Range(10.0, 2000.0));
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { measure(*arguments); });
}

}  // namespace palpa::app
