#include "platform/sample.h"

#include <array>

namespace palpa::platform {
namespace {

constexpr std::array<std::string_view, kToolCount> kTools{"pen", "finger", "mouse", "keyboard"};
constexpr std::array<std::string_view, 6> kPhases{"hover", "down", "move", "up", "cancel", "ui"};
constexpr std::array<std::string_view, 15> kActions{
    "n/a",          "resize",       "mark",   "undo",  "finish", "confidence_1", "confidence_2", "confidence_3",
    "confidence_4", "confidence_5", "hidden", "shown", "pause",  "resume",       "method"};

template <class Enum, std::size_t N>
bool parse(std::string_view name, const std::array<std::string_view, N>& names, Enum& out) {
    for (std::size_t i = 0; i < N; ++i) {
        if (names[i] == name) {
            out = static_cast<Enum>(i);
            return true;
        }
    }
    return false;
}

}  // namespace

std::string_view name_of(Tool tool) { return kTools[static_cast<std::size_t>(tool)]; }
std::string_view name_of(Phase phase) { return kPhases[static_cast<std::size_t>(phase)]; }
std::string_view name_of(Action action) { return kActions[static_cast<std::size_t>(action)]; }
bool parse_name(std::string_view name, Tool& out) { return parse(name, kTools, out); }
bool parse_name(std::string_view name, Phase& out) { return parse(name, kPhases, out); }
bool parse_name(std::string_view name, Action& out) { return parse(name, kActions, out); }

}  // namespace palpa::platform
