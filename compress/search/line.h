#pragma once

#include "prt/compress.h"

#include <compare>
#include <limits>

namespace prt {

/// A number of clusters is searched for along a line: all else stays as it says.
struct Line {
    int payload = 1; ///< 32-bit words of a receiver, or groups of four floats
    bool bases_count = true;
    int most_components = std::numeric_limits<int>::max(); ///< fewer where bytes are so few
    GuideChoice guides = GuideChoice::normal;
    double basis_share = -1; ///< CompressOptions::basis_share; below 0: as tuned
    bool finished = false;   ///< with all rounds and seams: drafts tell only where to look
    friend auto operator<=>(const Line&, const Line&) = default;
};

/// Bytes of a receiver that a payload takes; beside floats four of them hold the cluster.
double payload_bytes(WeightFormat format, int payload);

/// Words of a preset, or the groups of four that its components take.
int payload_of(const WeightCoding& preset, std::size_t dimension);

/// Rows that guides add to a mean, where the surface has them.
int guide_rows_of(GuideChoice guides, const ReceiverSurface& surface);

} // namespace prt
