#pragma once

// Regularisation of light metrics.

#include "prt/compress/light_metric.h"

namespace prt {

/// Adds a hundredth of `natural_metric` to a metric of distant light, so that no error is free, and adds the
/// lamps of `natural_metric`.
void add_natural_share(LightMetric& metric);

} // namespace prt
