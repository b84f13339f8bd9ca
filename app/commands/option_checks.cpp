#include "app/commands/option_checks.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "files/input_error.h"

namespace palpa::app {
namespace {

std::string listed(const std::vector<std::string>& words) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        out += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
    }
    return out;
}

std::string refuse_infinite(std::string& text) {
    // CLI11 itself reports a text that is no number
    if (std::isfinite(std::strtod(text.c_str(), nullptr))) return {};
    return "found " + files::shown(text) + ", expected a finite number";
}

// CLI11 reads -1, and every number that is too large, as the largest unsigned number.
std::string refuse_wrapped(std::string& text) {
    errno = 0;
    const bool negative = text.find('-') != std::string::npos;
    std::strtoull(text.c_str(), nullptr, 0);
    if (!negative && errno != ERANGE) return {};
    return "found " + files::shown(text) + ", expected a whole number from 0 to " +
           std::to_string(std::numeric_limits<std::uint64_t>::max());
}

std::string refuse_empty(std::string& text) { return text.empty() ? "found nothing, expected a value" : std::string(); }

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto check = [words](std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        return "found " + files::shown(text) + ", expected " + listed(words);
    };
    return CLI::Validator(check, listed(words));
}

void refuse_what_is_no_value(CLI::App& command) {
    for (CLI::Option* option : command.get_options()) {
        const std::string type = option->get_type_name();
        if (type.rfind("FLOAT", 0) == 0) option->check(CLI::Validator(refuse_infinite, ""));
        if (type.rfind("UINT", 0) == 0) option->check(CLI::Validator(refuse_wrapped, ""));
        if (!type.empty()) option->check(CLI::Validator(refuse_empty, ""));  // flags have no value
    }
    for (CLI::App* below : command.get_subcommands({})) refuse_what_is_no_value(*below);
}

}  // namespace palpa::app
