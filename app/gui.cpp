#include "app/gui.h"

#include <GLES3/gl3.h>
#include <SDL.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>

namespace palpa {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

void load_font(float height_px) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    ImFontConfig embedded;
    embedded.SizePixels = height_px;
    if (std::filesystem::exists(kFont)) {
        fonts.AddFontFromFileTTF(kFont, height_px);
    } else {
        fonts.AddFontDefault(&embedded);
    }
}

}  // namespace

Gui::Gui(Window& window) : window_(window) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    scale_ = std::clamp(static_cast<float>(std::min(window.width_px(), window.height_px())) / 800.0f, 0.8f, 2.0f);
    constexpr float kText_px = 18.0f;
    load_font(kText_px * scale_);
    ImGui::GetStyle().ScaleAllSizes(scale_);
    ImGui::GetStyle().WindowRounding = 6.0f * scale_;
    ImGui_ImplOpenGL3_Init("#version 300 es");
    window.set_event_filter(&Gui::filter, this);
}

Gui::~Gui() {
    window_.set_event_filter(nullptr, nullptr);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

bool Gui::owns(float x_px, float y_px) const {
    return std::any_of(areas_.begin(), areas_.end(), [&](const PanelArea& a) {
        return x_px >= a.x0 && x_px < a.x1 && y_px >= a.y0 && y_px < a.y1;
    });
}

bool Gui::filter(const SDL_Event& event, void* self) {
    Gui& gui = *static_cast<Gui*>(self);
    ImGuiIO& io = ImGui::GetIO();
    const auto width = static_cast<float>(gui.window_.width_px());
    const auto height = static_cast<float>(gui.window_.height_px());
    switch (event.type) {
        case SDL_MOUSEMOTION:
            io.MousePos = ImVec2(static_cast<float>(event.motion.x), static_cast<float>(event.motion.y));
            return false;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            io.MousePos = ImVec2(static_cast<float>(event.button.x), static_cast<float>(event.button.y));
            io.MouseDown[0] = event.type == SDL_MOUSEBUTTONDOWN;
            return gui.owns(io.MousePos.x, io.MousePos.y);
        case SDL_FINGERDOWN:
        case SDL_FINGERMOTION:
        case SDL_FINGERUP:
            io.MousePos = ImVec2(event.tfinger.x * width, event.tfinger.y * height);
            io.MouseDown[0] = event.type != SDL_FINGERUP;
            return gui.owns(io.MousePos.x, io.MousePos.y);
        case SDL_MOUSEWHEEL: return gui.owns(io.MousePos.x, io.MousePos.y);
        default: return false;
    }
}

void Gui::begin_frame(double dt_s) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(window_.width_px()), static_cast<float>(window_.height_px()));
    io.DeltaTime = std::max(1e-4f, static_cast<float>(dt_s));
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    areas_.clear();
}

void Gui::end_frame() { ImGui::Render(); }

void Gui::draw() {
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    while (glGetError() != GL_NO_ERROR) {
        // the packaged backend asks desktop GL questions that OpenGL ES answers with an error
    }
}

}  // namespace palpa
