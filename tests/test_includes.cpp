// Who may include whom: the table of folders, checked on every #include of the sources.

#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace fs = std::filesystem;

namespace {

// Folders, or single headers, that a folder may include besides itself.
const std::map<std::string, std::set<std::string>> kMayInclude{
    {"files", {}},
    {"platform", {"files"}},
    {"calibration", {"files", "platform/sample.h"}},
    {"calibration/record", {"calibration", "files", "devices", "platform"}},
    {"stiffnessmaps", {"files"}},
    {"stiffnessmaps/import", {"stiffnessmaps", "files"}},
    {"stiffnessmaps/generate", {"stiffnessmaps", "files", "mechanics"}},
    {"mechanics", {}},
    {"avatar", {}},
    {"parts", {"files", "mechanics"}},
    {"parts/export", {"parts", "files", "mechanics"}},
    {"scene",
     {"files", "platform/sample.h", "platform/timeline.h", "calibration", "stiffnessmaps", "mechanics", "avatar",
      "parts"}},
    {"render", {"platform"}},
    {"devices", {"files", "platform"}},
    {"tactile", {"files", "mechanics", "scene", "devices", "platform/real_time.h"}},
    {"tangible", {"files", "mechanics", "scene", "devices", "fem/body_file", "platform/real_time.h"}},
    {"study", {"files"}},
    {"session",
     {"files", "platform/real_time.h", "platform/sample.h", "platform/timeline.h", "platform/trace.h", "calibration",
      "scene", "study"}},
    {"session/tactile_run", {"files", "scene", "session", "devices", "tactile"}},
    {"session/tactile_run_identify", {"scene", "devices", "tactile"}},
    {"session/tactile_run_live", {"files", "scene", "session", "devices", "tactile"}},
    {"session/tactile_run_sink", {"files", "scene", "session", "devices", "tactile"}},
    {"session/tangible_body", {"files", "session", "devices", "tangible"}},
    {"session/tangible_run", {"files", "scene", "session", "devices", "tangible"}},
    {"session/tangible_run_live", {"files", "mechanics/band_matrix.h", "scene", "session", "devices", "tangible"}},
    {"session/tangible_run_sink", {"files", "scene", "session", "devices", "tangible"}},
    {"fem", {"files", "mechanics", "fem/body_file", "fem/mesh_file"}},
    {"fem/body_file", {"files", "mechanics", "fem/mesh_file"}},
    {"fem/mesh_file", {"files", "mechanics"}},
    {"figures", {"files", "stiffnessmaps", "calibration", "study"}},
    {"accuracy",
     {"files", "platform", "calibration", "stiffnessmaps", "mechanics", "avatar", "parts", "scene", "devices",
      "tactile", "tangible", "study", "session", "fem", "figures"}},
    {"desk", {"files", "study"}},
    // the rooms of the app
    {"app", {"files", "scene", "app/commands/command_line.h"}},
    {"app/study",
     {"app/assets.h", "app/scene_choices.h", "files", "platform", "scene", "devices/press_file.h", "session", "study"}},
    {"app/screens",
     {"app/assets.h", "app/scene_choices.h", "app/study", "files", "platform", "calibration", "stiffnessmaps",
      "mechanics", "parts", "scene", "render", "study", "session", "figures"}},
    {"app/live",
     {"app/assets.h", "app/scene_choices.h", "app/screens", "app/study", "files", "platform",
      "calibration/profile_file.h", "parts", "scene", "render", "study", "session"}},
    {"app/commands", {"app",   "files",  "platform",     "calibration", "stiffnessmaps", "mechanics", "avatar",
                      "scene", "render", "devices",      "study",       "session",       "tactile",   "tangible",
                      "fem",   "parts",  "parts/export", "figures",     "accuracy",      "desk"}},
    {"app/web", {"app", "files", "platform", "calibration", "scene", "render", "study", "session"}},
};

std::string parent(const std::string& path) {
    const auto slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash);
}

// The row of a file: its own (without .h or .cpp), its folder's, or that of the nearest folder above that has one.
std::string row_of(const std::string& file) {
    const std::string own = file.substr(0, file.rfind('.'));
    if (kMayInclude.count(own) > 0) return own;
    std::string folder = parent(file);
    while (!folder.empty() && kMayInclude.count(folder) == 0) folder = parent(folder);
    return folder;
}

// A row names single headers, or folders with everything below them. A folder with a row of its own is no part of the row
// above it: `calibration` may not include calibration/record.
bool allowed(const std::string& row, const std::string& include) {
    const std::string target = row_of(include);
    if (target == row) return true;
    const auto& may = kMayInclude.at(row);
    if (may.count(include) > 0 || may.count(target) > 0) return true;
    for (std::string folder = parent(target); !folder.empty(); folder = parent(folder)) {
        if (may.count(folder) > 0) return true;
    }
    return false;
}

