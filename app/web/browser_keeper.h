#pragma once
// Trials and settings in the browser's own storage (app/web/trials.js), from where they go to the desk.

#include <map>

#include "session/keeper.h"

namespace palpa::app {

class BrowserKeeper : public session::TrialKeeper {
  public:
    void keep(const study::RunFiles& run, bool finished) override;
    void keep_part(const study::RunFiles& run) override;
    void keep_answers(const std::filesystem::path& directory, const std::string& code) override;
    void participant(const std::string& code) override;
    bool ready() const override;
    std::string problem() override;
    std::string note() const override;
    void keep_settings(const std::filesystem::path& file) override;
    void open() override;
    void open_studies() override;

  private:
    std::map<std::string, std::size_t> parts_;  // of the run that is going on: file and how much of it is kept
};

// The participant's code: from the page's address (?participant=07), else this tablet's own. And the first run number
// that this tablet has never given to anybody.
std::string participant_here();
std::string protocol_here();  // ?protocol=NAME, without its folder and ending; empty: no study
int next_run_here();

// Puts the files of studies that earlier pages left, and the desk's files of the study that is asked for, where the app
// looks for them. A trial that was going on when its page ended is kept as interrupted.
void restore_studies();

// Puts the settings of the last run where the app looks for them.
void restore_settings(const std::filesystem::path& file);

}  // namespace palpa::app
