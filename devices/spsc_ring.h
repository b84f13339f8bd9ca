#pragma once
// Passes values from one thread to another, without locks and without waiting.

#include <array>
#include <atomic>
#include <cstddef>

namespace palpa::devices {

// One thread pushes, one pops. The ring holds N values; N must be a power of two.
template <class T, std::size_t N>
class SpscRing {
    static_assert((N & (N - 1)) == 0, "the indices wrap around with their type");

  public:
    // Returns false if the ring is full: the value is then not taken.
    bool push(const T& value) {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == N) return false;
        values_[head & (N - 1)] = value;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    bool pop(T& out) {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (head_.load(std::memory_order_acquire) == tail) return false;
        out = values_[tail & (N - 1)];
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

  private:
    std::array<T, N> values_{};
    alignas(64) std::atomic<std::size_t> head_{
        0};  // on cache lines of their own, so that the threads do not slow each other down
    alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace palpa::devices
