#pragma once

// How much memory there is to bake in.

#include <filesystem>

namespace prt {

/// Bytes that this process may use: the machine's memory, or less where a container allows less. 0 where the
/// system does not say.
double available_memory();
/// The same where `limit` is 0, which is what a bake is told that it may take.
inline double available_memory(double limit) {
    return limit > 0 ? limit : available_memory();
}

/// The least limit of the control groups (Linux, versions 1 and 2) that `membership` (a /proc/self/cgroup)
/// names, and of those above them, under `mounted` (/sys/fs/cgroup); infinite where none is set.
double control_group_limit(const std::filesystem::path& membership, const std::filesystem::path& mounted);

} // namespace prt
