#pragma once
// A hash of the content of a frame: two frames with the same hash look the same.

#include <cstdint>
#include <cstring>

namespace palpa::app {

// Adds `size` bytes to `hash`, eight at a time: 100 KB of triangles per frame cost tens of microseconds.
inline std::uint64_t hash_more(std::uint64_t hash, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes + i, size - i < sizeof word ? size - i : sizeof word);
        hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash;
}

}  // namespace palpa::app
