#pragma once
// What a study's own files say about how its results are compared.

#include <vector>

#include "study/observations.h"
#include "study/protocol.h"
#include "study/study_folder.h"

namespace palpa::study {

// Brings the conditions and the groups into the order of the protocol, so that the sign of a difference does not depend on which log
// was read first, and takes over the comparison that the protocol states. What the protocol does not name
// stands last.
void follow_protocol(const Protocol& protocol, Observations& seen);

// Gives each participant the group of participants.tsv.
void take_groups(const std::vector<Person>& people, Observations& seen);

}  // namespace palpa::study
