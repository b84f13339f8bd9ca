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
    {"stiffnessmaps", {"files"}},
    {"mechanics", {}},
    {"avatar", {}},
    {"scene", {"files", "platform/sample.h", "calibration", "stiffnessmaps", "mechanics", "avatar"}},
    {"render", {"platform"}},
    {"devices", {"files", "platform"}},
    {"study", {"files"}},
    {"app", {"files", "platform", "calibration", "stiffnessmaps", "mechanics", "avatar", "scene", "render", "devices",
             "study"}},
};

std::string first_folder(const std::string& path) { return path.substr(0, path.find('/')); }

bool allowed(const std::string& folder, const std::string& include) {
    if (first_folder(include) == folder) return true;
    const auto& may = kMayInclude.at(folder);
    return may.count(first_folder(include)) > 0 || may.count(include) > 0;
}

// The path in a line `#include "path"`, or "".
std::string included_by(const std::string& line) {
    const auto word = line.find("#include");
    const auto open = line.find('"', word);
    if (word == std::string::npos || line.find_first_not_of(" \t") != word || open == std::string::npos) return "";
    return line.substr(open + 1, line.find('"', open + 1) - open - 1);
}

}  // namespace

TEST_CASE("includes: every #include is in the table of folders") {
    const fs::path root = PALPA_SOURCE_DIR;
    int checked = 0;
    for (const auto& [folder, may] : kMayInclude) {
        if (!fs::exists(root / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);) {
                const std::string name = included_by(line);
                if (name.empty()) continue;
                ++checked;
                CAPTURE(entry.path().string());
                CAPTURE(name);
                CHECK_MESSAGE(fs::exists(root / name), "includes are written from the root of the project");
                CHECK(allowed(folder, name));
            }
        }
    }
    CHECK(checked > 100);
}

TEST_CASE("includes: the table refuses what it must") {
    CHECK_FALSE(allowed("avatar", "scene/scene.h"));
    CHECK_FALSE(allowed("calibration", "platform/trace.h"));
    CHECK(allowed("calibration", "platform/sample.h"));
    CHECK_FALSE(allowed("mechanics", "files/text.h"));
}

// Two types of one name link without a word, and one of them gets the other's functions.
TEST_CASE("names: no two headers define the same type") {
    static const std::regex opens("namespace ([a-z:]+) \\{"), type("(struct|class|enum class) ([A-Z][A-Za-z0-9]+)[^;]*\\{.*");
    std::map<std::string, std::string> defined;
    for (const auto& [folder, may] : kMayInclude) {
        if (!fs::exists(fs::path(PALPA_SOURCE_DIR) / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(PALPA_SOURCE_DIR) / folder)) {
            if (entry.path().extension() != ".h" || entry.path().parent_path().filename() == "web") continue;  // those of other systems
            std::ifstream file(entry.path());
            std::string space;
            std::smatch found;
            for (std::string line; std::getline(file, line);) {
                if (std::regex_match(line, found, opens)) space = found[1];
                if (!std::regex_match(line, found, type)) continue;
                const std::string name = space + "::" + found[2].str();
                CAPTURE(name);
                const auto [first, is_new] = defined.emplace(name, entry.path().string());
                CHECK_MESSAGE(is_new, first->second << " and " << entry.path().string());
            }
        }
    }
    CHECK(defined.size() > 200);
}
