#include "app/screens/gui.h"

#include <GLES3/gl3.h>
#include <algorithm>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <stdexcept>
#include <utility>

#include "app/screens/content_hash.h"
#include "app/screens/font.h"

namespace palpa::app {
namespace {

constexpr float kText_mm = 4.7f;  // line height, readable at arm's length
constexpr float kNowhere_px = -1e6f;
constexpr int kNotHeld = -1;

void map_keys(ImGuiIO& io) {
    struct Pair {
        ImGuiKey_ gui;
        int key;
    };
    constexpr Pair kPairs[] = {{ImGuiKey_Tab, platform::key::tab},
                               {ImGuiKey_LeftArrow, platform::key::left},
                               {ImGuiKey_RightArrow, platform::key::right},
                               {ImGuiKey_UpArrow, platform::key::up},
                               {ImGuiKey_DownArrow, platform::key::down},
                               {ImGuiKey_PageUp, platform::key::page_up},
                               {ImGuiKey_PageDown, platform::key::page_down},
                               {ImGuiKey_Home, platform::key::home},
                               {ImGuiKey_End, platform::key::end},
                               {ImGuiKey_Delete, platform::key::del},
                               {ImGuiKey_Backspace, platform::key::backspace},
                               {ImGuiKey_Space, platform::key::space},
                               {ImGuiKey_Enter, platform::key::enter},
                               {ImGuiKey_Escape, platform::key::escape},
                               {ImGuiKey_KeyPadEnter, platform::key::pad_enter},
                               {ImGuiKey_A, 'a'}};
    static_assert(platform::key::count <= IM_ARRAYSIZE(ImGuiIO::KeysDown));
    for (const Pair& pair : kPairs) io.KeyMap[pair.gui] = pair.key;
}

ImVec4 colour(int r, int g, int b, float alpha = 1.0f) {
    return {static_cast<float>(r) / 255.0f, static_cast<float>(g) / 255.0f, static_cast<float>(b) / 255.0f, alpha};
}

// The panels are grey, so that only tissue and force have a hue.
void set_colours(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = colour(236, 239, 241);
    c[ImGuiCol_TextDisabled] = colour(180, 188, 194);
    c[ImGuiCol_WindowBg] = colour(28, 31, 34);
    c[ImGuiCol_Button] = colour(62, 69, 75);
    c[ImGuiCol_ButtonHovered] = colour(80, 89, 97);
    c[ImGuiCol_ButtonActive] = colour(104, 116, 126);
    c[ImGuiCol_FrameBg] = colour(48, 53, 58);
    c[ImGuiCol_FrameBgHovered] = colour(62, 69, 75);
    c[ImGuiCol_FrameBgActive] = colour(80, 89, 97);
    c[ImGuiCol_Header] = colour(62, 69, 75);
    c[ImGuiCol_HeaderHovered] = colour(80, 89, 97);
    c[ImGuiCol_HeaderActive] = colour(104, 116, 126);
    c[ImGuiCol_CheckMark] = colour(130, 200, 240);
    c[ImGuiCol_SliderGrab] = colour(130, 200, 240);
    c[ImGuiCol_NavHighlight] = colour(255, 214, 90);
    c[ImGuiCol_Separator] = colour(70, 76, 82);
    c[ImGuiCol_PlotHistogram] = colour(130, 200, 240);
}

}  // namespace

Gui::Gui(platform::Window& window) : window_(window), font_file_(system_font_file()) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    held_as_.fill(kNotHeld);
    map_keys(io);
    if (!ImGui_ImplOpenGL3_Init("#version 300 es"))
        throw std::runtime_error("the panels cannot be drawn: Dear ImGui found no OpenGL (libGL)");
    set_scale(control_scale(platform::kMissing, static_cast<float>(window.width_px()),
                            static_cast<float>(window.height_px())));
    window.set_event_filter(&Gui::filter, this);
}

