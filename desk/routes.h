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
    bool pairs = false;           // a code is asked for
    X509* certificate = nullptr;  // whose names the desk answers to; nullptr without TLS
    CodeGuard codes;
    Sessions sessions;
    std::optional<Uploads> uploads;  // nothing: takes no logs
    DeskEvents events;
};

// Sets all handlers. `desk` must outlive the server.
void set_routes(Desk& desk, DeskServer& server);

// A host as it stands in the header Host is the desk's own: an IP address, localhost, or a name of its certificate.
// Other names are how foreign pages reach a desk by a name service that lies.
bool own_host(std::string_view host, X509* certificate);

// {"scenes": [{"path": "/files/scenes/default.json", "bytes": 1}], "maps": [{"name": "silicone.map", "files": [...]}],
// "profiles": ..., "phantoms": ..., "protocols": ...}; links and hidden files are left out.
files::Json files_json(const std::filesystem::path& assets);

}  // namespace palpa::desk
