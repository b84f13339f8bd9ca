#include "app/screens/map_screen.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "files/text.h"
#include "scene/tissue.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::app {
namespace {

std::string in_mm(double metres) { return files::short_number(1e3 * metres); }

std::vector<std::string> facts_of(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field) {
    const stiffnessmaps::ForceRange range = stiffnessmaps::force_range(map);
    std::vector<std::string> out;
    out.push_back(words::filled(words::kCellsOf, {std::to_string(map.n_x), std::to_string(map.n_y),
                                                  in_mm(map.spacing_m[0]), in_mm(map.spacing_m[1])}));
    out.push_back(words::filled(words::kDepthsFromTo, {std::to_string(map.n_depths()), in_mm(map.depths_m.front()),
                                                       in_mm(map.depths_m.back())}));
    out.push_back(words::filled(words::kForceFromTo,
                                {files::short_number(range.lowest_N), files::short_number(range.highest_N)}));
    const double missing =
        100.0 * static_cast<double>(stiffnessmaps::missing_count(map)) / static_cast<double>(map.normal_N.size());
    out.push_back(missing > 0.0 ? words::filled(words::kShareMissing, {files::short_number(missing)})
                                : words::kNoMissingData);
    out.push_back(words::filled(
        words::kNoise,
        {knows_noise(map) ? words::filled(words::kNoiseAbout, {files::short_number(1e3 * normal_noise_N(map))})
                          : words::kNotKnown,
         std::to_string(field.isotonic_changed)}));
    out.push_back(words::filled(words::kTangential, {name_of(map.tangential)}));
    out.push_back(words::filled(words::kIndenter, {name_of(map.indenter), in_mm(map.indenter_radius_m)}));
    for (const stiffnessmaps::Nodule& nodule : map.nodules) {
        std::string text = words::filled(nodule.placed ? words::kPlacedNodule : words::kDetectedNodule,
                                         {nodule.id, in_mm(nodule.x_m), in_mm(nodule.y_m)});
        if (nodule.length_m)
            text += words::filled(words::kMmLong, {in_mm(*nodule.length_m)});
        else if (nodule.diameter_m)
            text += words::filled(words::kMmWide, {in_mm(*nodule.diameter_m)});
        out.push_back(text);
    }
    out.push_back(std::string(name_of(map.source.kind)) + ": " + map.source.how);
    return out;
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    return a == b || std::filesystem::equivalent(a, b, error);
}

void quantity_buttons(const Gui& gui, MapBrowser& browser) {
    constexpr const char* kNames[] = {words::kNormal, words::kTangentialX, words::kTangentialY, words::kStiffness};
    constexpr const char* kKeys[] = {"1", "2", "3", "4"};
    float widest_px = 0.0f;
    for (const char* name : kNames) widest_px = std::max(widest_px, ImGui::CalcTextSize(name).x);
    const bool pairs = widest_px + 4.0f * gui.mm() < share_of_line_px(2);
    const float width_px = share_of_line_px(pairs ? 2 : 1);
    for (int i = 0; i < 4; ++i) {
        const auto quantity = static_cast<MapQuantity>(i);
        if (pairs && i % 2 == 1) ImGui::SameLine();
        if (big_button(kNames[i], kKeys[i],
                       {width_px, kTarget_mm, has_quantity(browser.map, quantity), browser.quantity == quantity},
                       gui)) {
            browser.quantity = quantity;
        }
    }
}

void depth_controls(const Gui& gui, MapBrowser& browser) {
    const int last = static_cast<int>(browser.map.n_depths()) - 1;
    const bool matters = browser.quantity != MapQuantity::stiffness && last > 0;
    const float button_px = kTarget_mm * gui.mm();
    const float slider_px = ImGui::GetContentRegionAvail().x - 2.0f * (button_px + ImGui::GetStyle().ItemSpacing.x);
    if (big_button("-", "", {button_px, kTarget_mm, matters && browser.depth > 0, false}, gui)) --browser.depth;
    ImGui::SameLine();
    ImGui::BeginDisabled(!matters);
    push_touchable_frame(1.0f, gui);
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 5.0f * gui.mm());
    ImGui::SetNextItemWidth(slider_px);
    const std::string text =
        words::filled(words::kMmDeep, {in_mm(browser.map.depths_m[static_cast<std::size_t>(browser.depth)])});
    std::string format;
    for (const char c : text) format += c == '%' ? std::string("%%") : std::string(1, c);
    ImGui::SliderInt("##depth", &browser.depth, 0, std::max(last, 1), format.c_str(), ImGuiSliderFlags_NoInput);
    ImGui::PopStyleVar(2);
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (big_button("+", "", {button_px, kTarget_mm, matters && browser.depth < last, false}, gui)) ++browser.depth;
    browser.depth = std::clamp(browser.depth, 0, last);
}