Gui::~Gui() {
    window_.set_event_filter(nullptr, nullptr);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

namespace {

// Latin letters beyond those of Western Europe, dashes, quotation marks, bullet, ellipsis and euro.
constexpr ImWchar kEurope[] = {0x100, 0x17f, 0x218, 0x21b, 0x2010, 0x2027, 0x20ac, 0x20ac, 0};
constexpr ImWchar kGreek[] = {0x370, 0x3ff, 0};
constexpr ImWchar kCyrillic[] = {0x400, 0x4ff, 0};

// Who is asked in an alphabet answers in that alphabet, with any of its letters.
void add_begun(const ImWchar (&alphabet)[3], ImFontGlyphRangesBuilder& builder) {
    bool begun = false;
    for (std::size_t letter = alphabet[0]; letter <= alphabet[1]; ++letter) begun = begun || builder.GetBit(letter);
    if (begun) builder.AddRanges(alphabet);
}

}  // namespace

void Gui::add_letters(const std::string& texts) {
    texts_ += texts;
    mm_ = 0.0f;
    if (hand_mm_ > 0.0f) set_scale(hand_mm_, text_scale_);
}

void Gui::set_scale(float px_per_mm, float text) {
    hand_mm_ = px_per_mm;
    text_scale_ = text;
    const float mm =
        larger_scale(px_per_mm, text, static_cast<float>(window_.width_px()), static_cast<float>(window_.height_px()));
    if (mm == mm_) return;
    mm_ = mm;
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    const float text_px = std::clamp(kText_mm * mm_, 11.0f, 120.0f);
    ImVector<ImWchar> letters;  // needed until the texture is made
    ImFontGlyphRangesBuilder builder;
    builder.AddRanges(fonts.GetGlyphRangesDefault());
    builder.AddRanges(kEurope);
    builder.AddText(texts_.c_str());
    add_begun(kGreek, builder);
    add_begun(kCyrillic, builder);
    builder.BuildRanges(&letters);
    if (font_file_.empty()) {
        ImFontConfig embedded;
        embedded.SizePixels = text_px;
        fonts.AddFontDefault(&embedded);
    } else {
        fonts.AddFontFromFileTTF(font_file_.c_str(), text_px, nullptr, letters.Data);
    }
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    ImGuiStyle style;
    style.ScaleAllSizes(mm_ / 3.78f);
    style.WindowRounding = 0.0f;
    style.FrameRounding = 1.2f * mm_;
    style.ScrollbarSize = 5.0f * mm_;
    style.ItemSpacing = ImVec2(1.8f * mm_, 1.8f * mm_);
    style.WindowPadding = ImVec2(2.6f * mm_, 2.6f * mm_);
    style.WindowBorderSize = 0.0f;
    set_colours(style);
    ImGui::GetStyle() = style;
}

bool Gui::owns(float x_px, float y_px) const {
    return std::any_of(areas_.begin(), areas_.end(), [&](const PanelArea& area) { return area.holds(x_px, y_px); });
}

bool Gui::filter(const platform::WindowEvent& event, void* self) { return static_cast<Gui*>(self)->receive(event); }

bool Gui::receive(const platform::WindowEvent& event) {
    using Kind = platform::WindowEvent::Kind;
    switch (event.kind) {
        case Kind::pointer_move:
            if (event.made_from_touch) return false;
            pointer_x_px_ = static_cast<float>(event.x_px);
            pointer_y_px_ = static_cast<float>(event.y_px);
            return false;
        case Kind::button_down:
        case Kind::button_up:
            return receive_button(event);
        case Kind::wheel:
            if (!owns(pointer_x_px_, pointer_y_px_)) return false;
            ImGui::GetIO().MouseWheel += static_cast<float>(event.notches);
            return true;
        case Kind::finger_down:
        case Kind::finger_move:
        case Kind::finger_up:
            return receive_finger(event);
        case Kind::key_down:
        case Kind::key_up:
            return receive_key(event);
        case Kind::text: {
            PanelInput input{PanelInput::Kind::text};
            input.text = event.text;
            wait_for_frame(std::move(input), waiting_);
            return false;
        }
    }
    return false;
}

bool Gui::receive_button(const platform::WindowEvent& event) {
    const auto x = static_cast<float>(event.x_px);
    const auto y = static_cast<float>(event.y_px);
    const bool owned = owns(x, y);
    if (event.made_from_touch) return owned;
    pointer_x_px_ = x;
    pointer_y_px_ = y;
    const bool down = event.kind == platform::WindowEvent::Kind::button_down;
    if (down ? owned : mouse_on_panel_) wait_for_frame({PanelInput::Kind::button, down, x, y}, waiting_);
    mouse_on_panel_ = down && owned;
    return owned;
}

bool Gui::receive_finger(const platform::WindowEvent& event) {
    const auto x = static_cast<float>(event.x_px);
    const auto y = static_cast<float>(event.y_px);
    const bool owned = owns(x, y);
    if (event.kind == platform::WindowEvent::Kind::finger_down && owned && !finger_) {
        finger_ = event.finger_id;
        wait_for_frame({PanelInput::Kind::button, true, x, y}, waiting_);
    }
    if (finger_ != event.finger_id) return owned;
    pointer_x_px_ = x;
    pointer_y_px_ = y;
    if (event.kind == platform::WindowEvent::Kind::finger_up) {
        wait_for_frame({PanelInput::Kind::button, false, x, y}, waiting_);
        pointer_x_px_ = pointer_y_px_ = kNowhere_px;  // a lifted finger hovers nowhere
        finger_.reset();
    }
    return owned;
}

bool Gui::receive_key(const platform::WindowEvent& event) {
    if (event.key == platform::key::f12 && event.kind == platform::WindowEvent::Kind::key_down) stop_ = true;
    if (event.repeat) return keys_to_panels_;  // Dear ImGui repeats a held key by itself
    PanelInput input{PanelInput::Kind::key};
    input.down = event.kind == platform::WindowEvent::Kind::key_down;
    input.key = event.key;
    input.ctrl = event.ctrl;
    input.shift = event.shift;
    input.for_panels = keys_to_panels_;
    wait_for_frame(std::move(input), waiting_);
    return keys_to_panels_;
}

void Gui::hand_over(const PanelInput& input) {
    ImGuiIO& io = ImGui::GetIO();
    switch (input.kind) {
        case PanelInput::Kind::button:
            io.MousePos = ImVec2(input.x_px, input.y_px);
            io.MouseDown[0] = input.down;
            return;
        case PanelInput::Kind::key:
            return hand_over_key(input);
        case PanelInput::Kind::text:
        case PanelInput::Kind::replace:
            // Dear ImGui drops letters while Ctrl is held; no key may have told that it was let go
            io.KeyCtrl = false;
            if (input.kind == PanelInput::Kind::replace) return replace_text(input.text);
            return io.AddInputCharactersUTF8(input.text.c_str());
    }
}

bool Gui::shows_focus() const { return !ImGui::GetCurrentContext()->NavDisableHighlight; }

bool Gui::enter_presses_it() const {
    return held_as_[platform::key::enter] == platform::key::space ||
           held_as_[platform::key::pad_enter] == platform::key::space;
}

void Gui::hand_over_key(const PanelInput& input) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = input.ctrl;
    io.KeyShift = input.shift;
    int& held_as = held_as_[static_cast<std::size_t>(input.key)];
    if (!input.down) {
        if (held_as != kNotHeld) io.KeysDown[held_as] = false;
        held_as = kNotHeld;
        return;
    }
    // Enter presses a button as Space does, except where text is typed
    const bool enter = input.key == platform::key::enter || input.key == platform::key::pad_enter;
    const bool activates = enter && !io.WantTextInput && (!keep_enter_ || button_focus_);
    if (input.for_panels && keys_to_panels_) {
        held_as = activates ? platform::key::space : input.key;
        io.KeysDown[held_as] = true;
    }
    const bool writes = input.key != platform::key::f11 && !(input.ctrl && input.key == 'q');
    const bool taken = activates && keep_enter_;  // by the button
    if (!taken && (!io.WantTextInput || !writes)) keys_.push_back({input.key, input.ctrl});
}

