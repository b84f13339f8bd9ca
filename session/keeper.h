#pragma once
// Keeps trials in a second place besides the folder that they are written to, since in a browser that folder is only in
// memory.

#include <filesystem>
#include <string>

#include "study/sample_log.h"

namespace palpa::session {

class TrialKeeper {
  public:
    virtual ~TrialKeeper() = default;

    // Copies the files of a run as they are now. finished: nothing more will be written to them.
    virtual void keep(const study::RunFiles& files, bool finished) = 0;
    // Copies what was written since the last call, for a trial that is going on. Cheap enough to call every second.
    virtual void keep_part(const study::RunFiles& files) = 0;
    // Copies the list of participants of the study in `directory`, and what participant `code` has answered so far.
    virtual void keep_answers(const std::filesystem::path& directory, const std::string& code) = 0;
    virtual void participant(const std::string& code) = 0;  // says who is here now; "" for nobody
    virtual bool ready() const = 0;                         // true if everything that was handed over is stored
    virtual std::string problem() = 0;  // why something could not be stored, for people; each problem once, then ""
    virtual std::string solved() = 0;   // a problem that is none any more, since it is stored now; each once, then ""
    virtual std::string note() const = 0;                          // what is kept, for people
    virtual std::string where(const std::string& code) const = 0;  // where a participant's trials are; "": not known
    virtual void keep_settings(const std::filesystem::path& file) = 0;  // copies the file of the app's settings
    virtual void keep_design(const std::filesystem::path& file) = 0;    // copies a part file that a person has changed
    virtual bool keeps_designs() const { return true; }                 // false: for some of those there is no room
    virtual void offer(const std::filesystem::path& file) = 0;  // gives the person a copy of a file, to take away
    virtual void open() = 0;                                    // shows the person all that is kept
    virtual void open_studies() = 0;                            // lets the person choose a study
};

}  // namespace palpa::session
