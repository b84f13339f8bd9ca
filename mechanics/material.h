#pragma once
// Isotropic linear elasticity.

#include <Eigen/Core>
#include <span>
#include <vector>

namespace palpa::mechanics {

struct Material {
    double young_Pa = 2500.0;
    double poisson = 0.45;
};

// Throws MaterialError with the entries unless young_Pa is > 0 and finite and -1 < poisson < 0.5. At exactly 0.5 there
// is no displacement formulation; the indentation of a slab at 0.4999 differs by 0.02 % from that at 0.5.
void check_materials(std::span<const Material> materials);

// Lame constants and bulk modulus:
//   mu = E / (2 (1 + nu)),  lambda = E nu / ((1 + nu)(1 - 2 nu)),  kappa = lambda + 2 mu / 3
inline double mu_Pa(const Material& m) { return m.young_Pa / (2.0 * (1.0 + m.poisson)); }
inline double lambda_Pa(const Material& m) {
    return m.young_Pa * m.poisson / ((1.0 + m.poisson) * (1.0 - 2.0 * m.poisson));
}
inline double kappa_Pa(const Material& m) { return m.young_Pa / (3.0 * (1.0 - 2.0 * m.poisson)); }

// Strain and stress are 6-vectors in VTK order, xx yy zz xy yz xz. Shear strains are engineering strains, 2 eps_xy.
using Voigt = Eigen::Matrix<double, 6, 1>;
Voigt stress_Pa(const Material& material, const Voigt& strain);

// Returns the material of each cell, from a list by region. Throws MaterialError for a region that the list does not
// hold, and as check_materials() does.
std::vector<Material> materials_of_cells(const Eigen::VectorXi& region, std::span<const Material> list);

// How two materials share a cell. The shear and the bulk modulus are mixed by the share of volume v:
//   stiff: v a + (1 - v) b      soft: 1 / (v/a + (1 - v)/b)      between: a^v b^(1-v)
// stiff and soft bracket the true answer. For a ball of 8 mm, 800 times stiffer, 6 mm deep, pressed 3 mm by a sphere of
// 8 mm, the force differs from that extrapolated to fine cells by +10 %, -6 %, +2 % at cells of 2 mm and by +6 %, -3 %,
// +2 % at 1 mm. Without mixing, by centroids, it differs by -1 % and +1 %, but with scatter (measured 2026-11).
enum class Mixing { stiff, soft, between };
Material mix(const Material& inside, const Material& outside, double share_inside, Mixing rule);

// Mixes `inside` into each cell by the cell's share (sphere_share in mesh.h); cells with share 0 stay as they are.
void mix_in(const Eigen::VectorXd& share, const Material& inside, Mixing rule, std::vector<Material>& of_cells);

}  // namespace palpa::mechanics