// Replaces the text of the field by a text typed on an on-screen keyboard.
void Gui::replace_text(const std::string& text) {
    ImGuiIO& io = ImGui::GetIO();
    ImGuiInputTextState* state = ImGui::GetInputTextState(ImGui::GetActiveID());
    if (!io.WantTextInput || state == nullptr) return;
    state->SelectAll();
    if (!text.empty()) return io.AddInputCharactersUTF8(text.c_str());
    io.KeysDown[platform::key::backspace] = emptied_ = true;
}

void Gui::let_all_keys_go() {
    std::fill(std::begin(ImGui::GetIO().KeysDown), std::end(ImGui::GetIO().KeysDown), false);
    held_as_.fill(kNotHeld);
}

void Gui::begin_frame(double dt_s, bool keys_to_panels) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(window_.width_px()), static_cast<float>(window_.height_px()));
    constexpr float kSlowest_s = 0.1f;  // a key that is held for one slow frame is not repeated
    io.DeltaTime = std::clamp(static_cast<float>(dt_s), 1e-4f, kSlowest_s);
    if (keys_to_panels != keys_to_panels_) let_all_keys_go();
    keys_to_panels_ = keys_to_panels;
    io.ConfigFlags = keys_to_panels ? ImGuiConfigFlags_NavEnableKeyboard : ImGuiConfigFlags_None;
    io.MousePos = ImVec2(pointer_x_px_, pointer_y_px_);
    take_frame(waiting_, frame_);
    for (const PanelInput& input : frame_) hand_over(input);
    button_focus_ = false;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    areas_.clear();
    overflow_.clear();
}

