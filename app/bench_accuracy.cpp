// palpa bench accuracy mechanics: the list of measurements, its progress, and the table it becomes.

#include "app/bench_accuracy.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdlib.h>  // getloadavg
#include <thread>
#include <unistd.h>

#include "app/bench_mechanics.h"
#include "app/command_line.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa {
namespace {

struct Options {
    std::string folder;
    bool quick = false;
    bool json = false;
};

// One line on a terminal, rewritten; nothing elsewhere.
class ProgressLine {
  public:
    explicit ProgressLine(double expected_s)
        : expected_s_(expected_s),
          on_(::isatty(STDERR_FILENO) == 1),
          start_(std::chrono::steady_clock::now()) {}
    ~ProgressLine() {
        if (on_) std::fputs("\r\033[K", stderr);
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(std::size_t done, std::size_t total, double done_s, const std::string& what) const {
        if (!on_) return;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start_;
        const double pace = done_s > 0.0 ? took.count() / done_s : 1.0;
        std::fprintf(stderr, "\r\033[K%zu of %zu, about %.0f s left: %s", done, total,
                     pace * (expected_s_ - done_s), what.c_str());
        std::fflush(stderr);
    }

  private:
    double expected_s_;
    bool on_;
    std::chrono::steady_clock::time_point start_;
};

std::string csv_cell(double value) {
    return number_text(value);
}
std::string csv_cell(int value) {
    return std::to_string(value);
}
std::string csv_cell(std::string value) {
    std::replace(value.begin(), value.end(), ',', ';');  // no quotes, so that gnuplot and awk read it too
    return value.empty() ? "n/a" : value;
}

std::string padded(const std::string& text, std::size_t width, bool right) {
    const std::string fill(text.size() < width ? width - text.size() : 0, ' ');
    return right ? fill + text : text + fill;
}

std::string table_number(double value) {
    if (std::isnan(value)) return "n/a";
    const double size = std::abs(value);
    const bool small = value != 0.0 && size < 1e-2;
    const int decimals = value == 0.0 || size >= 100.0 ? 0 : size < 10.0 && !small ? 2 : 1;
    std::array<char, 32> buffer{};
    if (small)
        std::snprintf(buffer.data(), buffer.size(), "%.1e", value);
    else
        std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, value);
    return buffer.data();
}

// Before the minutes of measuring, not after them.
void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw InputError("-o " + folder.string() + ": found " + (error ? error.message() : "a file") +
                         ", expected a folder or a name for one");
}

void run_accuracy(const Options& options) {
    if (!options.folder.empty()) {
        check_output_folder(options.folder);
        make_folder(options.folder);
    }
    const Effort effort{options.quick, options.quick ? 0.05 : 0.8, options.quick ? 0.05 : 0.6};
    std::vector<Measurement> list = slab_measurements(effort);
    for (const auto& more : {contact_measurements(effort), step_measurements(effort)})
        list.insert(list.end(), more.begin(), more.end());
    const Machine machine = this_machine();
    const std::vector<AccuracyRow> rows = run_measurements(list);
    if (options.json) {
        std::printf("%s\n", accuracy_json(rows, machine).dump(2).c_str());
    } else {
        std::printf("%s, %u threads, load %s, %s\n%s", machine.processor.c_str(), machine.threads,
                    short_number(machine.load).c_str(), machine.date.c_str(), accuracy_table(rows).c_str());
    }
    if (options.folder.empty()) return;
    write_text_atomically(std::filesystem::path(options.folder) / "mechanics.csv", accuracy_csv(rows));
    const std::string trouble = plot_mechanics(options.folder, machine);
    if (!trouble.empty())
        std::fprintf(stderr, "palpa: %s\n", trouble.c_str());
    else
        std::fprintf(stderr, "%s: mechanics.csv, .gp, .png, .svg, .pdf\n", options.folder.c_str());
}

}  // namespace

