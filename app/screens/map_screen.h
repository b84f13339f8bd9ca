#pragma once
// The map browser: a matrix of a map in colour, its nodules, force over depth at the place that is pointed at, and
// facts about the map.
// While a test trial goes on it shows nothing: the tissue under test, turned or not, may be among the maps.

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
    std::string file;        // of the map that is shown
    std::string problem;     // why another could not be
    stiffnessmaps::Map map;  // without cells: none is shown
    stiffnessmaps::Field field;
    std::vector<double> stiffness_N_per_m;
    std::vector<std::string> facts;
    MapQuantity quantity = MapQuantity::stiffness;
    int depth = 0;                             // index of the matrix
    std::vector<Eigen::Vector2d> pins_m;       // curves that stay, the newest last
    std::optional<Eigen::Vector2d> pointed_m;  // by the keys
};
inline constexpr std::size_t kPins = 4;

// False while a test goes on, whose nodules stay hidden until it is finished; in practice they are shown anyway.
bool may_show_maps(const session::Trial& trial);

// Opens the browser on the scene's own map, or on the first of the list. Problems are shown in the browser.
std::shared_ptr<MapBrowser> make_map_browser(const scene::Scene& scene, std::vector<Choice> maps);
void choose_map(const std::string& file, MapBrowser& browser);

void draw_map_screen(const Shown& shown, Gui& gui, MapBrowser& browser, Wishes& wishes);

// The parts of the screen that map_drawing.cpp draws.
bool has_quantity(const stiffnessmaps::Map& map, MapQuantity quantity);
void add_pin(const Eigen::Vector2d& p_m, MapBrowser& browser);  // the oldest goes if there are too many
// Returns the place under the pointer; `pressed` says whether it was pressed there.
std::optional<Eigen::Vector2d> draw_map_matrix(const MapBrowser& browser, ImVec2 size_px, const Gui& gui,
                                               bool& pressed);
void draw_map_curves(const MapBrowser& browser, const std::optional<Eigen::Vector2d>& pointed_m, ImVec2 size_px,
                     const Gui& gui);

}  // namespace palpa::app
