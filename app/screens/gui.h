#pragma once
// Dear ImGui on a Window: sets it up, gives it events, and draws it. The panels themselves are in
// app/screens/screens.h.

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/screens/layout.h"
#include "app/screens/panel_input.h"
#include "platform/window.h"

namespace palpa::app {

struct WindowSize {
    float width = 0.0f;  // px
    float height = 0.0f;
};

class Gui {
  public:
    // Becomes the window's event filter; throws std::runtime_error without OpenGL.
    explicit Gui(platform::Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    // Scale of controls and text: px per millimetre, and how much larger than usual they are. Takes effect at once, only
    // outside of a frame.
    void set_scale(float px_per_mm, float text = 1.0f);
    float mm() const { return mm_; }            // px per millimetre of controls
    float hand_mm() const { return hand_mm_; }  // px per millimetre of what hands do, whatever the size of text
    // Has the letters of `texts` too (UTF-8) and all of their alphabet, Greek or Cyrillic, beside Latin ones; takes effect
    // as set_scale() does.
    void add_letters(const std::string& texts);
    WindowSize size_px() const;  // of the frame

    // `keys_to_panels`: arrows, Tab and Space work the controls instead of the indenter.
    void begin_frame(double dt_s, bool keys_to_panels);
    void end_frame();  // closes the panels
    // True while something is held on the panels, or input waits for the next frame: the next frames should then come
    // soon.
    bool in_use() const;
    // If `keep`, Enter is a key of the screen (pressed()) instead of pressing the control that has the focus, unless a ring
    // shows that this is a button.
    void keep_enter(bool keep) { keep_enter_ = keep; }
    void note_button_focus() const { button_focus_ = true; }  // the button that is being drawn has the ring
    std::uint64_t content() const;  // hash of the panels closed last: equal hashes, equal looks
    void draw();                    // hands these panels to GL
    void renew_drawing();           // after GL lost all that it held

    // Claims an area: presses in it do not reach the tissue, from the next event until the next frame claims its areas.
    void claim(const PanelArea& area) { areas_.push_back(area); }
    // True if a key (platform/window_event.h) goes down in this frame; always false while text is typed.
    bool pressed(int key, bool ctrl = false) const;
    bool shows_focus() const;       // a ring marks the control that Enter and Space press
    bool enter_presses_it() const;  // Enter is down, and was given to that control
    // Returns whether F12 went down since the last call, whatever the panels do with keys. It does not wait for a frame.
    bool take_stop();
    // Returns the field that takes letters now, for a screen with an on-screen keyboard; nothing if no field does.
    struct TextField {
        std::string text;
        PanelArea area;
    };
    std::optional<TextField> text_field() const;
    // The area of the field that is being drawn and takes letters.
    void note_text_area(const PanelArea& area) { text_area_ = area; }
    void type_instead(const std::string& text);  // replaces the text of the field

    // Notes the name of a panel that does not fit into its area, for tests and for `run --json`.
    void note_overflow(const std::string& panel) const { overflow_ = panel; }
    const std::string& overflow() const { return overflow_; }

  private:
    static bool filter(const platform::WindowEvent& event, void* self);
    bool receive(const platform::WindowEvent& event);
    bool receive_button(const platform::WindowEvent& event);
    bool receive_finger(const platform::WindowEvent& event);
    bool receive_key(const platform::WindowEvent& event);
    bool owns(float x_px, float y_px) const;
    void hand_over(const PanelInput& input);
    void hand_over_key(const PanelInput& input);
    void replace_text(const std::string& text);
    void let_all_keys_go();

    struct Key {
        int key;
        bool ctrl;
    };

    platform::Window& window_;
    std::vector<PanelArea> areas_;  // of the frame before
    std::deque<PanelInput> waiting_;
    std::vector<PanelInput> frame_;  // input of this frame
    std::vector<Key> keys_;          // keys that go down in this frame
    // The key that Dear ImGui was given for each key that is held, else kNotHeld.
    std::array<int, platform::key::count> held_as_;
    PanelArea text_area_{};
    std::optional<std::int64_t> finger_;  // the finger on the panels; others may palpate meanwhile
    bool mouse_on_panel_ = false;
    bool keys_to_panels_ = false;
    bool keep_enter_ = false;
    mutable bool button_focus_ = false;  // in the frame before a button had the ring
    bool stop_ = false;                  // F12 went down
    bool emptied_ = false;               // a field was emptied by a Backspace that nobody pressed
    float pointer_x_px_ = -1e6f;
    float pointer_y_px_ = -1e6f;
    float mm_ = 0.0f;
    float hand_mm_ = 0.0f;
    float text_scale_ = 1.0f;
    std::string font_file_;
    std::string texts_;  // whose letters the panels have
    mutable std::string overflow_;
};

}  // namespace palpa::app
