#pragma once
// Checks of the values of options, with messages in plain words.

#include <string>
#include <vector>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace palpa::app {

// Accepts one of these words; the help and the message list them as "a, b or c".
CLI::Validator one_of(const std::vector<std::string>& words);

// Makes every option of the command and its subcommands refuse values that mean nothing. Numbers refuse "nan" and "inf"
// (CLI11's check of a range lets "nan" pass, since it is neither below nor above). Unsigned numbers refuse -1, which CLI11
// would wrap around. All options refuse an empty text: most often it is an unset variable of a script, and must count
// neither as 0 nor as an option left out.
void refuse_what_is_no_value(CLI::App& command);

}  // namespace palpa::app
