#pragma once
// The desk: hands the web app, scenes, maps, profiles and protocols to tablets and collects their logs. docs/serve.md
// says what goes over the wire.

#include <filesystem>
#include <string>

#include "desk/pairing.h"
#include "desk/time_limits.h"
#include "desk/uploads.h"

namespace palpa::desk {

struct ServeOptions {
    std::string bind = "127.0.0.1";
    int port = 8443;  // 0: any that is free
    std::string tls_cert;
    std::string tls_key;
    std::string collect;           // empty: takes no logs
    std::filesystem::path web;     // empty: none is there
    std::filesystem::path assets;  // with scenes, maps, profiles, phantoms, protocols
    Patience patience;
    TryLimits tries;
    SessionLimits sessions;
    UploadLimits uploads;
    bool json = false;
};

// Where a build in `program`'s folder or above has left the web app (index.html); empty if there is none.
std::filesystem::path web_folder_beside(const std::filesystem::path& assets);

// Serves until SIGINT or SIGTERM. Throws InputError for options that cannot be, std::runtime_error if it cannot listen.
void serve(const ServeOptions& options);

}  // namespace palpa::desk
