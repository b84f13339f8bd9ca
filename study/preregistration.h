#pragma once
// The preregistration sheet of a study, in Markdown: what its protocol fixes before anybody takes part, with the hashes by
// which a reader checks that nothing was changed. What a registry asks for and the protocol does not state is listed first.

#include <string>
#include <vector>

#include "files/json.h"
#include "study/protocol.h"

namespace palpa::study {

struct SheetOptions {
    int participants = 0;  // whose orders are listed; 0: as many as the protocol plans, else one full round
    std::string program;   // name and version
    std::vector<files::Json>
        identities;  // by condition: hashes of the files that its trials are made from; may be empty
};

std::string preregistration_sheet(const Protocol& protocol, const SheetOptions& options);

// What the protocol does not state: keys and what they are for. Empty if nothing is missing.
std::vector<std::string> missing_statements(const Protocol& protocol);

}  // namespace palpa::study
