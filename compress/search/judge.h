#pragma once

#include "prt/jumps.h"
#include "prt/search.h"

#include <optional>

namespace prt {

/// What a result is to be judged by.
struct Verdict {
    double worst_lit_rms =
        0;           ///< the greatest of the expected error and, at their worst turns, of promised skies
    double jump = 0; ///< `Budget::max_jump`; 0 where none is asked about
};

/// Judges results of one transfer by what a budget promises. Keeps references.
class Judge {
public:
    Judge(const TransferView& transfer, const ReceiverSurface& surface, const LightMetric& metric,
          const Budget& budget, int threads);

    Verdict operator()(const CompressResult& result) const;

private:
    const TransferView& transfer_;
    const ReceiverSurface& surface_;
    const Budget& budget_;
    int threads_;
    std::vector<double> squares_; ///< `ErrorMoments::references`, where skies are promised
    std::optional<ClusterJumps> jumps_; ///< where jumps are promised
};

} // namespace prt
