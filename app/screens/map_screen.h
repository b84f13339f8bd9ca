#pragma once
// The map browser: a matrix of a map in colour, its nodules, force over depth at the place that is pointed at, and
// facts about the map. During a test trial it shows nothing: the tissue under test, turned or not, may be among the
// maps.

#include <Eigen/Core>
#include <imgui.h>
#include <optional>
#include <string>
#include <vector>

#include "app/screens/gui.h"
#include "app/screens/screens.h"
#include "stiffnessmaps/field.h"

namespace palpa::app {

enum class MapQuantity : std::uint8_t { normal, tangential_x, tangential_y, stiffness };

struct MapBrowser {
    std::vector<Choice> maps;
    std::string file;        // of the map shown
    std::string problem;     // why another map could not be shown
    stiffnessmaps::Map map;  // without cells: no map is shown
    stiffnessmaps::Field field;
    std::vector<double> stiffness_N_per_m;  // [n_y][n_x], stiffnessmaps/stiffness.h
    std::vector<std::string> facts;
    MapQuantity quantity = MapQuantity::stiffness;
    int depth = 0;                             // index of the matrix
    std::vector<Eigen::Vector2d> pins_m;       // places of pinned curves, the newest last
    std::optional<Eigen::Vector2d> pointed_m;  // moved by the keys
};
inline constexpr std::size_t kPins = 4;

// False during a test, whose nodules stay hidden until it is finished; in practice they are shown anyway, and parts have none.
bool may_show_maps(const scene::Plan& plan, const session::Trial& trial);

// Opens the browser on the scene's own map, or on the first of the list. Problems are shown in the browser.
std::shared_ptr<MapBrowser> make_map_browser(const scene::Scene& scene, std::vector<Choice> maps);
// Shows another map, without pins. If it cannot be read, the present one stays, and browser.problem says why.
void choose_map(const std::string& file, MapBrowser& browser);

void draw_map_screen(const Shown& shown, Gui& gui, MapBrowser& browser, Wishes& wishes);

// The parts of the screen that map_drawing.cpp draws.
bool has_quantity(const stiffnessmaps::Map& map, MapQuantity quantity);
void add_pin(const Eigen::Vector2d& p_m, MapBrowser& browser);  // replaces the oldest if there are kPins already
// Draws the matrix. Returns the place under the pointer, if any; `pressed` says whether it was pressed there.
std::optional<Eigen::Vector2d> draw_map_matrix(const MapBrowser& browser, ImVec2 size_px, const Gui& gui,
                                               bool& pressed);
void draw_map_curves(const MapBrowser& browser, const std::optional<Eigen::Vector2d>& pointed_m, ImVec2 size_px,
                     const Gui& gui);

}  // namespace palpa::app
