#pragma once
// Keys of a protocol that are well-formed and would have no effect: a person who wrote them expects one.

#include "files/json.h"
#include "study/protocol.h"

namespace palpa::study {

// Whether a condition has this task.
bool any_task(const Protocol& protocol, TaskKind task);

// Throws InputError for a key that this protocol would ignore, for a task without its settings, and for a condition in
// no group. `json`: the protocol's file.
void refuse_ignored_keys(const files::JsonReader& json, const Protocol& protocol);

// Throws InputError for ratings of conditions whose trials are mixed: ratings are of a condition whose trials have just been
// done. For what comes before a study; the logs of an older one are read nevertheless.
void refuse_mixed_ratings(const Protocol& protocol);

}  // namespace palpa::study