void map_list(float height_px, const Gui& gui, MapBrowser& browser) {
    ImGui::TextDisabled(words::kMap);
    ImGui::BeginChild("maps", ImVec2(0.0f, height_px), false, ImGuiWindowFlags_NavFlattened);
    std::string wanted;
    for (const Choice& choice : browser.maps) {
        ImGui::PushID(choice.file.c_str());
        ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(1.5f * gui.mm(), 0.0f));
        if (big_button(choice.name.c_str(), "", {0.0f, kTarget_mm, true, choice.file == browser.file}, gui))
            wanted = choice.file;
        ImGui::PopStyleVar(2);
        ImGui::PopID();
    }
    scroll_by_drag(gui);
    ImGui::EndChild();
    if (!wanted.empty()) choose_map(wanted, browser);
}

// Takes the keys, with which everything can be done: quantity, depth, a point moved by a fortieth of the map, pins.
void take_map_keys(const Gui& gui, MapBrowser& browser) {
    for (int i = 0; i < 4; ++i) {
        const auto quantity = static_cast<MapQuantity>(i);
        if ((gui.pressed('1' + i) || gui.pressed(platform::key::pad_0 + 1 + i)) && has_quantity(browser.map, quantity))
            browser.quantity = quantity;
    }
    const stiffnessmaps::Map& map = browser.map;
    if (gui.pressed(platform::key::page_down))
        browser.depth = std::min(browser.depth + 1, static_cast<int>(map.n_depths()) - 1);
    if (gui.pressed(platform::key::page_up)) browser.depth = std::max(browser.depth - 1, 0);
    const double width_m = map.x_of(map.n_x - 1) - map.x_of(0);
    const double height_m = map.y_of(map.n_y - 1) - map.y_of(0);
    const double step_m = std::max(width_m, height_m) / 40.0;
    const double right = (gui.pressed('l') ? 1.0 : 0.0) - (gui.pressed('j') ? 1.0 : 0.0);
    const double up = (gui.pressed('i') ? 1.0 : 0.0) - (gui.pressed('k') ? 1.0 : 0.0);
    if (right != 0.0 || up != 0.0) {
        const Eigen::Vector2d middle(map.x_of(0) + 0.5 * width_m, map.y_of(0) + 0.5 * height_m);
        const Eigen::Vector2d p = browser.pointed_m.value_or(middle) + step_m * Eigen::Vector2d(right, up);
        browser.pointed_m = Eigen::Vector2d(std::clamp(p.x(), map.x_of(0), map.x_of(map.n_x - 1)),
                                            std::clamp(p.y(), map.y_of(0), map.y_of(map.n_y - 1)));
    }
    if (gui.pressed('o') && browser.pointed_m) add_pin(*browser.pointed_m, browser);
}

struct Areas {
    PanelArea controls, matrix, curves, facts;
};

Areas areas_of(float width, float height, float mm_px) {
    Areas out;
    const float column = std::min(64.0f * mm_px, 0.3f * width);
    const float split = column + std::min(0.6f * (width - column), height);
    const float matrix_height = 0.62f * height;  // where the curves are below
    const auto side_px = [&](float room, float high) { return std::min(room - 28.0f * mm_px, high - 15.0f * mm_px); };
    const bool larger_above = side_px(width - column, matrix_height) > 1.15f * side_px(split - column, height);
    if (width >= height && larger_above) {
        const float middle = 0.5f * (column + width);
        out.controls = {0.0f, 0.0f, column, height};
        out.matrix = {column, 0.0f, width, matrix_height};
        out.curves = {column, matrix_height, middle, height};
        out.facts = {middle, matrix_height, width, height};
    } else if (width >= height) {
        const float half = 0.5f * height;
        out.controls = {0.0f, 0.0f, column, height};
        out.matrix = {column, 0.0f, split, height};
        out.curves = {split, 0.0f, width, half};
        out.facts = {split, half, width, height};
    } else {
        const float strip = std::min(66.0f * mm_px, 0.34f * height);
        const float below = std::min(height - strip - 0.26f * height, width * 0.95f);
        out.controls = {0.0f, 0.0f, width, strip};
        out.matrix = {0.0f, strip, width, strip + below};
        out.curves = {0.0f, strip + below, 0.55f * width, height};
        out.facts = {0.55f * width, strip + below, width, height};
    }
    return out;
}

void back_button(const Gui& gui, Wishes& wishes) {
    if (big_button(words::kBack, words::kEscape, {40.0f * gui.mm(), kTarget_mm, true, false}, gui))
        wishes.screen = Screen::trial;
}

