#pragma once
// Trials and settings in the browser's own storage (app/web/trials.js), from where they go to the desk.

#include "app/trial_keeper.h"

namespace palpa {

class BrowserKeeper : public TrialKeeper {
 public:
    void keep(const RunFiles& run, bool finished) override;
    bool ready() const override;
    std::string problem() override;
    std::string note() const override;
    void keep_settings(const std::filesystem::path& file) override;
    void open() override;
};

// Whose trials these are: as the page's address says (?participant=07), else a code of this tablet's own. And the first run
// that this tablet has never given to anybody.
std::string participant_here();
int next_run_here();

// Puts the settings of last time where the app looks for them.
void restore_settings(const std::filesystem::path& file);

}  // namespace palpa
