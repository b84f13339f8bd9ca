// Designs that are changed on the screen of parts: which files hold the changes, and how one goes on with them.

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <stdlib.h>

#include "app/screens/part_screen.h"
#include "app/screens/words.h"
#include "files/text.h"
#include "scene/tissue.h"
#include "tests/app/live/desk.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::app;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

struct Home {
    TemporaryFolder folder;
    Home() {
        ::setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
        std::ofstream(folder / "bar.json") << R"({"name": "bar", "voxel_mm": 0.5, "size_mm": [60, 6, 20],
          "materials": {"hard": {"young_Pa": 8.3e9, "poisson": 0.28, "density_kg_per_m3": 1200, "colour": "#4477aa"}},
          "shape": [{"add": {"box": {"min_mm": [0, 0, 5], "max_mm": [60, 6, 15]}}, "material": "hard"}],
          "supports": [{"face": "xmin", "fix": "xyz"}],
          "loads": {"tip": {"at_mm": [57, 3, 15], "patch_mm": 4, "direction": "-z", "force_N": 2}}, "axis": "x"})";
        std::ofstream(folder / "scene.json")
            << R"({"name": "bar", "tissue": {"part": {"designs": ["bar.json"], "method": "timoshenko"}}})";
    }
    ~Home() { ::unsetenv("XDG_DATA_HOME"); }
    std::string scene() const { return (folder / "scene.json").string(); }
    fs::path edited(const std::string& more = "") const {
        return folder / "palpa/parts" / ("bar-edited" + more + ".json");
    }
};

void wish(PartWish::Kind kind, Desk& desk) {
    PartWish out;
    out.kind = kind;
    if (kind == PartWish::Kind::edit) {
        out.path_m = {{0.02 + 0.004 * desk.app.view.part.edits[0], 0.01}};  // each beside the one before
        out.radius_m = 1e-3;
    }
    change_part(out, desk.window, desk.gui, desk.app);
}

fs::path design_of(Desk& desk) { return scene::part_options(desk.app.session.scene.tissue)->designs.at(0); }

std::size_t operations_of(const fs::path& file) {
    return files::parse_json(files::read_text(file), file.string())["shape"].size();
}

}  // namespace

TEST_CASE("part edits: a second session writes a file of its own, and the first one's changes can be gone on with") {
    const Home home;
    {
        Desk desk(home.scene());
        follow_parts(desk.window, desk.gui, desk.app);
        CHECK_FALSE(desk.app.view.part.earlier);
        wish(PartWish::Kind::edit, desk);
        wish(PartWish::Kind::edit, desk);
        CHECK(desk.app.notices.problems.empty());
        CHECK(design_of(desk) == home.edited());
        CHECK(operations_of(home.edited()) == 3);
        CHECK(desk.keeper.designs == std::vector<fs::path>{home.edited(), home.edited()});
        wish(PartWish::Kind::undo, desk);
        CHECK(operations_of(home.edited()) == 2);
        CHECK(desk.keeper.designs.size() == 3);
        CHECK_FALSE(desk.app.view.part.earlier);  // it is the present one
        wish(PartWish::Kind::offer, desk);
        CHECK(desk.keeper.offered == std::vector<fs::path>{home.edited()});
    }
    {
        Desk desk(home.scene());
        wish(PartWish::Kind::edit, desk);
        CHECK(design_of(desk) == home.edited("-2"));
        CHECK(operations_of(home.edited()) == 2);
    }
    Desk desk(home.scene());
    follow_parts(desk.window, desk.gui, desk.app);
    CHECK(desk.app.view.part.earlier);
    wish(PartWish::Kind::earlier, desk);
    CHECK(desk.app.notices.problems.empty());
    CHECK(design_of(desk) == home.edited("-2"));
    CHECK(desk.app.view.part.kept[0] == home.edited("-2"));
    CHECK_FALSE(desk.app.view.part.earlier);
    wish(PartWish::Kind::edit, desk);
    CHECK(operations_of(home.edited("-2")) == 3);
    CHECK(desk.app.view.part.edits[0] == 2);  // this one, and the one of the other session
    wish(PartWish::Kind::undo, desk);
    wish(PartWish::Kind::undo, desk);
    CHECK(operations_of(home.edited("-2")) == 1);
    PartWish missed;
    missed.kind = PartWish::Kind::edit;
    missed.path_m = {{0.03, 0.5}};
    missed.radius_m = 1e-3;
    change_part(missed, desk.window, desk.gui, desk.app);
    CHECK(desk.app.notices.note == words::kNothingChanged);
    CHECK(desk.app.notices.problems.empty());
    CHECK_FALSE(fs::exists(home.edited("-3")));
    missed.tool = PartTool::permute;  // to the material that is there
    missed.material = "hard";
    missed.path_m = {{0.03, 0.01}};
    desk.app.notices.note.clear();
    change_part(missed, desk.window, desk.gui, desk.app);
    CHECK(desk.app.notices.note == words::kNothingChanged);
    CHECK(operations_of(home.folder / "bar.json") == 1);
    missed.material = "rubber";  // of the other design
    change_part(missed, desk.window, desk.gui, desk.app);
    CHECK(desk.app.notices.note == "This design has no material rubber.");
    CHECK(operations_of(home.folder / "bar.json") == 1);
}

