#include "mechanics/blas_memory.h"

#ifdef PALPA_HAS_MUMPS
#include <atomic>
#include <cstddef>
#include <sys/mman.h>

#include "mechanics/error.h"
#endif

namespace palpa::mechanics {

#ifdef PALPA_HAS_MUMPS
void require_blas_memory() {
    static std::atomic<bool> known = false;
    if (known) return;
    constexpr std::size_t kBuffers_bytes = 2 * (std::size_t{128} << 20);
    void* room = ::mmap(nullptr, kBuffers_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED) throw OutOfMemory("not enough memory for OpenBLAS, which needs 256 MB", 0);
    ::munmap(room, kBuffers_bytes);
    known = true;
}
#else
void require_blas_memory() {}
#endif

}  // namespace palpa::mechanics
