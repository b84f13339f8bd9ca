#pragma once

#include <filesystem>
#include <string>

namespace palpa::figures {

// One argument of a shell command, whatever it holds.
std::string shell_quoted(const std::string& text);

// Draws `script` to a .png, .svg or .pdf file, there whole or not at all. The script finds the terminal and the output
// set; data belong into it as blocks ($name << EOD). Throws InputError for another ending, std::runtime_error where
// gnuplot is missing or fails.
void draw_figure(const std::string& script, const std::filesystem::path& file, int width_px, int height_px);

// What draw_figure would refuse, before anything is computed.
void check_figure(const std::filesystem::path& file);

}  // namespace palpa::figures
