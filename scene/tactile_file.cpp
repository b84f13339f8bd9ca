// The key `tactile` of a scene file.

#include <array>

#include "scene/find_file.h"
#include "scene/tactile_options.h"

namespace palpa::scene {
namespace {

constexpr std::array<const char*, 3> kContacts{"parabola", "rigid", "pad"};
constexpr std::array<const char*, 2> kImpedances{"low", "high"};
constexpr std::array<const char*, 2> kDisplayKinds{"shape", "pressure"};
constexpr std::array<const char*, 3> kSchedules{"free", "lead", "locked"};
constexpr const char* kDefaultPad = "fingertip.json";

FingerOptions read_finger(files::JsonReader json, const std::filesystem::path& file,
                          const std::filesystem::path& assets) {
    json.only({"contact", "diameter_mm", "pad"});
    FingerOptions finger;
    if (json.has("contact"))
        finger.contact = static_cast<FingerContact>(json.choice("contact", {"parabola", "rigid", "pad"}));
    finger.diameter_m = 1e-3 * json.number("diameter_mm", {1.0, 100.0}, 1e3 * finger.diameter_m);
    if (finger.contact == FingerContact::pad)
        finger.pad = find_file(json.text("pad", kDefaultPad), file, assets / "fingers");
    else if (json.has("pad"))
        json.fail("pad", "parameters of a pad", "none: the contact is no pad");
    json.finish();
    return finger;
}

std::filesystem::path read_device(files::JsonReader& json, const std::filesystem::path& file,
                                  const std::filesystem::path& assets) {
    if (!json.has("device")) return {};
    return find_file(json.text("device"), file, assets / "devices");
}

ArmOptions read_arm(files::JsonReader json, const std::filesystem::path& file, const std::filesystem::path& assets) {
    json.only({"impedance", "device"});
    ArmOptions arm;
    if (json.has("impedance")) arm.impedance = static_cast<ArmImpedance>(json.choice("impedance", {"low", "high"}));
    arm.device = read_device(json, file, assets);
    if (arm.impedance == ArmImpedance::high && arm.device.empty())
        json.fail("impedance", "a high-impedance arm without a device",
                  "a device with a force sensor between the arm and the display");
    json.finish();
    return arm;
}

// What only pins that move up and down have.
void read_pins(files::JsonReader& json, DisplayOptions& display) {
    if (json.has("zero")) display.zero = static_cast<PinZero>(json.choice("zero", {"skel", "top"}));
    if (json.has("over_stroke"))
        display.over_stroke = static_cast<OverStroke>(json.choice("over_stroke", {"clip", "scale"}));
    if (json.has("sheet")) display.sheet = static_cast<SheetBacking>(json.choice("sheet", {"off", "free", "backed"}));
    if (json.has("schedule"))
        display.schedule = static_cast<PinSchedule>(json.choice("schedule", {"free", "lead", "locked"}));
    display.dither = json.boolean("dither", display.dither);
}

DisplayOptions read_display(files::JsonReader json, const std::filesystem::path& file,
                            const std::filesystem::path& assets) {
    json.only({"kind", "device", "zero", "over_stroke", "sheet", "schedule", "dither"});
    DisplayOptions display;
    if (json.has("kind")) display.kind = static_cast<DisplayKind>(json.choice("kind", {"shape", "pressure"}));
    if (display.kind == DisplayKind::pressure) {
        for (const char* key : {"device", "zero", "over_stroke", "sheet", "schedule", "dither"}) {
            if (json.has(key))
                json.fail(key, "it beside a pressure display", "none: pressures are drawn and logged only");
        }
        json.finish();
        return display;
    }
    display.device = read_device(json, file, assets);
    read_pins(json, display);
    json.finish();
    return display;
}

FingerTableOptions read_table(files::JsonReader json) {
    json.only({"spacing_mm", "error"});
    FingerTableOptions table;
    table.spacing_m = 1e-3 * json.number("spacing_mm", {0.1, 100.0}, 1e3 * table.spacing_m);
    table.error = json.number("error", {1e-5, 0.5}, table.error);
    json.finish();
    return table;
}

// A display must show what the tissue answers, not what the finger brings.
void check_pairing(const files::JsonReader& json, const TactileOptions& options) {
    if (!options.arm && !options.display) json.fail("", "neither an arm nor a display", "at least one of them");
    if (options.leads == Leads::arm && (!options.arm || options.arm->device.empty()))
        json.fail("leads", options.arm ? "an arm without a device that leads" : "no arm to lead",
                  "touch, or an arm with a device");
    if (!options.display) return;
    const bool shape = options.display->kind == DisplayKind::shape;
    if (shape && options.finger.contact == FingerContact::rigid)
        json.fail("display.kind", "a shape display under a rigid finger",
                  "contact parabola or pad: the shape would be the finger's own, whatever the tissue");
    if (!shape && options.finger.contact == FingerContact::parabola)
        json.fail("display.kind", "a pressure display under a parabola of pressure",
                  "contact rigid or pad: the pressure would be the finger's own, whatever the tissue");
}

}  // namespace

const char* name_of(FingerContact contact) { return kContacts[static_cast<std::size_t>(contact)]; }
const char* name_of(ArmImpedance impedance) { return kImpedances[static_cast<std::size_t>(impedance)]; }
const char* name_of(DisplayKind kind) { return kDisplayKinds[static_cast<std::size_t>(kind)]; }
const char* name_of(PinSchedule schedule) { return kSchedules[static_cast<std::size_t>(schedule)]; }

TactileOptions read_tactile(files::JsonReader json, const std::filesystem::path& scene_file,
                            const std::filesystem::path& assets) {
    json.only({"finger", "arm", "display", "table", "force_limit_N", "leads"});
    TactileOptions options;
    if (auto finger = json.optional_object("finger")) options.finger = read_finger(*finger, scene_file, assets);
    if (auto arm = json.optional_object("arm")) options.arm = read_arm(*arm, scene_file, assets);
    if (auto display = json.optional_object("display")) options.display = read_display(*display, scene_file, assets);
    if (auto table = json.optional_object("table")) options.table = read_table(*table);
    options.force_limit_N = json.number("force_limit_N", {0.01, 100.0}, options.force_limit_N);
    if (json.has("leads")) options.leads = static_cast<Leads>(json.choice("leads", {"touch", "arm"}));
    check_pairing(json, options);
    json.finish();
    return options;
}

}  // namespace palpa::scene
