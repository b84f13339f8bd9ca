#include "platform/web/browser.h"

#include <emscripten.h>

// clang-format off
EM_JS(void, palpa_fit_canvas, (), {
    const canvas = Module.canvas;
    const density = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(canvas.clientWidth * density));
    const height = Math.max(1, Math.round(canvas.clientHeight * density));
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
});

EM_JS(int, palpa_canvas_width, (), { return Module.canvas.width; });
EM_JS(int, palpa_canvas_height, (), { return Module.canvas.height; });
EM_JS(double, palpa_px_per_css_px, (), { return Module.canvas.width / Math.max(1, Module.canvas.clientWidth); });
EM_JS(int, palpa_has_touch, (), { return navigator.maxTouchPoints > 0 || matchMedia('(any-pointer: coarse)').matches ? 1 : 0; });
EM_JS(int, palpa_is_secure, (), { return window.isSecureContext ? 1 : 0; });
EM_JS(int, palpa_screen_px, (int of_long_side), {
    const side = of_long_side ? Math.max(screen.width, screen.height) : Math.min(screen.width, screen.height);
    return Math.round(side * (window.devicePixelRatio || 1));
});
EM_JS(int, palpa_full_screen, (), { return document.fullscreenElement || document.webkitFullscreenElement ? 1 : 0; });
EM_JS(void, palpa_set_full_screen, (int full), {
    const page = document.documentElement;
    const enter = page.requestFullscreen || page.webkitRequestFullscreen;
    const leave = document.exitFullscreen || document.webkitExitFullscreen;
    const asked = full ? enter && enter.call(page) : leave && leave.call(document);
    if (asked && asked.catch) asked.catch(() => {}); // nobody has touched anything yet
});
EM_JS(void, palpa_set_title, (const char* title), { document.title = UTF8ToString(title); });

// Makes one call per sample, oldest first: events that a browser coalesces between frames are taken apart again.
EM_JS(void, palpa_listen, (), {
    const canvas = Module.canvas;
    const tools = {pen: 0, touch: 1, mouse: 2};
    const down = 0, move = 1, up = 2, cancel = 3;
    canvas.style.touchAction = 'none';
    const send = (event, kind) => {
        const box = canvas.getBoundingClientRect();
        const tool = event.pointerType in tools ? tools[event.pointerType] : tools.mouse;
        _palpa_pointer(kind, event.pointerId, tool, event.clientX - box.left, event.clientY - box.top, event.pressure,
                       event.tiltX, event.tiltY, event.width, event.height, event.timeStamp, event.buttons);
    };
    const on = (name, kind) => canvas.addEventListener(name, (event) => {
        if (event.cancelable) event.preventDefault();
        if (kind === down) {
            if (document.activeElement && document.activeElement !== document.body) document.activeElement.blur();
            try { canvas.setPointerCapture(event.pointerId); } catch (gone) {}
        }
        const between = kind === move && event.getCoalescedEvents ? event.getCoalescedEvents() : [];
        if (between.length === 0) send(event, kind);
        for (const part of between) send(part, kind);
    }, {passive: false});
    on('pointerdown', down);
    on('pointermove', move);
    on('pointerup', up);
    on('pointercancel', cancel);
    for (const name of ['contextmenu', 'selectstart', 'dragstart', 'touchstart', 'touchmove', 'gesturestart']) {
        canvas.addEventListener(name, (event) => event.preventDefault(), {passive: false});
    }
    canvas.addEventListener('wheel', (event) => {
        event.preventDefault();
        const unit = event.deltaMode === 0 ? 100 : event.deltaMode === 1 ? 3 : 1;
        _palpa_wheel(-event.deltaY / unit, event.timeStamp);
    }, {passive: false});

    // codes of platform/window_event.h
    const named = {Backspace: 8, Tab: 9, Enter: 13, Escape: 27, Delete: 127, ArrowLeft: 256, ArrowRight: 257, ArrowUp: 258,
                   ArrowDown: 259, PageUp: 260, PageDown: 261, Home: 262, End: 263, F10: 264, F11: 265, F1: 279};
    const pad = {NumpadEnter: 266, NumpadAdd: 267, NumpadSubtract: 268};
    const code_of = (event) => {
        if (event.code in pad) return pad[event.code];
        if (event.code.length === 7 && event.code.startsWith('Numpad') && event.key >= '0' && event.key <= '9') return 269 + Number(event.code[6]);
        if (event.key in named) return named[event.key];
        const code = event.key.length === 1 ? event.key.toLowerCase().charCodeAt(0) : 0;
        return code < 128 ? code : 0;
    };
    const key = (event, is_down) => {
        const at = event.target;
        const code = code_of(event);
        // a button of a dialog that has just been closed keeps the focus until the page is drawn again
        const of_page = document.querySelector('dialog[open]') || (at && at.closest && at.closest('input, button, a') && !at.closest('dialog'));
        const third = event.getModifierState('AltGraph'); // where it comes with Ctrl and Alt, it is neither of them
        const ctrl = event.ctrlKey && !third;
        const of_browser = (event.altKey && !third) || event.metaKey || (ctrl && !'aqsyz'.includes(String.fromCharCode(code)));
        const typed = [...event.key].length === 1 && !ctrl ? event.key.codePointAt(0) : 0; // any letter, not of ASCII alone
        if ((code === 0 && typed === 0) || (is_down && (of_page || of_browser))) return; // whatever is let go was perhaps held before
        if (!of_page) event.preventDefault();
        _palpa_key(is_down ? 1 : 0, code, typed, ctrl ? 1 : 0, event.shiftKey ? 1 : 0, event.repeat ? 1 : 0);
    };
    window.addEventListener('keydown', (event) => key(event, true));
    window.addEventListener('keyup', (event) => key(event, false));
    window.addEventListener('blur', () => _palpa_focus_lost());
    document.addEventListener('visibilitychange', () => { if (document.hidden) _palpa_focus_lost(); });
});
// clang-format on

namespace palpa::platform::browser {

void fit_canvas() { palpa_fit_canvas(); }
int canvas_width_px() { return palpa_canvas_width(); }
int canvas_height_px() { return palpa_canvas_height(); }
double px_per_css_px() { return palpa_px_per_css_px(); }
double now_s() { return 1e-3 * emscripten_get_now(); }
bool has_touch_screen() { return palpa_has_touch() != 0; }
bool is_secure() { return palpa_is_secure() != 0; }
int screen_long_px() { return palpa_screen_px(1); }
int screen_short_px() { return palpa_screen_px(0); }
bool full_screen() { return palpa_full_screen() != 0; }
void set_full_screen(bool full) { palpa_set_full_screen(full ? 1 : 0); }
void set_title(const char* title) { palpa_set_title(title); }
void listen() { palpa_listen(); }

}  // namespace palpa::platform::browser
