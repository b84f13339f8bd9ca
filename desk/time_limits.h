#pragma once

namespace palpa::desk {

// How long the desk waits for a client.
struct Patience {
    double wait_s = 20.0;                 // for a handshake, a head, or the next bytes of a body or an answer
    double idle_s = 5.0;                  // between two requests
    double slowest_bytes_per_s = 2000.0;  // of bodies and answers, beyond twice wait_s
    double end_s = 3.0;                   // for requests that are under way when the desk ends
};

}  // namespace palpa::desk
