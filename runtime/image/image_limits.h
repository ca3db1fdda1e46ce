#pragma once

#include <cstdint>

namespace prt {

/// Images that claim more pixels are refused before memory is taken for them.
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;

} // namespace prt
