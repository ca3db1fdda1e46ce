#pragma once

// Compression within a search.

#include "prt/compress/compress.h"

namespace prt {

class SeenLight;

/// Settings of one compression within a search.
struct TrialSettings {
    /// [receivers] clusters of an earlier result, which are split and merged to the desired number: saves
    /// half of the time. Empty: start from vector quantisation.
    std::span<const std::uint16_t> start = {};
    /// Few rounds and no seams: takes a third of the time; the error is known to a few hundredths.
    bool draft = false;
    /// Light of the same transfer, areas and metric; computed if null.
    const SeenLight* light = nullptr;
};

CompressResult compress_from(const TrialSettings& settings, const TransferView& transfer,
                             const ReceiverSurface& surface, const CompressOptions& options,
                             const Progress& progress);

} // namespace prt
