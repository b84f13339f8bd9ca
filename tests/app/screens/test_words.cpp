// app/screens/words.h has all words that screens show, and none that nothing shows.

#include <cctype>
#include <doctest/doctest.h>
#include <filesystem>
#include <regex>
#include <stdlib.h>
#include <string>
#include <time.h>
#include <vector>

#include "app/screens/history_screen.h"
#include "app/screens/words.h"
#include "files/text.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::app;

namespace {

namespace fs = std::filesystem;

const fs::path kApp = fs::path(PALPA_SOURCE_DIR) / "app";

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::vector<fs::path> sources_of_screens() {
    std::vector<fs::path> out;
    for (const char* room : {"screens", "live"}) {
        for (const auto& entry : fs::directory_iterator(kApp / room)) {
            const std::string name = entry.path().filename().string();
            const bool screen = ends_with(name, "_screen.cpp") || std::string(room) == "live" || name == "menu.cpp" ||
                                name == "map_drawing.cpp" || name == "widgets.cpp";
            if (screen && ends_with(name, ".cpp")) out.push_back(entry.path());
        }
    }
    for (const auto& entry : fs::directory_iterator(kApp / "web")) {
        const std::string name = entry.path().filename().string();
        if (ends_with(name, "_screen.cpp") || ends_with(name, ".js")) out.push_back(entry.path());
    }
    return out;
}

// What a person would read: a capital and small letters in front, or two words in a row.
bool is_prose(const std::string& literal) {
    static const std::regex prose("^[A-Z][a-z]+|[a-z]{2,},? [a-z]{2,}");
    return std::regex_search(literal, prose);
}

// Names of panels, and messages about files, which are with what reports them.
bool is_other(const std::string& line) {
    static const std::regex other(
        "_panel\\(|BeginChild\\(|throw |bad_input|catch|console\\.|getElementById|addEventListener|'use "
        "strict'|headers|Authorization|\\.key |\\.name ===|json\\[|result\\[");
    return std::regex_search(line, other);
}

// Whether the text has this name, and not only as the beginning of a longer one.
bool stands(const std::string& text, const std::string& name) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if (end == text.size() || (std::isalnum(static_cast<unsigned char>(text[end])) == 0 && text[end] != '_'))
            return true;
    }
    return false;
}

}  // namespace

TEST_CASE("words: no screen has words of its own") {
    static const std::regex literals("\"((?:[^\"\\\\]|\\\\.)*)\"|'((?:[^'\\\\]|\\\\.)*)'|`((?:[^`\\\\]|\\\\.)*)`");
    static const std::regex comment("(^|[^:])//.*$");
    const std::vector<fs::path> sources = sources_of_screens();
    REQUIRE(sources.size() > 10);
    for (const fs::path& source : sources) {
        CAPTURE(source.filename().string());
        int number = 0;
        const std::string text = read_text(source);
        for (const std::string_view whole : fields_of(text, '\n')) {
            ++number;
            const std::string line = std::regex_replace(std::string(whole), comment, "$1");
            if (line.rfind("#include", 0) == 0 || is_other(line)) continue;
            for (std::sregex_iterator it(line.begin(), line.end(), literals), end; it != end; ++it) {
                const std::string literal = (*it)[1].str() + (*it)[2].str() + (*it)[3].str();
                CAPTURE(number);
                CAPTURE(literal);
                CHECK_FALSE(is_prose(literal));
            }
        }
    }
}

TEST_CASE("words: every word is shown somewhere") {
    std::string all;
    for (const auto& entry : fs::recursive_directory_iterator(kApp)) {
        const std::string name = entry.path().filename().string();
        if (ends_with(name, ".cpp") || ends_with(name, ".js") || ends_with(name, ".html"))
            all += read_text(entry.path());
    }
    const std::string words = read_text(kApp / "screens" / "words.h");
    static const std::regex constant("const char\\* (k|page)([A-Za-z0-9]+) =");
    int found = 0;
    for (std::sregex_iterator it(words.begin(), words.end(), constant), end; it != end; ++it, ++found) {
        std::string name = (*it)[2].str();
        const bool page = (*it)[1] == "page";
        if (page) name[0] = static_cast<char>(std::tolower(name[0]));
        CAPTURE(name);
        CHECK((page ? stands(all, "palpaWords." + name) || stands(all, "data-word=\"" + name) ||
                          stands(all, "data-label=\"" + name)
                    : stands(all, "words::k" + name)));
    }
    CHECK(found > 150);
}

TEST_CASE("words: the history tells the time of the clock on the wall") {
    const char* zone = ::getenv("TZ");
    const std::string before = zone != nullptr ? zone : "";
    ::setenv("TZ", "EST5", 1);
    ::tzset();
    CHECK(local_time_text("2026-11-25T03:31:09Z") == "2026-11-24 22:31");
    CHECK(local_time_text("some day") == "some day");
    zone != nullptr ? ::setenv("TZ", before.c_str(), 1) : ::unsetenv("TZ");
    ::tzset();
}

TEST_CASE("words: the history counts nodules, and does not count to 0 where there are none") {
    session::KeptTrial trial;
    trial.false_positives = 2;
    CHECK(found_text(trial) == "No nodules, false positives: 2");
    trial.nodules.resize(3);
    trial.found = 1;
    CHECK(found_text(trial) == "Found 1 of 3, false positives: 2");
}
