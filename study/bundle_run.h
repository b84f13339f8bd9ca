#pragma once
// The files of one run as a bundle (docs/formats.md): what a tablet keeps, sends to the desk and exports.
//     {"palpa_bundle": 1, "files": [{"name": "sub-01/beh/...", "sha256": "64 hex digits", "text": "..."}]}

#include <string>

#include "study/sample_log.h"

namespace palpa {

// As they are on the disk now. Throws InputError for a file that cannot be read.
std::string bundle_text(const RunFiles& run);

}  // namespace palpa
