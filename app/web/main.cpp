// The app in a browser: one canvas, one thread, a turn of the loop per frame of the display.

#include <algorithm>
#include <cctype>
#include <emscripten.h>
#include <emscripten/html5.h>
#include <exception>
#include <filesystem>
#include <memory>
#include <set>
#include <stdlib.h>
#include <string>

#include "app/live/live.h"
#include "app/screens/settings.h"
#include "app/web/browser_keeper.h"
#include "calibration/profile_file.h"
#include "files/input_error.h"
#include "platform/web/browser.h"
#include "scene/scene.h"
#include "study/protocol.h"

// clang-format off
EM_JS(void, palpa_page_fail, (const char* message), { palpaPage.fail(UTF8ToString(message)); });
EM_JS(void, palpa_page_refuse, (const char* message), { palpaPage.refuse(UTF8ToString(message)); });
EM_JS(void, palpa_page_type, (const char* text, double x, double y, double width, double height), {
    palpaPage.type(UTF8ToString(text), x, y, width, height);
});
EM_JS(void, palpa_page_type_end, (), { palpaPage.typeEnd(); });
EM_JS(void, palpa_page_leave, (), { palpaStudies.leave(); });
EM_JS(void, palpa_page_started, (), { palpaPage.started(); });
// clang-format on

namespace {

using namespace palpa;
using namespace palpa::app;

struct Page {
    BrowserKeeper keeper;
    std::unique_ptr<Live> live;
    bool gl_lost = false;
    bool started = false;
    bool types = false;  // the page's own text field is open
    std::string report;
};
Page page;  // the browser calls functions, not objects

void stop(const char* message) {
    emscripten_cancel_main_loop();
    palpa_page_fail(message);
}

// Opens and closes the page's own text field, since a tablet shows its keyboard only for fields of the page.
void follow_typing() {
    if (!platform::browser::has_touch_screen()) return;
    const auto field = page.live->text_field();
    if (field) {
        const double scale = 1.0 / platform::browser::px_per_css_px();
        const PanelArea& area = field->area;
        const auto css = [&](float px) { return scale * static_cast<double>(px); };
        palpa_page_type(field->text.c_str(), css(area.x0), css(area.y0), css(area.width()), css(area.height()));
    }
    if (!field && page.types) palpa_page_type_end();
    page.types = field.has_value();
}

void frame() {
    try {
        if (!page.live->turn(page.gl_lost ? Live::Draw::nothing : Live::Draw::now)) {  // the study was left
            emscripten_cancel_main_loop();
            return palpa_page_leave();
        }
        follow_typing();
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
    return EM_TRUE;  // asks the browser to restore it
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

// Returns the folder of one version of one protocol, in which earlier participants continue.
std::string study_folder(const std::string& name, const study::Protocol& protocol) {
    std::string folder = name + "-" + protocol.version;
    std::replace_if(
        folder.begin(), folder.end(), [](unsigned char c) { return c >= 128 || std::isalnum(c) == 0; }, '-');
    return "/studies/" + folder;
}

// Conditions that drive a device or read a pen's counts need the desk; the menu does not offer them either (studies.js).
bool needs_desk(const std::filesystem::path& protocol) {
    const auto drives = [](const study::Condition& condition) {
        const bool device =
            condition.modality == study::Modality::shape_display || condition.modality == study::Modality::tangible;
        return device && !condition.scene.empty();
    };
    const auto reads_counts = [](const study::Condition& condition) {
        if (condition.scene.empty()) return false;
        try {
            const std::filesystem::path assets = "/assets";
            const scene::Scene scene = scene::read_scene(assets / "scenes" / condition.scene, assets);
            const auto profile = condition.profile.empty() ? scene.profile : assets / "profiles" / condition.profile;
            return calibration::read_profile(profile).level == calibration::LevelField::pressure_raw;
        } catch (const files::InputError&) {
            return false;  // whoever chooses it is told what is wrong
        }
    };
    const study::Protocol read = study::read_protocol(protocol);
    return std::any_of(read.conditions.begin(), read.conditions.end(),
                       [&](const study::Condition& one) { return drives(one) || reads_counts(one); });
}

// Chooses the study that the page's address names. Throws InputError if there is none of that name.
void choose_study(const std::string& name, RunOptions& options) {
    const std::filesystem::path folder = "/assets/protocols";
    const std::filesystem::path file = folder / (name + ".json");
    if (name.find('/') != std::string::npos || !std::filesystem::exists(file)) {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (!needs_desk(entry.path())) names.insert(entry.path().stem().string());
        }
        std::string known;
        for (const std::string& one : names) known += " " + one;
        throw files::bad_input("?protocol", "", files::shown(name),
                               "one of" + known + ", or of a desk that this tablet is paired with");
    }
    options.protocol = file.string();
    options.log = study_folder(name, study::read_protocol(file));
}

}  // namespace

extern "C" {

// Called by the page with the text of its own field.
EMSCRIPTEN_KEEPALIVE void palpa_type(const char* text) {
    if (page.live) page.live->type_instead(text);
}

// Returns what `palpa run --json` would print now; for tests and for inspection.
EMSCRIPTEN_KEEPALIVE const char* palpa_report() {
    page.report = page.live ? files::json_text(page.live->report()) : "{}";
    return page.report.c_str();
}
}

int main() {
    std::string protocol;
    try {
        setenv("PALPA_ASSETS", "/assets", 1);
        setenv("HOME", "/home/web_user", 1);
        restore_settings(settings_file());
        restore_studies();
        protocol = protocol_here();
        RunOptions options;
        options.log = "/logs";
        options.participant = participant_here();
        options.first_run = next_run_here();
        if (!protocol.empty()) choose_study(protocol, options);
        page.live = std::make_unique<Live>(options, &page.keeper);
        emscripten_set_visibilitychange_callback(nullptr, false, visibility);
        emscripten_set_webglcontextlost_callback("#canvas", nullptr, false, gl_lost);
        emscripten_set_webglcontextrestored_callback("#canvas", nullptr, false, gl_restored);
        emscripten_set_main_loop(frame, 0, false);
    } catch (const files::InputError& error) {
        protocol.empty() ? palpa_page_fail(error.what()) : palpa_page_refuse(error.what());
        return 1;
    } catch (const std::exception& error) {
        palpa_page_fail(error.what());
        return 1;
    }
    return 0;
}
