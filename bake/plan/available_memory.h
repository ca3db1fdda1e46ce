#pragma once

// Memory that is available for a bake.

#include <filesystem>

namespace prt {

/// Bytes that this process may use: the machine's memory, or less if a container limits it. 0 if the system
/// does not report it.
double available_memory();
/// Returns `limit`, or the available memory if `limit` is 0.
inline double available_memory(double limit) {
    return limit > 0 ? limit : available_memory();
}

/// Returns the smallest limit of the control groups (Linux, versions 1 and 2) named in `membership` (a
/// /proc/self/cgroup) and of their parents, under `mounted` (/sys/fs/cgroup); infinite if no limit is set.
double control_group_limit(const std::filesystem::path& membership, const std::filesystem::path& mounted);

} // namespace prt
