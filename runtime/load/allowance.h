#pragma once

// Memory limit for reading a file.

#include "runtime/load/gltf_data.h"

#include <cstddef>
#include <string>

namespace prt {

/// Throws `Error` if `what` needs more than 256 MB plus 64 bytes per byte of a file of `file_bytes`. Data
/// that a file describes without containing it, such as zeros and instances, has no other limit. `bytes` is a
/// product of numbers from the file, in double so that it cannot overflow.
void check_allowed(double bytes, std::size_t file_bytes, const std::string& what);

/// Throws `Error` if `what`, memory that a scene needs for repeated data, exceeds GltfOptions::scene_limit,
/// or, if that is 0, the limit of `check_allowed`.
void check_scene_allowed(double bytes, const GltfData& data, const std::string& what);

} // namespace prt
