#pragma once

// What a file may make its reader allocate.

#include "gltf/contents.h"

#include <cstddef>
#include <string>

namespace prt {

/// Throws `Error` when `what` takes more than 256 MB and 64 bytes for each byte of a file of `file_bytes`:
/// what a file describes without holding it, such as zeros and instances, is bounded by nothing else. `bytes`
/// is a product of numbers from the file, which a double holds without wrapping around.
void check_allowed(double bytes, std::size_t file_bytes, const std::string& what);

/// The same of what scenes take by repetition, which `GltfOptions::scene_limit` replaces where it is not 0.
void check_scene_allowed(double bytes, const GltfContents& contents, const std::string& what);

} // namespace prt
