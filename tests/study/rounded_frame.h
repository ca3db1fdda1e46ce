#pragma once

#include "compress/metric/frame.h"

namespace prt {

/// A frame as a file has it.
struct RoundedFrame {
    std::vector<double> origin;    ///< [full], as float16
    std::vector<double> synthesis; ///< [dimension][full], each axis with a separate step
    double bytes = 0;
};

/// `frame` with axes so coarse that the squared error grows by about `error`; 0: axes are floats.
RoundedFrame rounded(const Frame& frame, const LightMetric& metric, double error);

} // namespace prt
