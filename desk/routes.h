#pragma once
// What the desk answers to each request: routes and who may take them.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "desk/events.h"
#include "desk/pairing.h"
#include "desk/serve.h"
#include "desk/server.h"
#include "desk/uploads.h"

namespace palpa::desk {

struct Desk {
    const ServeOptions& options;
    bool pairs = false;           // whether tablets must type a code
    X509* certificate = nullptr;  // the desk answers to its names; nullptr without TLS
    CodeGuard codes;
    Sessions sessions;
    std::optional<Uploads> uploads;  // empty if the desk takes no logs
    DeskEvents events;
};

// Sets all handlers of the server. `desk` must outlive the server.
void set_routes(Desk& desk, DeskServer& server);

// Whether the text of the header Host names this desk: an IP address, localhost, or a name of its certificate. Any other
// name may come from a foreign page that reaches the desk by DNS rebinding.
bool own_host(std::string_view host, X509* certificate);

// Returns {"scenes": [{"path": "/files/scenes/default.json", "bytes": 1}], "maps": [{"name": "silicone.map", "files": [...]}],
// "profiles": ..., "phantoms": ..., "protocols": ...}; links and hidden files are left out.
files::Json files_json(const std::filesystem::path& assets);

}  // namespace palpa::desk
