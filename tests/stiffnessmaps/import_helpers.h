#pragma once
// Recordings written by a test, and what importing them says.

#include <filesystem>

#include "files/text.h"
#include "stiffnessmaps/import/import.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

inline stiffnessmaps::Map imported(const std::string& text, const stiffnessmaps::ImportOptions& options = {},
                                   stiffnessmaps::ImportReport* report = nullptr) {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "r.csv", text);
    stiffnessmaps::ImportReport unused;
    return stiffnessmaps::import_recording({folder / "r.csv"}, options, report != nullptr ? *report : unused);
}

inline std::string refusal(const std::string& text, const stiffnessmaps::ImportOptions& options = {}) {
    return message_of([&] { imported(text, options); });
}

// A recording beside the checkout; empty if it is not there.
inline std::filesystem::path recording(const std::string& name) {
    const std::filesystem::path file = std::filesystem::path(PALPA_RECORDINGS) / name;
    return std::filesystem::exists(file) ? file : std::filesystem::path();
}

inline const stiffnessmaps::SourceChoice* choice_of(const stiffnessmaps::Map& map, const std::string& key) {
    for (const stiffnessmaps::SourceChoice& choice : map.source.choices) {
        if (choice.key == key) return &choice;
    }
    return nullptr;
}

}  // namespace palpa::test
