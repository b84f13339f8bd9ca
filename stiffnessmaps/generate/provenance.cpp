#include "stiffnessmaps/generate/provenance.h"

#include <algorithm>
#include <cmath>

#include "files/text.h"
#include "mechanics/linear_range.h"

namespace palpa::stiffnessmaps {
namespace {

// Returns the smallest depth at which linearity_ratio() exceeds a limit, with the contact's width by Hertz.
double depth_at_ratio_m(const Phantom& p, double limit) {
    double low = 0.0;
    double high = p.size_m[2];
    for (int i = 0; i < 60; ++i) {
        const double d = 0.5 * (low + high);
        const double width_m = 2.0 * std::sqrt(p.indenter_radius_m * std::min(d, p.indenter_radius_m));
        (mechanics::linearity_ratio(d, p.size_m[2], width_m) > limit ? high : low) = d;
    }
    return high;
}

std::string mm(double metres) { return files::short_number(1e3 * metres) + " mm"; }

std::string tool_text(const MapTask& task) {
    const Phantom& p = task.phantom;
    const std::string shape = p.indenter == IndenterShape::sphere
                                  ? "sphere"
                                  : "cylinder " + mm(p.indenter_length_m) + " long with its axis along y";
    if (!is_rough(task)) return "a frictionless " + shape + " rolled";
    return "a " + shape + " that slides steadily with a friction coefficient of " +
           files::number_text(task.model.friction) + ", slipping all over its contact,";
}

std::string tangential_text(const MapTask& task) {
    if (!is_rough(task)) return "Tangential force: slope of the contact's energy, central differences on the grid.";
    return "Tangential force: friction and slope of the pressure, tangential_x_N of a slide along +x (and the normal "
           "force), "
           "tangential_y_N of one along +y; for motion along -x and -y friction has the other sign than these arrays.";
}

// " Nodules A, B: 2.3e+06 Pa, Poisson's ratio 0.49." for each run of nodules of one material.
std::string nodules_text(const std::vector<PhantomNodule>& nodules) {
    std::string out;
    for (std::size_t i = 0; i < nodules.size();) {
        const Elastic& material = nodules[i].material;
        std::string names = nodules[i].id;
        const std::size_t first = i;
        for (++i; i < nodules.size() && nodules[i].material.young_Pa == material.young_Pa &&
                  nodules[i].material.poisson == material.poisson;
             ++i)
            names += ", " + nodules[i].id;
        out += (i > first + 1 ? " Nodules " : " Nodule ") + names + ": " + files::number_text(material.young_Pa) +
               " Pa, Poisson's ratio " + files::number_text(material.poisson) + ".";
    }
    return out;
}

}  // namespace

std::string how_made(const MapTask& task) {
    const Phantom& p = task.phantom;
    const double contact_radius_m = std::sqrt(p.indenter_radius_m * std::min(p.depths_m.front(), p.indenter_radius_m));
    std::string how =
        "Linear finite elements (B-bar hexahedra), " + tool_text(task) +
        " over the phantom: " + mm(task.mesh.contact_m) + " between nodes under the tool (contact radius / spacing " +
        files::short_number(contact_radius_m / task.mesh.contact_m) + " at " + mm(p.depths_m.front()) + "), nodules " +
        files::short_number(task.mesh.cells_across) + " cells across, the block's sides every " +
        mm(task.mesh.surface_m[0]) + ". " + tangential_text(task);
    how += " The tissue's Young's modulus, " + files::number_text(p.tissue.young_Pa) + " Pa, is " +
           (p.tissue.assumed ? "ASSUMED" : "the phantom's") + "; its Poisson's ratio is " +
           files::number_text(p.tissue.poisson) + ". The block: " + mm(p.size_m[0]) + " x " + mm(p.size_m[1]) + " x " +
           mm(p.size_m[2]) + "." + nodules_text(p.nodules);
    const double amber_m = depth_at_ratio_m(p, mechanics::kAmber);
    const double red_m = depth_at_ratio_m(p, mechanics::kRed);
    if (p.depths_m.back() > amber_m) {
        how +=
            " Leaves the linear range (larger of depth / contact width and depth / thickness): amber, above 10 %, "
            "from " +
            mm(amber_m) + "; red, above 25 %, from " + mm(red_m) + ".";
    }
    return how;
}

}  // namespace palpa::stiffnessmaps
