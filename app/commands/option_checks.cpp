#include "app/commands/option_checks.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>

#include "app/assets.h"
#include "files/input_error.h"
#include "files/text.h"

namespace palpa::app {
namespace {

std::string refuse_no_number(std::string& text) {
    char* end = nullptr;
    const bool finite = std::isfinite(std::strtod(text.c_str(), &end));
    if (finite && end != text.c_str() && *end == '\0') return {};
    return "found " + files::shown(text) + ", expected a " + (finite ? "number" : "finite number");
}

std::string refuse_no_whole_number(std::string& text) {
    char* end = nullptr;
    errno = 0;
    std::strtoll(text.c_str(), &end, 0);
    if (errno != ERANGE && end != text.c_str() && *end == '\0') return {};
    return "found " + files::shown(text) + ", expected a whole number";
}

// CLI11 reads -1, and every number that is too large, as the largest unsigned number.
std::string refuse_wrapped(std::string& text) {
    char* end = nullptr;
    errno = 0;
    const bool negative = text.find('-') != std::string::npos;
    std::strtoull(text.c_str(), &end, 0);
    if (!negative && errno != ERANGE && end != text.c_str() && *end == '\0') return {};
    return "found " + files::shown(text) + ", expected a whole number from 0 to " +
           std::to_string(std::numeric_limits<std::uint64_t>::max());
}

std::string refuse_empty(std::string& text) { return text.empty() ? "found nothing, expected a value" : std::string(); }

}  // namespace

std::string listed(const std::vector<std::string>& words) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        out += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
    }
    return out;
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto check = [words](std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        return "found " + files::shown(text) + ", expected " + listed(words);
    };
    return CLI::Validator(check, listed(words));
}

CLI::Validator code_of_participant() {
    const auto strip = [](std::string& text) {
        if (text.rfind("sub-", 0) == 0) text.erase(0, 4);
        return std::string();
    };
    return CLI::Validator(strip, "");
}

CLI::Validator protocol_or_name() {
    const auto find = [](std::string& text) {
        std::error_code error;  // a name may be too long for any file
        if (text.empty() || std::filesystem::exists(text, error) || std::filesystem::path(text).has_parent_path())
            return std::string();
        for (const char* ending : {"", ".json"}) {
            const std::filesystem::path shipped = assets_folder() / "protocols" / (text + ending);
            if (!std::filesystem::is_regular_file(shipped, error)) continue;
            text = shipped.string();
            break;
        }
        return std::string();
    };
    return CLI::Validator(find, "");
}

void refuse_unused(const CLI::App& command, const char* option, bool used, const std::string& needed) {
    if (!used && command.count(option) > 0) throw files::bad_input(option, "", "no " + needed, needed);
}

void refuse_what_is_no_value(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        const std::string type = option->get_type_name();
        // transform() asks before the option's own checks: CLI11's check of a range says of a word that it is "not in range"
        if (type.rfind("FLOAT", 0) == 0) option->transform(CLI::Validator(refuse_no_number, ""));
        if (type.rfind("INT", 0) == 0) option->transform(CLI::Validator(refuse_no_whole_number, ""));
        // an option's own range says which numbers it takes
        const bool range = type.find(" in [") != std::string::npos;
        if (type.rfind("UINT", 0) == 0)
            option->transform(CLI::Validator(range ? refuse_no_whole_number : refuse_wrapped, ""));
        if (!type.empty()) option->transform(CLI::Validator(refuse_empty, ""));  // flags have no value
    }
    for (CLI::App* below : command.get_subcommands({})) refuse_what_is_no_value(*below);
}

void check_subcommands(const CLI::App& app, const std::vector<std::string>& arguments) {
    const CLI::App* at = &app;
    std::string path;
    for (const std::string& word : arguments) {
        if (at->get_require_subcommand_min() == 0 || word.rfind('-', 0) == 0) return;
        std::vector<std::string> names;
        const CLI::App* found = nullptr;
        for (const CLI::App* below : at->get_subcommands({})) {
            names.push_back(below->get_name());
            if (below->check_name(word)) found = below;  // aliases too
        }
        if (found == nullptr)
            throw files::InputError(path + ": found " + files::shown(word) + ", expected " + listed(names));
        at = found;
        path += (path.empty() ? "" : " ") + word;
    }
}

void check_force_N(double force_N, const scene::Scene& scene, const calibration::Profile& profile) {
    std::int64_t clamped = 0;
    const double most_N = scene.force_scale * calibration::force_N(profile, profile.level_highest, clamped);
    if (force_N <= most_N) return;
    throw files::bad_input(
        "--force-N", "", files::short_number(force_N),
        "at most " + files::short_number(most_N) + ", the greatest force of the profile " + profile.id);
}

}  // namespace palpa::app
