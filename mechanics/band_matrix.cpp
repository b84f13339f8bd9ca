#include "mechanics/band_matrix.h"

#include <algorithm>
#include <cstddef>

#ifdef PALPA_HAS_MUMPS
extern "C" {
void openblas_set_num_threads(int);
void dpbtrf_(const char* uplo, const int* n, const int* kd, double* ab, const int* ldab, int* info, std::size_t);
void dpbtrs_(const char* uplo, const int* n, const int* kd, const int* columns, const double* ab, const int* ldab,
             double* b, const int* ldb, int* info, std::size_t);
}
#endif

namespace palpa::mechanics {

void hold_equation(Eigen::Index equation, double stiffness, BandMatrix& K) {
    K.values.col(equation).setZero();
    for (Eigen::Index k = 1; k <= std::min<Eigen::Index>(K.band, equation); ++k) K.values(k, equation - k) = 0.0;
    K.values(0, equation) = stiffness;
}

#ifdef PALPA_HAS_MUMPS
void bring_back_threads() noexcept {
    openblas_set_num_threads(1);  // a second one gains nothing and spins
}

int factor_in_place(BandMatrix& K) noexcept {
    bring_back_threads();
    const auto n = static_cast<int>(K.size());
    const int rows = K.band + 1;
    int info = 0;
    dpbtrf_("L", &n, &K.band, K.values.data(), &rows, &info, 1);
    return info;
}

void solve_in_place(const BandMatrix& factor, Eigen::Ref<Eigen::MatrixXd> block) noexcept {
    const auto n = static_cast<int>(factor.size());
    const int rows = factor.band + 1;
    const auto columns = static_cast<int>(block.cols());
    const auto stride = static_cast<int>(block.outerStride());
    int info = 0;
    if (columns > 0)
        dpbtrs_("L", &n, &factor.band, &columns, factor.values.data(), &rows, block.data(), &stride, &info, 1);
}
#else
void bring_back_threads() noexcept {}
int factor_in_place(BandMatrix&) noexcept { return -1; }
void solve_in_place(const BandMatrix&, Eigen::Ref<Eigen::MatrixXd>) noexcept {}
#endif

}  // namespace palpa::mechanics
