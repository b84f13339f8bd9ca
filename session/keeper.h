#pragma once
// Where trials go besides the folder that they are written to. In a browser that folder is memory, and this keeps them.

#include <filesystem>
#include <string>

#include "study/sample_log.h"

namespace palpa::session {

class TrialKeeper {
  public:
    virtual ~TrialKeeper() = default;

    // Copies the files of a run as they are now. finished: no more will be written to them.
    virtual void keep(const study::RunFiles& files, bool finished) = 0;
    // The same for a trial that is going on; only what is new since the last call is copied. Cheap: for every second.
    virtual void keep_part(const study::RunFiles& files) = 0;
    // Of a study in `directory`: who takes part, and what they have answered so far.
    virtual void keep_answers(const std::filesystem::path& directory, const std::string& code) = 0;
    virtual void participant(const std::string& code) = 0;  // who is here now; "": nobody
    virtual bool ready() const = 0;                         // all that was given is safe
    virtual std::string problem() = 0;                      // why something is not, for people; each once, then ""
    virtual std::string note() const = 0;                   // what is kept, for people
    virtual void keep_settings(const std::filesystem::path& file) = 0;
    virtual void open() = 0;          // shows the person all that is kept
    virtual void open_studies() = 0;  // lets the person choose one
};

}  // namespace palpa::session