void draw_controls(const Areas& areas, Gui& gui, MapBrowser& browser, Wishes& wishes) {
    begin_part("controls", areas.controls);
    const bool wide = areas.controls.width() < areas.controls.height();
    back_button(gui, wishes);
    const float line_px = kTarget_mm * gui.mm() + ImGui::GetStyle().ItemSpacing.y;
    if (wide) {
        if (!browser.problem.empty()) warning_paragraph(browser.problem);
        if (browser.map.n_cells() > 0) {
            quantity_buttons(gui, browser);
            depth_controls(gui, browser);
        }
        map_list(ImGui::GetContentRegionAvail().y - ImGui::GetFontSize() - 3.0f * ImGui::GetStyle().ItemSpacing.y, gui,
                 browser);
    } else {
        const float half_px = share_of_line_px(2);
        ImGui::BeginChild("left", ImVec2(half_px, 0.0f), false, ImGuiWindowFlags_NavFlattened);
        if (browser.map.n_cells() > 0) {
            quantity_buttons(gui, browser);
            depth_controls(gui, browser);
        }
        if (!browser.problem.empty()) warning_paragraph(browser.problem);
        ImGui::EndChild();
        ImGui::SameLine();
        ImGui::BeginChild("right", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
        map_list(std::max(line_px, ImGui::GetContentRegionAvail().y - ImGui::GetFontSize() -
                                       3.0f * ImGui::GetStyle().ItemSpacing.y),
                 gui, browser);
        ImGui::EndChild();
    }
    end_part("controls", gui);
}

}  // namespace

bool may_show_maps(const scene::Plan& plan, const session::Trial& trial) {
    return trial.mode == session::TrialMode::practice || trial.finished || scene::parts_of(plan.tissue) != nullptr;
}

void choose_map(const std::string& file, MapBrowser& browser) {
    try {
        stiffnessmaps::Map map = stiffnessmaps::read_map(file);
        browser.field = stiffnessmaps::make_field(map, {});
        browser.stiffness_N_per_m = stiffnessmaps::stiffness_N_per_m(map);
        browser.facts = facts_of(map, browser.field);
        browser.map = std::move(map);
        browser.file = file;
        browser.problem.clear();
        browser.pins_m.clear();
        browser.pointed_m.reset();
        browser.depth = static_cast<int>(browser.map.n_depths()) - 1;
        if (!has_quantity(browser.map, browser.quantity)) browser.quantity = MapQuantity::stiffness;
    } catch (const std::exception& error) {
        browser.problem = error.what();
    }
}

std::shared_ptr<MapBrowser> make_map_browser(const scene::Scene& scene, std::vector<Choice> maps) {
    auto browser = std::make_shared<MapBrowser>();
    browser->maps = std::move(maps);
    const std::filesystem::path of_scene = scene::map_folder(scene.tissue);
    std::string first = of_scene.string();
    if (first.empty() && !browser->maps.empty()) first = browser->maps.front().file;
    const auto listed = std::find_if(browser->maps.begin(), browser->maps.end(),
                                     [&](const Choice& c) { return same_file(c.file, first); });
    if (listed != browser->maps.end()) {
        first = listed->file;
    } else if (!first.empty()) {
        browser->maps.insert(browser->maps.begin(), {of_scene.stem().string(), first});
    }
    if (first.empty())
        browser->problem = words::kNoMap;
    else
        choose_map(first, *browser);
    return browser;
}

void add_pin(const Eigen::Vector2d& p_m, MapBrowser& browser) {
    if (browser.pins_m.size() == kPins) browser.pins_m.erase(browser.pins_m.begin());
    browser.pins_m.push_back(p_m);
}

void draw_map_screen(const Shown& shown, Gui& gui, MapBrowser& browser, Wishes& wishes) {
    const WindowSize window = gui.size_px();
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height), kDark);
    if (!may_show_maps(shown.plan, shown.trial)) {
        begin_panel("map hidden", {0.0f, 0.0f, window.width, window.height}, gui);
        back_button(gui, wishes);
        wrapped_text(words::kMapsHidden);
        end_panel("map hidden", gui);
        return;
    }
    const Areas areas = areas_of(window.width, window.height, gui.mm());
    if (browser.map.n_cells() > 0) take_map_keys(gui, browser);
    begin_bare_panel("maps", gui);
    draw_controls(areas, gui, browser, wishes);
    std::optional<Eigen::Vector2d> pointed_m;
    bool pressed = false;
    begin_part("matrix", areas.matrix);
    if (browser.map.n_cells() > 0) pointed_m = draw_map_matrix(browser, ImGui::GetContentRegionAvail(), gui, pressed);
    end_part("matrix", gui);
    if (pressed && pointed_m) add_pin(*pointed_m, browser);
    if (pointed_m) browser.pointed_m.reset();  // the pointer replaces the keys
    begin_part("curves", areas.curves);
    if (browser.map.n_cells() > 0)
        draw_map_curves(browser, pointed_m ? pointed_m : browser.pointed_m, ImGui::GetContentRegionAvail(), gui);
    end_part("curves", gui);
    begin_part("notes", areas.facts);
    ImGui::BeginChild("facts", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    if (browser.map.n_cells() > 0) wrapped_text(browser.map.name);
    for (const std::string& fact : browser.facts) paragraph(fact);
    // Page Up and Page Down choose the depth here
    if (gui.pressed(platform::key::home)) ImGui::SetScrollY(0.0f);
    if (gui.pressed(platform::key::end)) ImGui::SetScrollY(ImGui::GetScrollMaxY());
    scroll_by_drag(gui);
    ImGui::EndChild();
    end_part("notes", gui);
    end_panel("maps", gui);
}

}  // namespace palpa::app
