#include "figures/gnuplot.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <unistd.h>
#include <vector>

#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

std::string terminal(const std::filesystem::path& file, int width_px, int height_px) {
    const std::string kind = file.extension().string();
    const std::string px = std::to_string(width_px) + "," + std::to_string(height_px);
    if (kind == ".png") return "pngcairo size " + px + " font 'DejaVu Sans,11'";
    if (kind == ".svg") return "svg size " + px + " font 'DejaVu Sans,13'";
    if (kind == ".pdf")
        return "pdfcairo size " + files::short_number(width_px / 100.0) + "in," +
               files::short_number(height_px / 100.0) + "in font 'DejaVu Sans,11'";
    throw files::bad_input(file.string(), "", "a file name that ends in " + files::shown(kind), ".png, .svg or .pdf");
}

// Returns any text as one argument of a shell command.
std::string shell_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

bool run(const std::string& command) { return std::system(command.c_str()) == 0; }

// Runs gnuplot by this command. What it says is told only if it fails: else it speaks of tics that it left out.
bool draw(const std::string& command, const std::filesystem::path& said) {
    const bool good = run(command + " 2> " + shell_quoted(said.string()));
    std::error_code none;
    if (!good && std::filesystem::exists(said, none)) std::fputs(files::read_text(said).c_str(), stderr);
    std::filesystem::remove(said, none);
    return good;
}

bool is_installed() { return run("command -v gnuplot >/dev/null 2>&1"); }
constexpr const char* kMissing = "gnuplot cannot be started (is it installed? package gnuplot-nox)";

bool is_control(char c) { return static_cast<unsigned char>(c) < ' '; }

// True if the figure has its end. gnuplot does not say so if the disk is full.
bool is_whole(const std::filesystem::path& file, const std::string& kind) {
    constexpr std::size_t kTail_bytes = 32;
    std::error_code none;
    if (!std::filesystem::exists(file, none)) return false;
    const std::string bytes = files::read_text(file);
    const std::string tail = bytes.substr(bytes.size() - std::min(bytes.size(), kTail_bytes));
    const std::string_view end = kind == ".png" ? "IEND\xae\x42\x60\x82" : kind == ".svg" ? "</svg>" : "%%EOF";
    return tail.find(end) != std::string::npos;
}

// Returns the figures of a kept script: the names before `." . kind` in its lines `set output`.
std::vector<std::string> figures_of(const std::filesystem::path& script) {
    const std::string text = files::read_text(script);
    const std::string begin = "set output \"";
    std::vector<std::string> out;
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
        const std::size_t from = at + begin.size();
        out.push_back(text.substr(from, text.find('"', from) - from));
    }
    return out;
}

}  // namespace

std::string single_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (!is_control(c)) out += c == '\'' ? std::string("''") : std::string(1, c);
    }
    return out + "'";
}

void check_figure(const std::filesystem::path& file) { terminal(file, 1, 1); }

void draw_figure(const std::string& script, const std::filesystem::path& name, int width_px, int height_px) {
    const std::filesystem::path file = files::output_target(name);
    const std::string set = "set terminal " + terminal(name, width_px, height_px) + "\n";
    if (!is_installed()) throw std::runtime_error(file.string() + ": not drawn: " + kMissing);
    const std::string aside = file.string() + ".part-" + std::to_string(::getpid());
    const std::string commands = aside + ".gp";
    // the figure comes on standard output, since gnuplot's own quotes do not hold every name of a folder
    files::write_text_atomically(commands, "set encoding utf8\n" + set + script + "\nunset output\n");
    const bool drawn = draw("gnuplot " + shell_quoted(commands) + " > " + shell_quoted(aside), aside + ".said");
    const bool whole = drawn && is_whole(aside, name.extension().string());
    ::unlink(commands.c_str());
    // without this, a viewer may blend cells with each other and with gaps
    if (whole && name.extension() == ".svg") {
        std::string svg = files::read_text(aside);
        for (std::size_t at = svg.find("<image "); at != std::string::npos; at = svg.find("<image ", at + 1))
            svg.insert(at + 6, " style='image-rendering:pixelated'");
        files::write_text_whole(aside, svg);
    }
    if (!whole || ::rename(aside.c_str(), file.c_str()) != 0) {
        ::unlink(aside.c_str());
        throw std::runtime_error(file.string() + ": gnuplot could not draw it" +
                                 (drawn ? " to its end (is the disk full?)" : ""));
    }
}

std::string draw_script(const std::filesystem::path& script, const std::string& kept) {
    const std::string name = script.filename().string();
    if (!is_installed()) {
        return std::string(kMissing) + ", so there are no figures; " + kept + ": run `gnuplot " + name +
               "` where it is";
    }
    std::string cut_off;
    const std::string there = "cd " + shell_quoted(std::filesystem::absolute(script).parent_path().string());
    for (const std::string kind : {"png", "svg", "pdf"}) {
        if (!draw(there + " && gnuplot -e \"kind='" + kind + "'\" " + shell_quoted(name),
                  std::filesystem::absolute(script.string() + ".said")))
            throw std::runtime_error("gnuplot could not draw " + script.string() + "; " + kept);
        for (const std::string& figure : figures_of(script)) {
            const std::filesystem::path file = script.parent_path() / (figure + kind);
            if (is_whole(file, "." + kind)) continue;
            std::error_code none;
            std::filesystem::remove(file, none);
            cut_off += (cut_off.empty() ? "" : ", ") + file.string();
        }
    }
    if (!cut_off.empty())
        throw std::runtime_error(cut_off + ": gnuplot could not draw this to its end (is the disk full?); " + kept);
    return "";
}

}  // namespace palpa::figures
