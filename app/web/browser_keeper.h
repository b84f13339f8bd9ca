#pragma once
// Keeps trials and settings in the browser's own storage (app/web/trials.js), from where they go to the desk.

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
    std::string solved() override;
    std::string note() const override;
    std::string where(const std::string& code) const override;
    void keep_settings(const std::filesystem::path& file) override;
    void keep_design(const std::filesystem::path& file) override;
    bool keeps_designs() const override;
    void offer(const std::filesystem::path& file) override;
    void open() override;
    void open_studies() override;

  private:
    std::map<std::string, std::size_t> parts_;  // of the present run: file -> number of bytes kept
};

// participant_here() returns the participant's code from the page's address (?participant=07), else this tablet's own.
// next_run_here() returns the first run number that this tablet has never given to anybody.
std::string participant_here();
std::string protocol_here();  // ?protocol=NAME, without folder and ending; empty: no study
int next_run_here();

// Puts the files of studies and the changed parts that earlier pages left, and the desk's files of the requested study,
// where the app looks for them. A trial that was in progress when its page ended is kept as interrupted.
void restore_studies();

// Puts the settings of the last run where the app looks for them.
void restore_settings(const std::filesystem::path& file);

}  // namespace palpa::app
