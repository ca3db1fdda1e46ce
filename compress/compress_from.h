#pragma once

#include "prt/compress.h"

namespace prt {

class SeenLight;

/// How a compression of a search goes.
struct Course {
    /// [receivers] clusters of an earlier result, which are split and merged to the number wanted: half of
    /// the time. Empty: from vector quantisation.
    std::span<const std::uint16_t> start = {};
    /// Few rounds and no seams: a third of the time, for an error that is known to a few hundredths.
    bool draft = false;
    /// Of this transfer, these areas and this metric; made anew where null.
    const SeenLight* light = nullptr;
};

CompressResult compress_from(const Course& course, const TransferView& transfer,
                             const ReceiverSurface& surface, const CompressOptions& options,
                             const Progress& progress);

} // namespace prt
