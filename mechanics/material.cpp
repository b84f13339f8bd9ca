#include "mechanics/material.h"

#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

double mix_modulus(double a, double b, double v, Mixing rule) {
    switch (rule) {
        case Mixing::stiff:
            return v * a + (1.0 - v) * b;
        case Mixing::soft:
            return 1.0 / (v / a + (1.0 - v) / b);
        case Mixing::between:
            break;
    }
    return std::exp(v * std::log(a) + (1.0 - v) * std::log(b));
}

}  // namespace

void check_materials(std::span<const Material> materials) {
    std::vector<int> bad;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const Material& m = materials[i];
        const bool good = std::isfinite(m.young_Pa) && m.young_Pa > 0.0 && m.poisson > -1.0 && m.poisson < 0.5;
        if (!good) bad.push_back(static_cast<int>(i));
    }
    if (bad.empty()) return;
    const Material& first = materials[static_cast<std::size_t>(bad.front())];
    throw MaterialError(
        text("material ", bad.front(), ": young_Pa is ", first.young_Pa, ", must be > 0; poisson is ", first.poisson,
             ", must be > -1 and < 0.5 (", bad.size(), " of ", materials.size(), " materials are wrong)"),
        bad);
}

Voigt stress_Pa(const Material& material, const Voigt& strain) {
    const double mu = mu_Pa(material);
    Voigt stress = mu * strain;  // complete for engineering shear, sigma_xy = mu gamma_xy
    stress.head<3>() += mu * strain.head<3>();
    stress.head<3>().array() += lambda_Pa(material) * strain.head<3>().sum();
    return stress;
}

std::vector<Material> materials_of_cells(const Eigen::VectorXi& region, std::span<const Material> list) {
    check_materials(list);
    std::vector<Material> of_cells;
    of_cells.reserve(static_cast<std::size_t>(region.size()));
    for (Eigen::Index cell = 0; cell < region.size(); ++cell) {
        const int r = region(cell);
        if (r < 0 || r >= static_cast<int>(list.size())) {
            throw MaterialError(text("cell ", cell, " has region ", r, ", but there are ", list.size(), " materials"),
                                {r});
        }
        of_cells.push_back(list[static_cast<std::size_t>(r)]);
    }
    return of_cells;
}

Material mix(const Material& inside, const Material& outside, double share_inside, Mixing rule) {
    const double mu = mix_modulus(mu_Pa(inside), mu_Pa(outside), share_inside, rule);
    const double kappa = mix_modulus(kappa_Pa(inside), kappa_Pa(outside), share_inside, rule);
    return {9.0 * kappa * mu / (3.0 * kappa + mu), (3.0 * kappa - 2.0 * mu) / (6.0 * kappa + 2.0 * mu)};
}

void mix_in(const Eigen::VectorXd& share, const Material& inside, Mixing rule, std::vector<Material>& of_cells) {
    for (Eigen::Index cell = 0; cell < share.size(); ++cell) {
        Material& m = of_cells[static_cast<std::size_t>(cell)];
        if (share(cell) >= 1.0)
            m = inside;
        else if (share(cell) > 0.0)
            m = mix(inside, m, share(cell), rule);
    }
}

}  // namespace palpa::mechanics
