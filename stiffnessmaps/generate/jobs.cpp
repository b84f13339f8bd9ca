#include "stiffnessmaps/generate/jobs.h"

#include "files/progress_line.h"
#include "files/text.h"
#include "stiffnessmaps/generate/worker_processes.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

Arguments call_of(const GenerateOptions& options) {
    Arguments out{"maps",
                  "generate",
                  options.phantom.string(),
                  "-o",
                  options.output.string(),
                  "--coarseness",
                  files::number_text(options.coarseness)};
    return out;
}

std::size_t files_there(const MapTask& task, std::size_t count, std::string (*name)(std::size_t)) {
    std::size_t there = 0;
    for (std::size_t i = 0; i < count; ++i) there += fs::exists(task.folder / name(i)) ? 1u : 0u;
    return there;
}

// Removes wrong pieces, so that counting files is counting pieces.
void drop_wrong(const MapTask& task, const std::vector<std::size_t>& wrong, std::string (*name)(std::size_t)) {
    for (const std::size_t i : wrong) fs::remove(task.folder / name(i));
}

std::string window_of(std::size_t window) { return window_name(static_cast<int>(window)); }

std::vector<Arguments> window_calls(const GenerateOptions& options, const std::vector<std::size_t>& windows,
                                    MeshSet meshes) {
    std::vector<Arguments> calls;
    for (const std::size_t window : windows) {
        calls.push_back(call_of(options));
        calls.back().insert(calls.back().end(), {"--window", std::to_string(window)});
        if (meshes == MeshSet::refined) calls.back().emplace_back("--refined");
        if (meshes == MeshSet::coarser) calls.back().emplace_back("--coarser");
    }
    return calls;
}

}  // namespace

std::vector<std::size_t> missing(const MapTask& task, std::size_t count, std::string (*name)(std::size_t)) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < count; ++i) {
        if (!read_piece(task, name(i))) out.push_back(i);
    }
    return out;
}

void compute_with_jobs(const GenerateOptions& options, const MapTask& task) {
    constexpr double kWindowWeight = 30.0;  // the work of one window, in lines
    const auto n_windows = static_cast<std::size_t>(window_count(task));
    const std::size_t n_lines = task.phantom.n_y;
    const auto windows = missing(task, n_windows, window_of);
    const auto lines = missing(task, n_lines, line_name);
    drop_wrong(task, windows, window_of);
    drop_wrong(task, lines, line_name);
    if (lines.empty()) return;
    files::ProgressLine progress;
    const double total = kWindowWeight * static_cast<double>(n_windows) + static_cast<double>(n_lines);
    const auto show = [&] {
        const double done = kWindowWeight * static_cast<double>(files_there(task, n_windows, window_of)) +
                            static_cast<double>(files_there(task, n_lines, line_name));
        progress.show("generating", done / total);
    };
    run_jobs(window_calls(options, windows, MeshSet::own), options.jobs, show);
    std::vector<Arguments> calls;
    for (int i = 1; i <= options.jobs; ++i) {
        calls.push_back(call_of(options));
        calls.back().insert(calls.back().end(), {"--part", std::to_string(i) + "/" + std::to_string(options.jobs)});
    }
    run_jobs(calls, options.jobs, show);
}

void compute_part(const MapTask& task, const Part& part) {
    const auto n_windows = static_cast<std::size_t>(window_count(task));
    for (const bool wait : {false, true}) {
        for (std::size_t k = 0; k < n_windows; ++k) {
            const std::size_t window = (k + static_cast<std::size_t>(part.index) - 1) % n_windows;
            if (read_piece(task, window_of(window))) continue;
            const FileLock lock(task.folder / (window_of(window) + ".lock"), wait);
            if (lock.held() && !read_piece(task, window_of(window))) compute_window(task, static_cast<int>(window));
        }
    }
    const mechanics::RollingTables tables = read_windows(task);
    const auto step = static_cast<std::size_t>(part.count);
    for (std::size_t j = static_cast<std::size_t>(part.index) - 1; j < task.phantom.n_y; j += step) {
        if (!read_piece(task, line_name(j))) compute_line(task, tables, j);
    }
}

void compute_windows(const GenerateOptions& options, const MapTask& task, MeshSet meshes, const char* what) {
    fs::create_directories(task.folder);
    const auto n_windows = static_cast<std::size_t>(window_count(task));
    const auto windows = missing(task, n_windows, window_of);
    drop_wrong(task, windows, window_of);
    files::ProgressLine progress;
    run_jobs(window_calls(options, windows, meshes), options.jobs, [&] {
        const auto done = static_cast<double>(files_there(task, n_windows, window_of));
        progress.show(what, done / static_cast<double>(n_windows));
    });
}

}  // namespace palpa::stiffnessmaps
