#pragma once

#include <filesystem>
#include <string>

namespace palpa::figures {

// Text as gnuplot takes it between single quotes, whatever it holds; line breaks and control characters are left out.
std::string single_quoted(const std::string& text);

// Draws `script` to a .png, .svg or .pdf file, there whole or not at all. The script finds the terminal and the output
// set; data belong into it as blocks ($name << EOD). Throws InputError for another ending, std::runtime_error where
// gnuplot is missing or fails.
void draw_figure(const std::string& script, const std::filesystem::path& file, int width_px, int height_px);

// What draw_figure would refuse, before anything is computed.
void check_figure(const std::filesystem::path& file);

// Runs a script that is kept beside its data, in its own folder: once for each `kind` of "png", "svg" and "pdf". Returns
// what went wrong, which names what is `kept` all the same ("the tables are kept"); empty if nothing did.
std::string draw_script(const std::filesystem::path& script, const std::string& kept);

}  // namespace palpa::figures