TEST_CASE("part edits: two designs of one file are changed apart, and undone apart") {
    const Home home;
    std::ofstream(home.folder / "scene.json")
        << R"({"name": "twins", "tissue": {"part": {"designs": ["bar.json", "bar.json"], "method": "timoshenko"}}})";
    {
        Desk desk(home.scene());
        PartWish cut;
        cut.kind = PartWish::Kind::edit;
        cut.radius_m = 1e-3;
        for (const std::size_t design : {1u, 0u}) {
            cut.design = design;
            cut.path_m = {{0.02 + 0.01 * static_cast<double>(design), 0.01}};
            change_part(cut, desk.window, desk.gui, desk.app);
        }
        const auto& designs = scene::part_options(desk.app.session.scene.tissue)->designs;
        CHECK(designs.at(1) == home.edited());
        CHECK(designs.at(0) == home.edited("-2"));
        for (const std::string copy : {"", "-2"}) CHECK(operations_of(home.edited(copy)) == 2);
        wish(PartWish::Kind::undo, desk);
        CHECK(designs.at(0) == home.folder / "bar.json");
        CHECK(operations_of(home.edited()) == 2);  // the other's change stays
        wish(PartWish::Kind::redo, desk);
        CHECK(operations_of(home.edited("-2")) == 2);
        CHECK(desk.app.notices.note.empty());
    }
    Desk desk(home.scene());
    wish(PartWish::Kind::earlier, desk);  // the last one, in one of both: a change of it stays in it
    const auto& designs = scene::part_options(desk.app.session.scene.tissue)->designs;
    CHECK(designs.at(0) == home.edited("-2"));
    CHECK(designs.at(1) == home.folder / "bar.json");
    CHECK_FALSE(desk.app.view.part.earlier);
}

TEST_CASE("part edits: an undone first change is out of its file too, and is not offered again") {
    const Home home;
    {
        Desk desk(home.scene());
        wish(PartWish::Kind::edit, desk);
        wish(PartWish::Kind::undo, desk);
        CHECK(design_of(desk) == home.folder / "bar.json");
        CHECK(operations_of(home.edited()) == 1);
    }
    {
        Desk desk(home.scene());
        follow_parts(desk.window, desk.gui, desk.app);
        CHECK_FALSE(desk.app.view.part.earlier);
        wish(PartWish::Kind::edit, desk);
        wish(PartWish::Kind::undo, desk);
        wish(PartWish::Kind::redo, desk);
        CHECK(design_of(desk) == home.edited("-2"));
        CHECK(operations_of(home.edited("-2")) == 2);
    }
    Desk desk(home.scene());
    follow_parts(desk.window, desk.gui, desk.app);
    CHECK(desk.app.view.part.earlier);
}

TEST_CASE(
    "part edits: the copy that was changed last is gone on with, whatever copies were removed or cannot be read") {
    const Home home;
    const auto session = [&] {
        Desk desk(home.scene());
        wish(PartWish::Kind::edit, desk);
        return design_of(desk);
    };
    const auto earlier = [&] {
        Desk desk(home.scene());
        follow_parts(desk.window, desk.gui, desk.app);
        REQUIRE(desk.app.view.part.earlier);
        wish(PartWish::Kind::earlier, desk);
        CHECK(desk.app.notices.problems.empty());
        return design_of(desk);
    };
    session();
    REQUIRE(session() == home.edited("-2"));
    fs::remove(home.edited());
    CHECK(earlier() == home.edited("-2"));
    CHECK(session() == home.edited("-3"));  // a name that is free again stays free
    CHECK(earlier() == home.edited("-3"));
    std::ofstream(home.edited("-4")) << "{";
    CHECK(earlier() == home.edited("-3"));
    fs::last_write_time(home.edited("-2"), fs::last_write_time(home.edited("-3")) + std::chrono::seconds(2));
    CHECK(earlier() == home.edited("-2"));
}

