#pragma once
// What a scene's key `tactile` asks for: a finger on the tissue, an arm that it pushes against, and pins under its tip.
// Plain data; the library `tactile` makes its own plan from it. Absent parts are neither computed nor driven.

#include <filesystem>
#include <optional>

#include "files/json.h"

namespace palpa::scene {

// The contact of the finger with the tissue. parabola: a fixed pressure p(r) = Pmax (1 - 4 r^2/d^2); rigid: a sphere
// without a pad; pad: a sphere with an elastic pad.
enum class FingerContact { parabola, rigid, pad };

struct FingerOptions {
    FingerContact contact = FingerContact::parabola;
    double diameter_m = 16e-3;  // of the pressure, or of the sphere
    std::filesystem::path pad;  // file of the pad's parameters; empty unless the contact is `pad`
};

// A low-impedance arm is moved by the hand and answers with a force; a high-impedance arm is pushed by the hand and
// answers with a depth.
enum class ArmImpedance { low, high };

struct ArmOptions {
    ArmImpedance impedance = ArmImpedance::low;
    std::filesystem::path device;  // empty: computed and logged, but nothing moves
};

// A shape display (high impedance) shows how the surface under the finger is bent, a pressure display (low impedance)
// how it is pressed.
enum class DisplayKind { shape, pressure };
enum class PinZero { skel, top };       // which height stands at the pins' rest: that of the bone, or the highest
enum class OverStroke { clip, scale };  // what happens to a shape that is higher than the stroke
enum class SheetBacking { off, free, backed };
enum class PinSchedule { free, lead, locked };  // the shape of now, of 20 ms ahead, or all pins at the top

struct DisplayOptions {
    DisplayKind kind = DisplayKind::shape;
    std::filesystem::path device;  // empty: the pins are only drawn
    PinZero zero = PinZero::skel;
    OverStroke over_stroke = OverStroke::clip;
    SheetBacking sheet = SheetBacking::off;
    PinSchedule schedule = PinSchedule::lead;
    bool dither = false;
};

// A table of answers instead of a contact that is solved at every step.
struct FingerTableOptions {
    double spacing_m = 4e-3;  // of the places where it begins
    double error = 5e-3;      // share of the greatest force; the table is refined until it is met
};

// Whose motion is the input: that of the touch (the pen, or a recorded press), or that of the arm.
enum class Leads { touch, arm };

struct TactileOptions {
    FingerOptions finger;
    std::optional<ArmOptions> arm;  // at least one of arm and display
    std::optional<DisplayOptions> display;
    std::optional<FingerTableOptions> table;
    double force_limit_N = 2.5;  // above it force and shape hold
    Leads leads = Leads::touch;
};

const char* name_of(FingerContact contact);
const char* name_of(ArmImpedance impedance);
const char* name_of(DisplayKind kind);
const char* name_of(PinSchedule schedule);

// Reads the key `tactile` of a scene file. `assets`: where device files (devices/) and pads (fingers/) are looked for if
// they are not beside the scene file. Throws InputError, also for pairings that cannot show the tissue: a shape display
// under a rigid finger, or a pressure display under a parabola, would show what the finger brings, whatever the tissue.
TactileOptions read_tactile(files::JsonReader json, const std::filesystem::path& scene_file,
                            const std::filesystem::path& assets);

}  // namespace palpa::scene