void Gui::end_frame() {
    ImGui::Render();
    keys_.clear();
    if (std::exchange(emptied_, false)) ImGui::GetIO().KeysDown[platform::key::backspace] = false;
}

bool Gui::in_use() const {
    const ImGuiIO& io = ImGui::GetIO();
    const bool key = std::any_of(held_as_.begin(), held_as_.end(), [](int held) { return held != kNotHeld; });
    return !waiting_.empty() || key || io.MouseDown[0];
}

WindowSize Gui::size_px() const { return {ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y}; }

void Gui::renew_drawing() {
    ImGui_ImplOpenGL3_Shutdown();  // only this makes it forget the sizes of its buffers
    ImGui_ImplOpenGL3_Init("#version 300 es");
}

std::uint64_t Gui::content() const {
    const ImDrawData* data = ImGui::GetDrawData();
    std::uint64_t hash = hash_more(0, &data->DisplaySize, sizeof data->DisplaySize);
    const auto take = [&](const auto& values) {
        hash = hash_more(hash, values.Data, static_cast<std::size_t>(values.size_in_bytes()));
    };
    for (int i = 0; i < data->CmdListsCount; ++i) {
        const ImDrawList& list = *data->CmdLists[i];
        take(list.VtxBuffer);
        take(list.IdxBuffer);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            hash = hash_more(hash, &command.ClipRect, sizeof command.ClipRect);
            hash = hash_more(hash, &command.TextureId, sizeof command.TextureId);
            hash = hash_more(hash, &command.ElemCount, sizeof command.ElemCount);
        }
    }
    return hash;
}

void Gui::draw() {
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    while (glGetError() != GL_NO_ERROR) {
        // the packaged backend makes desktop GL queries that OpenGL ES answers with an error
    }
}

std::optional<Gui::TextField> Gui::text_field() const {
    if (!ImGui::GetIO().WantTextInput) return std::nullopt;
    const ImGuiInputTextState* state = ImGui::GetInputTextState(ImGui::GetActiveID());
    if (state == nullptr) return std::nullopt;
    std::string text(4 * static_cast<std::size_t>(state->CurLenW) + 1, '\0');
    const ImWchar* letters = state->TextW.Data;
    const int size = ImTextStrToUtf8(text.data(), static_cast<int>(text.size()), letters, letters + state->CurLenW);
    text.resize(static_cast<std::size_t>(size));
    return TextField{text, text_area_};
}

void Gui::type_instead(const std::string& text) {
    PanelInput input{PanelInput::Kind::replace};
    input.text = text;
    wait_for_frame(std::move(input), waiting_);
}

bool Gui::take_stop() { return std::exchange(stop_, false); }

bool Gui::pressed(int key, bool ctrl) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const Key& k) { return k.key == key && k.ctrl == ctrl; });
}

}  // namespace palpa::app