TEST_CASE("part edits: the method that was chosen stays after a change and after it is undone") {
    const Home home;
    Desk desk(home.scene());
    const auto method = [&] {
        const scene::PartTissue& tissue = *scene::parts_of(desk.app.session.plan->tissue);
        return tissue.methods.at(scene::part_work_of(desk.app.session.state.tissue)->method);
    };
    desk.keeper.busy = false;
    CHECK(method() == parts::Method::timoshenko);  // the scene's
    while (method() != parts::Method::euler_bernoulli) act(platform::Action::method, desk.window, desk.app);
    for (const PartWish::Kind change : {PartWish::Kind::edit, PartWish::Kind::undo}) {
        wish(change, desk);
        follow_parts(desk.window, desk.gui, desk.app);
        CHECK(method() == parts::Method::euler_bernoulli);
    }
}

TEST_CASE(
    "part edits: a push button has no finite cells to wait for, and the screen says that its shape does not answer") {
    const Home home;
    Desk desk((fs::path(PALPA_SOURCE_DIR) / "assets/scenes/button.json").string());
    PartWish cut;
    cut.kind = PartWish::Kind::edit;
    cut.path_m = {{0.003, 0.003}};
    cut.radius_m = 1e-3;
    change_part(cut, desk.window, desk.gui, desk.app);
    CHECK(desk.app.notices.problems.empty());
    CHECK(desk.app.view.part.edits[0] == 1);
    CHECK(desk.app.parts.cells == nullptr);
    const auto& notes = desk.app.session.plan->notes;
    const auto says = [&](const char* what) {
        return std::any_of(notes.begin(), notes.end(),
                           [&](const std::string& note) { return note.find(what) != std::string::npos; });
    };
    CHECK(says("its shape is drawn only"));
    CHECK_FALSE(says("linear elastic"));
}

TEST_CASE(
    "part edits: changes of another part whose file has the same name are not offered, nor those of an older design") {
    const Home home;
    {
        Desk desk(home.scene());
        wish(PartWish::Kind::edit, desk);
    }
    const auto offered = [](const std::string& scene) {
        Desk desk(scene);
        follow_parts(desk.window, desk.gui, desk.app);
        return desk.app.view.part.earlier;
    };
    CHECK(offered(home.scene()));
    const fs::path other = home.folder / "other";
    fs::create_directory(other);
    for (const char* file : {"bar.json", "scene.json"}) fs::copy_file(home.folder / file, other / file);
    CHECK(offered((other / "scene.json").string()));  // the same part
    std::string text = files::read_text(other / "bar.json");
    text.replace(text.find("8.3e9"), 5, "4.0e9");
    files::write_text_atomically(other / "bar.json", text);
    CHECK_FALSE(offered((other / "scene.json").string()));
    files::write_text_atomically(home.folder / "bar.json", text);  // mended since
    CHECK_FALSE(offered(home.scene()));
}

TEST_CASE("part screen: a press that begins and ends between two frames stands in the curves, from its beginning") {
    const Home home;
    Desk desk(home.scene());
    const scene::ScreenArea& area = desk.app.session.state.screen;
    platform::Sample sample;
    sample.pointer_id = 4;
    sample.tool = platform::Tool::pen;
    sample.phase = platform::Phase::down;
    PartView& view = desk.app.view.part;
    for (int i = 0; i <= 100; ++i) {  // a second
        sample.t_host_s = 10.0 + 0.01 * i;
        sample.x_px = area.x_px + 0.5 * area.width_px;
        sample.y_px = area.y_px + 0.5 * area.height_px;
        sample.pressure = 0.05 + 0.005 * i;
        session::take_sample(sample, desk.app.session);
        note_press(desk.app.session.state, sample.t_host_s, view);
        sample.phase = platform::Phase::move;
    }
    REQUIRE(view.press[0].size() > 10);
    CHECK(view.press[0].front().t_s == 0.0f);
    CHECK(view.press[0].front().force_N < 0.3f * view.press[0].back().force_N);
    CHECK(view.press[0].back().t_s > 0.3f);
    sample.phase = platform::Phase::up;
    session::take_sample(sample, desk.app.session);
    note_press(desk.app.session.state, 11.1, view);
    desk.show_frame();
    CHECK(view.press[0].front().t_s == 0.0f);
}
