#pragma once
// Tables on disk. Only table_maker.cpp includes this.

#include "tactile/table.h"

namespace palpa::tactile {

// Stands for everything that a table depends on.
std::uint64_t table_fingerprint(const Renderer& renderer, const TableOptions& options);

// Fills a table from the cache. Returns false if there is none that fits table.observed and table.linear.
bool restore_table(const std::filesystem::path& cache, std::uint64_t fingerprint, Table& table);

// Returns a warning for people, or "".
std::string store_table(const std::filesystem::path& cache, std::uint64_t fingerprint, const Table& table);

}  // namespace palpa::tactile
