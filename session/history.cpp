#include "session/history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <stdexcept>

#include "files/append_file.h"
#include "files/json.h"
#include "files/regular_file.h"

namespace palpa::session {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".trial.json";
constexpr files::Bounds kShare{0.0, 1.0};
constexpr int kMost = 1'000'000;
constexpr std::array<const char*, 4> kFindings{"found", "not_touched", "too_light", "not_marked"};

// Places to a micrometre and times to a millisecond: a small file, and more than a picture can show.
double rounded(double value) { return std::round(1e3 * value) / 1e3; }

bool is_kept_trial(const fs::path& file) {
    const std::string name = file.filename().string();
    const std::string ending = kEnding;
    return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

std::vector<KeptPoint> kept_path(const std::vector<PathPoint>& path) {
    std::vector<KeptPoint> out;
    const std::size_t every = path.size() / kKeptPoints + 1;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const PathPoint& p = path[i];
        if (i % every != 0 && !p.begins) continue;
        if (out.size() == kKeptPoints) break;
        out.push_back({static_cast<double>(p.t_s), 1e3 * p.p_m.x(), 1e3 * p.p_m.y(),
                       1e3 * static_cast<double>(p.depth_m), p.begins});
    }
    return out;
}

files::Json nodules_json(const KeptTrial& trial) {
    files::Json out = files::Json::array();
    for (const KeptNodule& n : trial.nodules) {
        out.push_back({{"id", n.id},
                       {"x_mm", rounded(n.x_mm)},
                       {"y_mm", rounded(n.y_mm)},
                       {"diameter_mm", rounded(n.diameter_mm)},
                       {"length_mm", rounded(n.length_mm)},
                       {"angle_deg", rounded(n.angle_deg)},
                       {"finding", kFindings[static_cast<std::size_t>(n.finding)]}});
    }
    return out;
}

files::Json marks_json(const KeptTrial& trial) {
    files::Json out = files::Json::array();
    for (const KeptMark& m : trial.marks) {
        out.push_back({{"x_mm", rounded(m.x_mm)},
                       {"y_mm", rounded(m.y_mm)},
                       {"confidence", m.confidence},
                       {"time_s", rounded(m.time_s)},
                       {"hit", m.hit}});
    }
    return out;
}

// One list of numbers instead of an object for each point.
files::Json path_json(const KeptTrial& trial) {
    files::Json out = files::Json::array();
    for (const KeptPoint& p : trial.path) {
        for (const double value : {p.time_s, p.x_mm, p.y_mm, p.depth_mm}) out.push_back(rounded(value));
        out.push_back(p.begins ? 1 : 0);
    }
    return out;
}

files::Json json_of(const KeptTrial& t) {
    return {{"palpa_trial", 1},
            {"utc", t.utc},
            {"scene", t.scene},
            {"mode", name_of(t.mode)},
            {"rotate_deg", t.rotate_deg},
            {"flip", t.flip},
            {"tissue_mm", {rounded(t.x_mm), rounded(t.y_mm), rounded(t.width_mm), rounded(t.height_mm)}},
            {"known_depth_mm", rounded(t.known_depth_mm)},
            {"clock_s", rounded(t.clock_s)},
            {"found", t.found},
            {"false_positives", t.false_positives},
            {"scored", t.scored},
            {"coverage", {t.coverage[0], t.coverage[1], t.coverage[2]}},
            {"max_force_N", rounded(t.max_force_N)},
            {"nodules", nodules_json(t)},
            {"marks", marks_json(t)},
            {"path", path_json(t)}};
}

void read_nodules(files::JsonReader& json, KeptTrial& trial) {
    for (files::JsonReader& one : json.objects("nodules")) {
        KeptNodule n;
        n.id = one.text("id");
        n.x_mm = one.number("x_mm", files::kAnyNumber);
        n.y_mm = one.number("y_mm", files::kAnyNumber);
        n.diameter_mm = one.number("diameter_mm", files::kNotNegative);
        n.length_mm = one.number("length_mm", files::kNotNegative, 0.0);  // trials of earlier versions lack both
        n.angle_deg = one.number("angle_deg", files::kAnyNumber, 0.0);
        n.finding =
            static_cast<Finding>(one.choice("finding", {kFindings[0], kFindings[1], kFindings[2], kFindings[3]}));
        one.finish();
        trial.nodules.push_back(n);
    }
}

void read_marks(files::JsonReader& json, KeptTrial& trial) {
    for (files::JsonReader& one : json.objects("marks")) {
        KeptMark m;
        m.x_mm = one.number("x_mm", files::kAnyNumber);
        m.y_mm = one.number("y_mm", files::kAnyNumber);
        m.confidence = one.integer("confidence", 0, 5);
        m.time_s = one.number("time_s", files::kNotNegative);
        m.hit = one.boolean("hit", false);
        one.finish();
        trial.marks.push_back(m);
    }
}

void read_path(files::JsonReader& json, KeptTrial& trial) {
    if (json.any("path").empty()) return;  // nobody pressed
    const std::vector<double> all = json.numbers("path", 0, files::kAnyNumber);
    if (all.size() % 5 != 0) json.fail("path", std::to_string(all.size()) + " numbers", "five for each point");
    for (std::size_t i = 0; i < all.size(); i += 5)
        trial.path.push_back({all[i], all[i + 1], all[i + 2], all[i + 3], all[i + 4] != 0.0});
}

}  // namespace

