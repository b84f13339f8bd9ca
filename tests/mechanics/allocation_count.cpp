#include "tests/mechanics/allocation_count.h"

#include <atomic>
#include <cstddef>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__GLIBC__)

namespace {
std::atomic<long> count{0};
}

extern "C" void* __libc_malloc(std::size_t bytes);

extern "C" void* malloc(std::size_t bytes) {
    count.fetch_add(1, std::memory_order_relaxed);
    return __libc_malloc(bytes);
}

long allocation_count() { return count.load(); }
bool allocation_count_works() { return true; }

#else

long allocation_count() { return 0; }
bool allocation_count_works() { return false; }

#endif
