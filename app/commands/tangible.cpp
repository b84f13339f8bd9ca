// palpa tangible: soft devices that push back as a virtual tissue would. Each subcommand has a file of its own.

#include <CLI/CLI.hpp>

#include "app/commands/command_line.h"

namespace palpa::app {
namespace {

constexpr const char* kPatents =
    "The method is patented by Inria: FR3002047B1, EP2954429B1, US 9,701,013 B2, JP6382226B2 (priority 2013-02-08; "
    "whether "
    "they are in force was not checked). Nothing here gives a right under them. docs/legal.md says more.";

}  // namespace

void add_tangible(CLI::App& app) {
    CLI::App* tangible = app.add_subcommand("tangible", "Soft tangible devices, controlled by inverse finite elements");
    tangible->require_subcommand(1);
    tangible->footer(kPatents);
    add_tangible_info(*tangible);
    add_tangible_solve(*tangible);
    add_tangible_run(*tangible);
    add_tangible_characterise(*tangible);
    add_tangible_fit(*tangible);
}

}  // namespace palpa::app
