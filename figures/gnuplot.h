#pragma once

#include <filesystem>
#include <string>

namespace palpa::figures {

// Returns any text in single quotes for gnuplot, without line breaks and control characters.
std::string single_quoted(const std::string& text);

// Draws `script` to a .png, .svg or .pdf file, whole or not at all. Terminal and output are set before the script runs;
// it must hold its data as blocks ($name << EOD). Throws InputError for another ending or an output that cannot be
// replaced, std::runtime_error if gnuplot is missing or fails.
void draw_figure(const std::string& script, const std::filesystem::path& file, int width_px, int height_px);

// Throws InputError for an ending that draw_figure() would refuse, before anything is computed.
void check_figure(const std::filesystem::path& file);

// Runs a script that is kept beside its data, in its own folder: once for each `kind` of "png", "svg" and "pdf".
// Returns what to say where gnuplot is missing, with the words `kept` for what there is all the same ("the tables are
// kept"), and "" on success. Throws std::runtime_error, once all that can be drawn is drawn, if something could not.
std::string draw_script(const std::filesystem::path& script, const std::string& kept);

}  // namespace palpa::figures