KeptTrial kept_trial(const Session& session, const std::string& utc) {
    const scene::Plan& plan = *session.plan;
    const Trial& trial = session.trial;
    const Debrief result = debrief(plan, trial);
    KeptTrial out;
    out.utc = utc;
    out.scene = session.scene.name;
    out.mode = trial.mode;
    out.rotate_deg = session.scene.mapping.rotate_deg;
    out.flip = session.scene.mapping.flip;
    out.x_mm = 1e3 * plan.area.centre_m.x();
    out.y_mm = 1e3 * plan.area.centre_m.y();
    out.width_mm = 1e3 * plan.area.size_m.x();
    out.height_mm = 1e3 * plan.area.size_m.y();
    out.known_depth_mm = 1e3 * plan.greatest_depth_m;
    out.clock_s = clock_s(trial, trial.now_s);
    out.found = result.score.true_positives;
    out.false_positives = result.score.false_positives;
    out.scored = result.scored;
    for (int i = 0; i < 3; ++i) out.coverage[i] = result.area.at_least[i + 1];
    out.max_force_N = trial.max_force_N;
    for (std::size_t i = 0; i < plan.nodules.size(); ++i) {
        const stiffnessmaps::Nodule& n = plan.nodules[i];
        out.nodules.push_back({n.id, 1e3 * n.x_m, 1e3 * n.y_m, 1e3 * n.diameter_m.value_or(4e-3),
                               1e3 * n.length_m.value_or(0.0), n.angle_deg.value_or(0.0), result.findings[i]});
    }
    for (std::size_t i = 0; i < trial.marks.size(); ++i) {
        const Mark& m = trial.marks[i];
        const bool hit = result.score.marks[i].kind == study::MarkKind::hit;
        out.marks.push_back({1e3 * m.p_m.x(), 1e3 * m.p_m.y(), m.confidence, m.clock_s, hit});
    }
    out.path = kept_path(trial.path);
    return out;
}

fs::path keep_trial(const KeptTrial& trial, const fs::path& folder) {
    fs::create_directories(folder);
    std::string stem = trial.utc;
    stem.erase(std::remove_if(stem.begin(), stem.end(), [](char c) { return c == ':' || c == '-'; }), stem.end());
    const std::string text = json_of(trial).dump() + "\n";
    for (int i = 1; i < kMost; ++i) {
        const fs::path file = folder / (stem + (i == 1 ? "" : "_" + std::to_string(i)) + kEnding);
        if (fs::exists(file)) continue;
        files::AppendFile out(file);  // never replaces a file
        out.append(text);
        if (!out.sync()) {
            std::error_code error;
            fs::remove(file, error);  // half a result cannot be read
            throw std::runtime_error(file.string() + ": the result could not be written (is the disk full?)");
        }
        return file;
    }
    throw std::runtime_error(folder.string() + ": no free name for the result of " + trial.utc);
}

KeptTrial read_kept_trial(const fs::path& file) {
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    json.integer("palpa_trial", 1, 1);
    KeptTrial t;
    t.utc = json.text("utc");
    t.scene = json.text("scene");
    t.mode = static_cast<TrialMode>(json.choice("mode", {"practice", "test"}));
    t.rotate_deg = json.integer("rotate_deg", 0, 270);
    t.flip = json.boolean("flip", false);
    const std::vector<double> tissue_mm = json.numbers("tissue_mm", 4, files::kAnyNumber);
    t.x_mm = tissue_mm[0];
    t.y_mm = tissue_mm[1];
    t.width_mm = tissue_mm[2];
    t.height_mm = tissue_mm[3];
    if (!(t.width_mm > 0.0 && t.height_mm > 0.0))
        json.fail("tissue_mm", "a size that is not > 0", "x, y, width, height");
    t.known_depth_mm = json.number("known_depth_mm", files::kNotNegative);
    t.clock_s = json.number("clock_s", files::kNotNegative);
    t.false_positives = json.integer("false_positives", 0, kMost);
    t.scored = json.boolean("scored", true);
    const std::vector<double> coverage = json.numbers("coverage", 3, kShare);
    std::copy(coverage.begin(), coverage.end(), t.coverage);
    t.max_force_N = json.number("max_force_N", files::kNotNegative);
    read_nodules(json, t);
    t.found = json.integer("found", 0, static_cast<int>(t.nodules.size()));
    read_marks(json, t);
    read_path(json, t);
    json.finish();
    return t;
}

std::vector<fs::path> history_files(const fs::path& folder, std::vector<std::string>& problems) {
    std::vector<fs::path> files;
    std::error_code error;
    const fs::directory_iterator readable(folder, error);
    if (error && error != std::errc::no_such_file_or_directory)
        problems.push_back(folder.string() + ": the folder of results cannot be read: " + error.message());
    for (const fs::path& entry : files::listed_entries(folder)) {
        if (is_kept_trial(entry) && !fs::is_directory(entry, error)) files.push_back(entry);
    }
    return files;
}

std::vector<KeptTrial> read_history(const std::vector<fs::path>& files, std::vector<std::string>& problems) {
    std::vector<KeptTrial> out;
    for (const fs::path& file : files) {
        try {
            out.push_back(read_kept_trial(file));
        } catch (const std::exception& problem) {
            problems.emplace_back(problem.what());
        }
    }
    std::stable_sort(out.begin(), out.end(), [](const KeptTrial& a, const KeptTrial& b) { return a.utc < b.utc; });
    return out;
}

void delete_history(const std::vector<fs::path>& files) {
    std::error_code error;
    for (const fs::path& file : files) {
        if (!fs::remove(file, error) && error)
            throw std::runtime_error(file.string() + ": cannot be deleted: " + error.message());
    }
}

}  // namespace palpa::session