std::vector<AccuracyRow> run_measurements(const std::vector<Measurement>& list) {
    double expected_s = 0.0;
    for (const Measurement& one : list) expected_s += one.expected_s;
    const ProgressLine progress(expected_s);
    std::vector<AccuracyRow> rows;
    double done_s = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        progress.show(i, list.size(), done_s, list[i].what);
        try {
            list[i].run(rows);
        } catch (const std::exception& error) {
            AccuracyRow failed{.group = "failed", .series = "failed", .choice = list[i].what};
            failed.note = error.what();
            rows.push_back(failed);
        }
        done_s += list[i].expected_s;
    }
    return rows;
}

std::string accuracy_csv(const std::vector<AccuracyRow>& rows) {
    std::string out;
    visit_fields(AccuracyRow{},
                 [&](const char* name, const auto&) { out += (out.empty() ? "" : ",") + std::string(name); });
    out += '\n';
    for (const AccuracyRow& row : rows) {
        std::string line;
        visit_fields(row, [&](const char*, const auto& value) {
            line += (line.empty() ? "" : ",") + csv_cell(value);
        });
        out += line + '\n';
    }
    return out;
}

std::string accuracy_table(const std::vector<AccuracyRow>& rows) {
    std::string out;
    std::string group;
    std::string reference;
    for (const AccuracyRow& row : rows) {
        if (row.group != group) {
            group = row.group;
            reference.clear();
            out += "\n" + padded(group, 34, false) +
                   "  nodes    dofs   error %   worst %  offline s  step us   p99 us      MB\n";
        }
        if (row.reference != reference) {
            reference = row.reference;
            out += "  against: " + reference;
            if (!std::isnan(row.reference_error_percent))
                out += ", itself good to " + table_number(row.reference_error_percent) + " %";
            out += "\n";
        }
        out += "  " + padded(row.choice, 32, false) + padded(std::to_string(row.nodes), 7, true) +
               padded(std::to_string(row.dofs), 8, true);
        for (const double value : {row.error_percent, row.worst_error_percent})
            out += padded(table_number(value), 10, true);
        out += padded(table_number(row.offline_s), 11, true);
        for (const double value : {row.per_step_us, row.per_step_p99_us})
            out += padded(table_number(value), 9, true);
        out +=
            padded(table_number(row.memory_MB), 8, true) + (row.note.empty() ? "" : "  " + row.note) + "\n";
    }
    return out;
}

Machine this_machine() {
    Machine machine{"unknown processor", std::thread::hardware_concurrency(), kUnknown, ""};
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        const auto colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            machine.processor = line.substr(colon + 2);
            break;
        }
    }
    double load = 0.0;
    if (::getloadavg(&load, 1) == 1) machine.load = load;
    const std::time_t now = std::time(nullptr);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "%Y-%m-%d", std::gmtime(&now));
    machine.date = date.data();
    return machine;
}

Json accuracy_json(const std::vector<AccuracyRow>& rows, const Machine& machine) {
    Json out{{"machine",
              {{"processor", machine.processor},
               {"threads", machine.threads},
               {"load", machine.load},
               {"date", machine.date}}},
             {"rows", Json::array()}};
    for (const AccuracyRow& row : rows) {
        Json entry = Json::object();
        visit_fields(row, [&](const char* name, const auto& value) { entry[name] = value; });
        out["rows"].push_back(entry);
    }
    return out;
}

void add_bench_accuracy(CLI::App& bench) {
    auto options = std::make_shared<Options>();
    CLI::App* accuracy = bench.add_subcommand("accuracy", "Measure what accuracy costs in time");
    accuracy->require_subcommand(1);
    CLI::App* mechanics = accuracy->add_subcommand(
        "mechanics",
        "Measure error and cost of each choice: element, mesh, contact, friction, solver, precomputed or live");
    mechanics->add_option("-o,--output", options->folder,
                          "folder for mechanics.csv and its figure (default: nothing is written)");
    mechanics->add_flag("--quick", options->quick,
                        "use small meshes only, which takes under 20 s (all meshes: 4 minutes)");
    mechanics->add_flag("--json", options->json, "print one JSON object on standard output");
    mechanics->callback([options] { run_accuracy(*options); });
}

}  // namespace palpa
