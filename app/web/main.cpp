// The app in a browser: one canvas, one thread, a turn of the loop per frame of the display.

#include <emscripten.h>
#include <emscripten/html5.h>
#include <stdlib.h>

#include <exception>
#include <memory>
#include <string>

#include "app/live.h"
#include "app/settings.h"
#include "app/web/browser_keeper.h"

// clang-format off
EM_JS(void, palpa_page_fail, (const char* message), { palpaPage.fail(UTF8ToString(message)); });
EM_JS(void, palpa_page_started, (), { palpaPage.started(); });
// clang-format on

namespace {

using namespace palpa;

struct Page {
    BrowserKeeper keeper;
    std::unique_ptr<Live> live;
    bool gl_lost = false;
    bool started = false;
    std::string report;
};
Page page;  // the browser calls functions, not objects

void stop(const char* message) {
    emscripten_cancel_main_loop();
    palpa_page_fail(message);
}

void frame() {
    try {
        page.live->turn(page.gl_lost ? Live::Draw::nothing : Live::Draw::now);
        if (!page.started) palpa_page_started();
        page.started = true;
    } catch (const std::exception& error) {
        stop(error.what());
    }
}

EM_BOOL visibility(int, const EmscriptenVisibilityChangeEvent* event, void*) {
    try {
        page.live->out_of_sight(event->hidden);
    } catch (const std::exception& error) {
        stop(error.what());
    }
    return EM_FALSE;
}

EM_BOOL gl_lost(int, const void*, void*) {
    page.gl_lost = true;
    return EM_TRUE;  // it is wanted back
}

EM_BOOL gl_restored(int, const void*, void*) {
    try {
        page.live->renew_drawing();
        page.gl_lost = false;
    } catch (const std::exception& error) {
        stop(error.what());
    }
    return EM_TRUE;
}

}  // namespace

extern "C" {

// What `palpa run --json` would print now; for tests and for the curious.
EMSCRIPTEN_KEEPALIVE const char* palpa_report() {
    page.report = page.live ? json_text(page.live->report()) : "{}";
    return page.report.c_str();
}

}

int main() {
    try {
        setenv("PALPA_ASSETS", "/assets", 1);
        setenv("HOME", "/home/web_user", 1);
        restore_settings(settings_file());
        RunOptions options;
        options.log = "/logs";
        options.participant = participant_here();
        options.first_run = next_run_here();
        page.live = std::make_unique<Live>(options, &page.keeper);
        emscripten_set_visibilitychange_callback(nullptr, false, visibility);
        emscripten_set_webglcontextlost_callback("#canvas", nullptr, false, gl_lost);
        emscripten_set_webglcontextrestored_callback("#canvas", nullptr, false, gl_restored);
        emscripten_set_main_loop(frame, 0, false);
    } catch (const std::exception& error) {
        palpa_page_fail(error.what());
        return 1;
    }
    return 0;
}
