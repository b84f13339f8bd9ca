// Runs a list of measurements, shows their progress, and makes tables of the rows.

#include "accuracy/accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdlib.h>  // getloadavg
#include <thread>
#include <unistd.h>

#include "accuracy/mechanics.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::accuracy {
namespace {

// One line on a terminal that is rewritten; nothing elsewhere.
class ProgressLine {
  public:
    explicit ProgressLine(double expected_s) : expected_s_(expected_s), on_(::isatty(STDERR_FILENO) == 1) {}
    ~ProgressLine() {
        if (on_) std::fputs("\r\033[K", stderr);
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(std::size_t done, std::size_t total, double done_s, const std::string& what) const {
        if (!on_) return;
        const double took_s = files::steady_s() - began_s_;
        const double pace = done_s > 0.0 ? took_s / done_s : 1.0;
        std::fprintf(stderr, "\r\033[K%zu of %zu, about %.0f s left: %s", done, total, pace * (expected_s_ - done_s),
                     what.c_str());
        std::fflush(stderr);
    }

  private:
    double expected_s_;
    bool on_;
    double began_s_ = files::steady_s();
};

std::string csv_cell(double value) { return files::number_text(value); }
std::string csv_cell(int value) { return std::to_string(value); }
std::string csv_cell(std::string value) {
    std::replace(value.begin(), value.end(), ',', ';');  // no quotes, so that gnuplot and awk can read it too
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
        visit_fields(row, [&](const char*, const auto& value) { line += (line.empty() ? "" : ",") + csv_cell(value); });
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
        for (const double value : {row.per_step_us, row.per_step_p99_us}) out += padded(table_number(value), 9, true);
        out += padded(table_number(row.memory_MB), 8, true) + (row.note.empty() ? "" : "  " + row.note) + "\n";
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
    machine.date = files::utc_now().substr(0, 10);
    return machine;
}

files::Json accuracy_json(const std::vector<AccuracyRow>& rows, const Machine& machine) {
    files::Json out{{"machine",
                     {{"processor", machine.processor},
                      {"threads", machine.threads},
                      {"load", machine.load},
                      {"date", machine.date}}},
                    {"rows", files::Json::array()}};
    for (const AccuracyRow& row : rows) {
        files::Json entry = files::Json::object();
        visit_fields(row, [&](const char* name, const auto& value) { entry[name] = value; });
        out["rows"].push_back(entry);
    }
    return out;
}

}  // namespace palpa::accuracy
