// Designs of parts that are changed on the screen: every edit appends an operation to a copy of the part's file, and the
// tissue is made anew. Beams answer at once; finite cells are computed meanwhile.

#include <algorithm>
#include <exception>
#include <optional>
#include <tuple>
#include <utility>

#include "app/assets.h"
#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/words.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "parts/edit.h"
#include "scene/tissue.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

fs::path edits_folder() { return user_folder().empty() ? fs::temp_directory_path() : user_folder() / "parts"; }

bool is_edited(const fs::path& design) {
    return design.parent_path() == edits_folder() && design.stem().string().find("-edited") != std::string::npos;
}

// Names beside the part's own file stay what they were in a copy elsewhere.
void keep_names(const fs::path& from, files::Json& part) {
    const auto keep = [&](files::Json& name) {
        if (name.is_string() && fs::path(name.get<std::string>()).is_relative())
            name = fs::absolute(from.parent_path() / name.get<std::string>()).lexically_normal().string();
    };
    if (part.contains("button") && part["button"].contains("support") && part["button"]["support"].contains("curve"))
        keep(part["button"]["support"]["curve"]);
}

// Whether a copy is of this design as it is now, and has more operations: a part elsewhere may have a file of the same name,
// and a copy whose edits were all undone is as its design. Nothing of one that cannot be read.
std::optional<bool> holds_edits(const fs::path& copy, const fs::path& design) {
    try {
        files::Json edited = files::read_json(copy);
        files::Json own = files::read_json(design);
        keep_names(design, own);
        own = parts::moved_part(std::move(own), design, copy);
        const files::Json shape = std::exchange(edited.at("shape"), nullptr);
        const files::Json begin = std::exchange(own.at("shape"), nullptr);
        return edited == own && shape.size() > begin.size() && std::equal(begin.begin(), begin.end(), shape.begin());
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

// Which of a design's copies a file is: 1 for NAME-edited.json, 2 for NAME-edited-2.json; 0 for other files.
int number_of_copy(const fs::path& file, const fs::path& design) {
    const std::string name = file.filename().string(), begin = design.stem().string() + "-edited";
    if (name == begin + ".json") return 1;
    int number = 0, end = 0;
    const bool is_copy = name.starts_with(begin) &&
                         std::sscanf(name.c_str() + begin.size(), "-%6d.json%n", &number, &end) == 1 &&
                         begin.size() + static_cast<std::size_t>(end) == name.size();
    return is_copy ? std::max(number, 0) : 0;
}

// The files of a design's edits: the one that was changed last of those that hold any, empty if none does, and the next.
// One that cannot be read is the last only if no other holds any; it is told of when it is opened.
struct EditedFiles {
    fs::path last;
    fs::path next;
};

EditedFiles edited_files(const fs::path& design) {
    EditedFiles out;
    std::tuple<bool, fs::file_time_type, int> best{};
    int highest = 0;
    std::error_code error;
    for (const fs::path& entry : files::listed_entries(edits_folder())) {
        const int number = number_of_copy(entry, design);
        highest = std::max(highest, number);
        if (number == 0) continue;
        const std::optional<bool> holds = holds_edits(entry, design);
        const std::tuple one{holds.has_value(), fs::last_write_time(entry, error), number};
        if (!holds.value_or(true) || (!out.last.empty() && one < best)) continue;
        best = one;
        out.last = entry;
    }
    const std::string stem = design.stem().string() + "-edited";
    out.next = edits_folder() / (stem + (highest == 0 ? "" : "-" + std::to_string(highest + 1)) + ".json");
    return out;
}

// Whether another design of the scene is read from the same file.
bool is_shared(std::size_t index, const std::vector<fs::path>& designs) {
    return std::count(designs.begin(), designs.end(), designs.at(index)) > 1;
}

// The file that holds a design's edits since the scene was opened: a new one, since that of another day may be somebody's
// work. A copy that is opened by itself is gone on with, unless another design shows it too.
fs::path edited_file(std::size_t index, const std::vector<fs::path>& designs, std::map<std::size_t, fs::path>& copies) {
    const fs::path& design = designs.at(index);
    if (is_edited(design) && !is_shared(index, designs)) return design;
    auto [copy, fresh] = copies.try_emplace(index);
    if (!fresh) return copy->second;
    fs::create_directories(edits_folder());
    return copy->second = edited_files(design).next;
}

// The design's last edits of another session; empty if there are none, or another design shows them already.
fs::path earlier_file(std::size_t index, const std::vector<fs::path>& designs) {
    if (is_edited(designs.at(index))) return {};
    const fs::path last = edited_files(designs.at(index)).last;
    return std::find(designs.begin(), designs.end(), last) == designs.end() ? last : fs::path();
}

void keep_design(const fs::path& file, App& app) {
    if (app.keeper != nullptr) app.keeper->keep_design(file);
}

// The scene as the person means it: with cells also while they are being computed.
scene::Scene wanted_scene(const App& app) { return app.parts.cells ? app.parts.wanted : app.session.scene; }

// What the screen says of the files of the designs that are shown.
void show_files(App& app) {
    scene::Scene scene = wanted_scene(app);
    PartView& view = app.view.part;
    view.in_browser = app.keeper != nullptr;
    view.earlier = false;
    const auto& designs = scene::part_options(scene.tissue)->designs;
    for (std::size_t i = 0; i < designs.size(); ++i) {
        view.kept.at(i) = is_edited(designs[i]) ? designs[i] : fs::path();
        view.earlier |= app.parts.copies.empty() && !earlier_file(i, designs).empty();
    }
}

// Points in mm, with the third coordinate from in front of the part to behind it.
files::Json cylinder_json(const std::array<double, 2>& p_m, double radius_m, const std::array<int, 2>& view,
                          const files::Json& size_mm) {
    const auto third = static_cast<std::size_t>(3 - view[0] - view[1]);
    files::Json from{0.0, 0.0, 0.0};
    for (std::size_t k = 0; k < 2; ++k) from[static_cast<std::size_t>(view[k])] = 1e3 * p_m[k];
    files::Json to = from;
    from[third] = -1.0;
    to[third] = size_mm[third].get<double>() + 1.0;
    return {{"cylinder", {{"from_mm", from}, {"to_mm", to}, {"radius_mm", 1e3 * radius_m}}}};
}

files::Json operation_of(const PartWish& wish, const std::array<int, 2>& view, const files::Json& part) {
    files::Json regions = files::Json::array();
    for (const auto& p : wish.path_m) regions.push_back(cylinder_json(p, wish.radius_m, view, part["size_mm"]));
    const files::Json region = regions.size() == 1 ? regions[0] : files::Json{{"any", regions}};
    if (wish.tool == PartTool::permute) return {{"permute", region}, {"material", wish.material}};
    return {{"remove", region}};
}

// Then nothing is left to compute: their curves answer, whatever the method.
bool buttons_only(const scene::Plan& plan) {
    const auto& designs = scene::parts_of(plan.tissue)->designs;
    return std::all_of(designs.begin(), designs.end(), [](const auto& design) { return design.button.has_value(); });
}

parts::Method method_now(const App& app) {
    const scene::PartTissue& tissue = *scene::parts_of(app.session.plan->tissue);
    return tissue.methods.at(scene::part_work_of(app.session.state.tissue)->method);
}

// Goes to the method that the person has chosen, by events of the log, once a trial of changed parts has begun.
void take_chosen_method(platform::Window& window, App& app) {
    const scene::PartTissue* tissue = scene::parts_of(app.session.plan->tissue);
    const std::optional<parts::Method> chosen = app.parts.method;
    if (tissue == nullptr || !chosen || study_of(app.doing) != nullptr) return;
    if (app.session.state.touch.down || app.session.trial.finished || waits_for_keeper(app)) return;
    const std::size_t methods = tissue->methods.size();
    if (std::find(tissue->methods.begin(), tissue->methods.end(), *chosen) == tissue->methods.end()) return;
    for (std::size_t i = 0; i < methods && method_now(app) != *chosen; ++i) act(platform::Action::method, window, app);
    app.parts.method = chosen;
}

// Prepares the scene with its designs as they are now: by beams at once where it asks for cells, which follow.
void show_designs(const scene::Scene& wanted, platform::Window& window, const Gui& gui, App& app) {
    scene::Scene now = wanted;
    scene::PartOptions& options = *scene::part_options(now.tissue);
    const bool cells = options.method == parts::Method::voxels;
    std::shared_ptr<const scene::Plan> plan;
    if (cells) options.method = parts::Method::timoshenko;
    try {
        plan = std::make_shared<const scene::Plan>(scene::make_plan(now));
    } catch (const files::InputError&) {
        if (!cells) throw;
        now = wanted;  // no beam: the cells alone can answer
        plan = std::make_shared<const scene::Plan>(scene::make_plan(now));
        app.parts.cells.reset();
        put_scene(std::move(now), std::move(plan), window, app);
        return begin_anew(window, gui, app);
    }
    put_scene(std::move(now), std::move(plan), window, app);
    begin_anew(window, gui, app);
    app.parts.cells.reset();
    if (!cells || buttons_only(*app.session.plan)) return;
    app.parts.wanted = wanted;
    app.parts.cells = std::make_unique<session::PlanInProgress>(wanted);
}

// operation_for(part's JSON) is appended to the design. Returns false, and says so, if it would change nothing.
template <class OperationFor>
bool append_edit(std::size_t index, const OperationFor& operation_for, platform::Window& window, const Gui& gui,
                 App& app) {
    scene::Scene scene = wanted_scene(app);
    std::vector<fs::path>& designs = scene::part_options(scene.tissue)->designs;
    fs::path& design = designs.at(index);
    parts::EditedPart edited = parts::open_part(design);
    const files::Json operation = operation_for(edited.json);
    std::int64_t changed = 0;
    try {
        changed = parts::edit(operation, edited);
    } catch (const files::InputError&) {
        // told below
    }
    if (changed == 0) {
        app.notices.note = words::kNothingChanged;
        return false;
    }
    const fs::path file = edited_file(index, designs, app.parts.copies);
    keep_names(design, edited.json);
    parts::save_part(edited, file);
    keep_design(file, app);
    app.parts.done.push_back({index, std::exchange(design, file)});
    ++app.view.part.edits[index];
    show_designs(scene, window, gui, app);
    return true;
}

void edit_part(const PartWish& wish, platform::Window& window, const Gui& gui, App& app) {
    const std::array<int, 2> view = scene::part_options(app.session.scene.tissue)->view;
    const auto& materials = scene::parts_of(app.session.plan->tissue)->designs.at(wish.design).part.materials;
    const auto is_wanted = [&](const parts::PartMaterial& material) { return material.name == wish.material; };
    if (wish.tool == PartTool::permute && std::none_of(materials.begin(), materials.end(), is_wanted)) {
        app.notices.note = words::filled(words::kNoSuchMaterial, {wish.material});
        return;
    }
    const bool changed = append_edit(
        wish.design, [&](const files::Json& part) { return operation_of(wish, view, part); }, window, gui, app);
    if (changed) app.parts.undone.clear();
}

void undo_part(platform::Window& window, const Gui& gui, App& app) {
    if (app.parts.done.empty()) return;
    const PartControl::Done last = app.parts.done.back();
    scene::Scene scene = wanted_scene(app);
    fs::path& design = scene::part_options(scene.tissue)->designs.at(last.design);
    parts::EditedPart edited = parts::open_part(design);
    app.parts.undone.push_back({last.design, edited.json["shape"].back()});
    if (parts::undo_edit(edited)) {  // in the copy, which the first edit made
        parts::save_part(edited, design);
        keep_design(design, app);
    }
    design = last.before;
    app.parts.done.pop_back();
    --app.view.part.edits[last.design];
    show_designs(scene, window, gui, app);
}

void redo_part(platform::Window& window, const Gui& gui, App& app) {
    if (app.parts.undone.empty()) return;
    const PartControl::Undone again = app.parts.undone.back();
    const bool changed = append_edit(
        again.design, [&](const files::Json&) { return again.operation; }, window, gui, app);
    if (changed) app.parts.undone.pop_back();
}

std::size_t operations_of(const fs::path& design) { return parts::open_part(design).json["shape"].size(); }

void open_earlier(platform::Window& window, const Gui& gui, App& app) {
    scene::Scene scene = wanted_scene(app);
    auto& designs = scene::part_options(scene.tissue)->designs;
    for (std::size_t i = 0; i < designs.size(); ++i) {
        const fs::path last = earlier_file(i, designs);
        if (last.empty()) continue;
        // what the copy has more than its design can be undone
        for (std::size_t k = operations_of(designs[i]); k < operations_of(last); ++k) {
            app.parts.done.push_back({i, last});
            ++app.view.part.edits[i];
        }
        designs[i] = last;
    }
    show_designs(scene, window, gui, app);
}

}  // namespace

void change_part(const PartWish& wish, platform::Window& window, const Gui& gui, App& app) {
    if (scene::part_options(app.session.scene.tissue) == nullptr || study_of(app.doing) != nullptr || app.trace) return;
    attempt(app, [&] {
        if (wish.kind == PartWish::Kind::edit) edit_part(wish, window, gui, app);
        if (wish.kind == PartWish::Kind::undo) undo_part(window, gui, app);
        if (wish.kind == PartWish::Kind::redo) redo_part(window, gui, app);
        if (wish.kind == PartWish::Kind::earlier) open_earlier(window, gui, app);
        if (wish.kind == PartWish::Kind::offer) app.keeper->offer(app.view.part.kept.at(wish.design));
        app.view.part.undone = app.parts.undone.size();
        show_files(app);
    });
}

void note_method(App& app) {
    const scene::PartTissue* tissue = scene::parts_of(app.session.plan->tissue);
    if (tissue != nullptr && !tissue->methods.empty()) app.parts.method = method_now(app);
}

void forget_parts(App& app) {
    app.parts = {};
    app.view.part = {};
}

void follow_parts(platform::Window& window, const Gui& gui, App& app) {
    if (!std::exchange(app.parts.looked, true) && scene::part_options(app.session.scene.tissue) != nullptr)
        show_files(app);
    take_chosen_method(window, app);
    if (!app.parts.cells) return;
    app.view.part.pending = app.parts.cells->share();
    if (!app.parts.cells->wait(0.0) || app.session.state.touch.down) return;  // the method changes between presses only
    const bool good = attempt(app, [&] {
        auto plan = std::make_shared<const scene::Plan>(app.parts.cells->take());
        put_scene(app.parts.wanted, std::move(plan), window, app);
        begin_anew(window, gui, app);
    });
    if (!good) app.notices.note.clear();
    app.parts.cells.reset();
    app.view.part.pending.reset();
}

}  // namespace palpa::app
