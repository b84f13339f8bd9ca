#pragma once
// One instance of MUMPS and the arrays that it points into. Only the solver's own sources include this.

#include <dmumps_c.h>
#include <mutex>
#include <vector>

namespace palpa::mechanics {

std::mutex& mumps_mutex();

struct MumpsFactor {
    MumpsFactor();
    ~MumpsFactor();
    MumpsFactor(const MumpsFactor&) = delete;
    MumpsFactor& operator=(const MumpsFactor&) = delete;

    DMUMPS_STRUC_C id{};
    std::vector<MUMPS_INT> row;  // counted from 1
    std::vector<MUMPS_INT> column;
    std::vector<double> value;
};

}  // namespace palpa::mechanics
