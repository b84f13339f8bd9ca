// MUMPS 5.5, sequential build (libmumps-seq), used with sym = 1: positive definite, lower triangle, no pivoting.

#include "mechanics/solver_mumps.h"

#include <algorithm>

#include "mechanics/blas_memory.h"
#include "mechanics/error.h"
#include "mechanics/solver_backends.h"
#include "mechanics/text.h"

extern "C" void openblas_set_num_threads(int);

namespace palpa::mechanics {
namespace {

constexpr int kInit = -1;
constexpr int kEnd = -2;
constexpr int kAnalyse = 1;
constexpr int kFactor = 2;
constexpr int kSolve = 3;
constexpr int kErrorNoMemory = -9;

// Returns whether the code means that work space could not be allocated, or that more was needed than the analysis
// estimated.
bool is_memory(int code) { return code == -7 || code == -8 || code == kErrorNoMemory || code == -13; }

// Orderings that give the same factor, to the last bit, at every call. The result of Scotch, which MUMPS would choose
// for larger systems, depends on the timing of its threads and on earlier calls. With PORD factoring is as fast at
// 30,000 equations and a quarter slower at 70,000. PORD ends the process if all equations are coupled with each other,
// so small systems, where that can happen, are ordered by minimum fill.
constexpr int kMinimumFill = 2;
constexpr int kPord = 4;
constexpr int kSmall = 10000;  // equations

// Returns ICNTL(i), numbered from 1 as in the users' guide.
MUMPS_INT& icntl(DMUMPS_STRUC_C& id, int i) { return id.icntl[i - 1]; }

void call(DMUMPS_STRUC_C& id, int job) {
    id.job = job;
    dmumps_c(&id);
}

void check(const DMUMPS_STRUC_C& id, const char* what) {
    const int code = id.infog[0];
    if (code >= 0) return;
    const char* meaning = code == -10 || code == -40 ? "the matrix is not positive definite"
                          : is_memory(code)          ? "not enough memory"
                                                     : "see its users' guide";
    const std::string message =
        text("MUMPS: ", what, " of ", id.n, " equations failed with ", code, " (detail ", id.infog[1], "): ", meaning);
    if (is_memory(code)) throw OutOfMemory(message, code);
    throw SolverError(message, code);
}

}  // namespace

std::mutex& mumps_mutex() {
    static std::mutex mutex;
    return mutex;
}

MumpsFactor::MumpsFactor() {
    require_blas_memory();
    const std::scoped_lock lock(mumps_mutex());
    openblas_set_num_threads(1);
    id.sym = 1;
    id.par = 1;
    id.comm_fortran = -987654;  // MPI_COMM_WORLD of the sequential stub
    call(id, kInit);
    for (int i = 1; i <= 4; ++i) icntl(id, i) = i == 4 ? 0 : -1;  // silent
    icntl(id, 14) = 30;                                           // per cent of memory beyond the estimate
    icntl(id, 16) = 1;                                            // threads
}

MumpsFactor::~MumpsFactor() {
    const std::scoped_lock lock(mumps_mutex());
    call(id, kEnd);
}

void analyse(const LowerMatrix& A, MumpsFactor& factor) {
    const std::scoped_lock lock(mumps_mutex());
    factor.row.clear();
    factor.column.clear();
    for (int j = 0; j < A.cols(); ++j) {
        for (LowerMatrix::InnerIterator it(A, j); it; ++it) {
            factor.row.push_back(static_cast<MUMPS_INT>(it.row()) + 1);
            factor.column.push_back(j + 1);
        }
    }
    DMUMPS_STRUC_C& id = factor.id;
    id.n = static_cast<MUMPS_INT>(A.cols());
    id.nnz = static_cast<MUMPS_INT8>(factor.row.size());
    id.irn = factor.row.data();
    id.jcn = factor.column.data();
    icntl(id, 7) = id.n < kSmall ? kMinimumFill : kPord;
    call(id, kAnalyse);
    check(id, "analysis");
}

void refactor(const LowerMatrix& A, MumpsFactor& factor) {
    const std::scoped_lock lock(mumps_mutex());
    factor.value.assign(A.valuePtr(), A.valuePtr() + A.nonZeros());
    DMUMPS_STRUC_C& id = factor.id;
    id.a = factor.value.data();
    call(id, kFactor);
    for (int extra = 60; id.infog[0] == kErrorNoMemory && extra <= 480; extra *= 2) {
        icntl(id, 14) = extra;
        call(id, kFactor);
    }
    check(id, "factorisation");
    const int negative = id.infog[11];  // negative pivots, which MUMPS counts without failing
    if (negative > 0) {
        throw SolverError(text("Cholesky: the matrix of ", id.n, " equations is not positive definite, ", negative,
                               " negative pivots"),
                          -40);
    }
}

void solve_in_place(MumpsFactor& factor, Eigen::Ref<Eigen::MatrixXd> block) {
    const std::scoped_lock lock(mumps_mutex());
    DMUMPS_STRUC_C& id = factor.id;
    id.nrhs = static_cast<MUMPS_INT>(block.cols());
    id.lrhs = static_cast<MUMPS_INT>(block.outerStride());
    id.rhs = block.data();
    icntl(id, 27) = std::max(1, id.nrhs);  // all columns of the block in one sweep
    call(id, kSolve);
    check(id, "solution");
}

}  // namespace palpa::mechanics
