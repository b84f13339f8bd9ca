#pragma once
// What an option may be, told in words that a person reads.

#include <string>
#include <vector>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace palpa::app {

// One of these words: the help and the message list them as "a, b or c".
CLI::Validator one_of(const std::vector<std::string>& words);

// Every option of the command, and of its subcommands, refuses what is no value: of numbers "nan" and "inf" (CLI11's own
// check of a range lets "nan" pass, as it is neither below nor above), of numbers from 0 upwards what CLI11 would wrap
// around (-1), and of all what is empty: that is most often a variable of a script that was not set, and must count
// neither as 0 nor as an option that was left out.
void refuse_what_is_no_value(CLI::App& command);

}  // namespace palpa::app
