#pragma once
// Passes the latest value from one thread to one other without either waiting. A value that was not taken before the
// next one is put is lost.

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace palpa::session {

// There are three places: the writer's, the reader's, and one between them, which either thread exchanges for its own.
template <class T>
class LatestValue {
    static_assert(std::is_trivially_copyable_v<T>, "it is copied in a loop that must not allocate");

  public:
    // Called by the one thread that writes.
    void put(const T& value) noexcept {
        place_[writing_] = value;
        const auto fresh = static_cast<std::uint8_t>(writing_ | kNew);
        writing_ = static_cast<std::uint8_t>(between_.exchange(fresh, std::memory_order_acq_rel) & kPlace);
    }

    // Called by the one thread that reads. Returns false, and leaves `out` as it is, if nothing came since the last
    // call.
    bool take(T& out) noexcept {
        if ((between_.load(std::memory_order_relaxed) & kNew) == 0) return false;
        reading_ = static_cast<std::uint8_t>(between_.exchange(reading_, std::memory_order_acq_rel) & kPlace);
        out = place_[reading_];
        return true;
    }

  private:
    static constexpr std::uint8_t kPlace = 3;
    static constexpr std::uint8_t kNew = 4;
    std::array<T, 3> place_{};
    std::uint8_t writing_ = 0;
    std::uint8_t reading_ = 1;
    std::atomic<std::uint8_t> between_{2};
};

}  // namespace palpa::session
