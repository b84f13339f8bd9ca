#pragma once
// The desk hands the web app, scenes, maps, profiles and protocols to tablets and collects their logs. docs/serve.md
// describes the protocol.

#include <filesystem>
#include <string>

#include "desk/pairing.h"
#include "desk/time_limits.h"
#include "desk/uploads.h"

namespace palpa::desk {

struct ServeOptions {
    std::string bind = "127.0.0.1";
    int port = 8443;  // 0 chooses any free port
    std::string tls_cert;
    std::string tls_key;
    std::string collect;           // folder for logs; empty if the desk takes none
    std::filesystem::path web;     // folder of the web app; empty if there is none
    std::filesystem::path assets;  // with scenes, maps, profiles, phantoms, protocols
    Patience patience;
    TryLimits tries;
    SessionLimits sessions;
    UploadLimits uploads;
    bool json = false;
};

// Returns the folder in which a build has left the web app (index.html), beside `program` or above; empty if there is none.
std::filesystem::path web_folder_beside(const std::filesystem::path& assets);

// Serves until SIGINT or SIGTERM. Throws InputError for impossible options, std::runtime_error if it cannot listen.
void serve(const ServeOptions& options);

}  // namespace palpa::desk
