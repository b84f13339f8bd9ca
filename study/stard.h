#pragma once
// A form for reporting a study of accuracy by STARD 2015 (Bossuyt et al., BMJ 351 (2015) h5527: 30 items) and its extension
// for simulation-based research (Cheng et al., Adv. Simul. 1 (2016) 25). The items are named in our words; what the protocol
// and the report know is filled in, the rest is left to the authors.

#include <string>

#include "study/protocol.h"
#include "study/report.h"

namespace palpa::study {

// In Markdown. `protocol`: null where the results are a table, which has none.
std::string stard_checklist(const Report& report, const Protocol* protocol);

}  // namespace palpa::study
