// Saves a picture of the screen as a download of the browser. Must be called right after the frame was drawn, while the
// canvas still holds it.

#include "app/screens/screenshot.h"

#include <ctime>
#include <emscripten.h>

#include "app/screens/frame.h"

// Called right after the frame was drawn, while the canvas still holds it.
// clang-format off
EM_JS(void, palpa_download_canvas, (const char* name), {
    const file = UTF8ToString(name);
    Module.canvas.toBlob((picture) => {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(picture);
        link.download = file;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    }, 'image/png');
});
// clang-format on

namespace palpa::app {

void save_screen(const platform::Window&, const std::filesystem::path& png) {
    palpa_download_canvas(png.filename().c_str());
}

std::filesystem::path save_picture(const platform::Window& window, const std::string&) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[40];
    std::strftime(text, sizeof text, "palpa-%Y%m%d-%H%M%S.png", &local);
    save_screen(window, text);
    return text;
}

}  // namespace palpa::app