// The path in a line `#include "path"`, or "".
std::string included_by(const std::string& line) {
    const auto word = line.find("#include");
    const auto open = line.find('"', word);
    if (word == std::string::npos || line.find_first_not_of(" \t") != word || open == std::string::npos) return "";
    return line.substr(open + 1, line.find('"', open + 1) - open - 1);
}

// Calls check(file, row) for each header and source of the folders in the table.
template <class Check>
void for_each_source(const Check& check) {
    const fs::path root = PALPA_SOURCE_DIR;
    for (const auto& [folder, may] : kMayInclude) {
        if (folder.find('/') != std::string::npos || !fs::exists(root / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension == ".h" || extension == ".cpp")
                check(entry.path(), row_of(fs::relative(entry.path(), root).string()));
        }
    }
}

}  // namespace

TEST_CASE("includes: every #include is in the table of folders") {
    int checked = 0;
    for_each_source([&](const fs::path& source, const std::string& row) {
        std::ifstream file(source);
        for (std::string line; std::getline(file, line);) {
            const std::string name = included_by(line);
            if (name.empty()) continue;
            ++checked;
            CAPTURE(source.string());
            CAPTURE(name);
            CHECK_MESSAGE(fs::exists(fs::path(PALPA_SOURCE_DIR) / name),
                          "includes are written from the root of the project");
            CHECK(allowed(row, name));
        }
    });
    CHECK(checked > 100);
}

TEST_CASE("includes: the table refuses what it must") {
    CHECK_FALSE(allowed("avatar", "scene/scene.h"));
    CHECK_FALSE(allowed("calibration", "platform/trace.h"));
    CHECK(allowed("calibration", "platform/sample.h"));
    CHECK_FALSE(allowed("mechanics", "files/text.h"));
    CHECK_FALSE(allowed("app/screens", "app/live/live.h"));
    CHECK_FALSE(allowed("app/screens", "app/commands/command_line.h"));
    CHECK(allowed("app/commands", "app/live/live.h"));
    CHECK(allowed("calibration/record", "calibration/profile.h"));
    CHECK_FALSE(allowed("calibration", "calibration/record/acquisition.h"));
    CHECK(row_of("fem/body_file.h") == "fem/body_file");
    CHECK(allowed("fem", "fem/body_file.h"));
    CHECK(allowed("accuracy", "fem/mesh_file.h"));
    CHECK_FALSE(allowed("fem/body_file", "fem/case.h"));
    CHECK_FALSE(allowed("scene", "fem/body_file.h"));
    CHECK(allowed("session/tactile_run", "tactile/loop.h"));
    CHECK_FALSE(allowed("session", "tactile/loop.h"));
    CHECK_FALSE(allowed("tactile", "session/device_rows.h"));
}

// Everything that depends on the kind of tissue is an overload behind scene/tissue.h.
bool asks_for_tissue(const std::string& line) {
    static const std::regex asks(
        "(get_if|std::get|holds_alternative)<[a-z:]*(Map|Linear|Part|ForceCurve|SoftBlock)(Tissue|Options|Work)>|std::"
        "visit");
    return std::regex_search(line, asks);
}

TEST_CASE("tissues: only scene/tissue asks which tissue it is") {
    CHECK(asks_for_tissue("if (const auto* map = std::get_if<scene::MapTissue>(&plan.tissue)) {"));
    CHECK_FALSE(asks_for_tissue("if (const auto* text = std::get_if<std::string>(&choice.value)) return *text;"));
    for_each_source([](const fs::path& source, const std::string& row) {
        if (row == "scene" && source.stem() == "tissue") return;
        if (!allowed(row, "scene/tissue.h")) return;  // knows no tissues
        std::ifstream file(source);
        for (std::string line; std::getline(file, line);) {
            CAPTURE(source.string());
            CAPTURE(line);
            CHECK_FALSE(asks_for_tissue(line));
        }
    });
}

// Two types of one name link without a word, and one of them gets the other's functions.
TEST_CASE("names: no two headers define the same type") {
    static const std::regex opens("namespace ([a-z:]+) \\{"),
        type("(struct|class|enum class) ([A-Z][A-Za-z0-9]+)[^;]*\\{.*");
    std::map<std::string, std::string> defined;
    for_each_source([&](const fs::path& source, const std::string&) {
        if (source.extension() != ".h" || source.parent_path().filename() == "web") return;  // those of other systems
        std::ifstream file(source);
        std::string space;
        std::smatch found;
        for (std::string line; std::getline(file, line);) {
            if (std::regex_match(line, found, opens)) space = found[1];
            if (!std::regex_match(line, found, type)) continue;
            const std::string name = space + "::" + found[2].str();
            CAPTURE(name);
            const auto [first, is_new] = defined.emplace(name, source.string());
            CHECK_MESSAGE(is_new, first->second << " and " << source.string());
        }
    });
    CHECK(defined.size() > 200);
}
