#pragma once
// Checks of the values of options, with messages in plain words.

#include <string>
#include <vector>

#include "calibration/profile.h"
#include "scene/scene.h"

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace palpa::app {

// "a, b or c".
std::string listed(const std::vector<std::string>& words);

// Accepts one of these words; the help and the message list them as "a, b or c".
CLI::Validator one_of(const std::vector<std::string>& words);

// For a participant's code: takes it also as folders and participants.tsv write it, with `sub-` in front.
CLI::Validator code_of_participant();

// For a protocol: a name alone, with or without .json, that is no file here is that of a shipped one.
CLI::Validator protocol_or_name();

// Throws files::InputError if an option is given that changes nothing without `needed`.
void refuse_unused(const CLI::App& command, const char* option, bool used, const std::string& needed);

// Makes every option of the command and its subcommands refuse values that mean nothing. Numbers refuse words, "nan" and
// "inf" (CLI11's check of a range lets "nan" pass, since it is neither below nor above). Unsigned numbers refuse -1, which CLI11
// would wrap around. All options refuse an empty text: most often it is an unset variable of a script, and must count
// neither as 0 nor as an option left out.
void refuse_what_is_no_value(CLI::App& command);

// Throws files::InputError if a word stands where a subcommand is required and names none: CLI11 itself says only that a
// subcommand is required. `arguments`: in the order in which they were typed.
void check_subcommands(const CLI::App& app, const std::vector<std::string>& arguments);

// Throws files::InputError for a --force-N that a simulated pen cannot press with, by the scene's profile.
void check_force_N(double force_N, const scene::Scene& scene, const calibration::Profile& profile);

}  // namespace palpa::app
