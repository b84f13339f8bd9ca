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

// Throws MaterialError naming the entries unless young_Pa > 0 and finite and -1 < poisson < 0.5. Exactly 0.5
// has no displacement formulation; 0.4999 differs from it by 0.02 % in the indentation of a slab.
void check_materials(std::span<const Material> materials);

// Lame constants and bulk modulus:
//   mu = E / (2 (1 + nu)),  lambda = E nu / ((1 + nu)(1 - 2 nu)),  kappa = lambda + 2 mu / 3
inline double mu_Pa(const Material& m) { return m.young_Pa / (2.0 * (1.0 + m.poisson)); }
inline double lambda_Pa(const Material& m) {
    return m.young_Pa * m.poisson / ((1.0 + m.poisson) * (1.0 - 2.0 * m.poisson));
}
inline double kappa_Pa(const Material& m) { return m.young_Pa / (3.0 * (1.0 - 2.0 * m.poisson)); }

// Strain and stress are 6-vectors in VTK order xx yy zz xy yz xz; shear strains are engineering ones (2
// eps_xy).
using Voigt = Eigen::Matrix<double, 6, 1>;
Voigt stress_Pa(const Material& material, const Voigt& strain);

// One material per cell from a list by region. Throws MaterialError for a region that the list does not hold.
std::vector<Material> materials_of_cells(const Eigen::VectorXi& region, std::span<const Material> list);

// How two materials share a cell. The shear and the bulk modulus are mixed by volume:
//   stiff: v a + (1 - v) b      soft: 1 / (v/a + (1 - v)/b)      between: a^v b^(1-v)
// stiff and soft bracket the answer. Ball of 8 mm, 800 times stiffer, 6 mm deep, pressed 3 mm by an 8 mm
// sphere: at 2 mm cells +10 %, -6 %, +2 % of the force extrapolated to fine cells; at 1 mm +6 %, -3 %, +2 %;
// by centroid alone -1 %, +1 % with scatter (measured 2026-11).
enum class Mixing { stiff, soft, between };
Material mix(const Material& inside, const Material& outside, double share_inside, Mixing rule);

// Mixes `inside` into each cell by its share (sphere_share in mesh.h); cells with share 0 stay as they are.
void mix_in(const Eigen::VectorXd& share, const Material& inside, Mixing rule, std::vector<Material>& of_cells);

}  // namespace palpa::mechanics
