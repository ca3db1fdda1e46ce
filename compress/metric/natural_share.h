#pragma once

#include "prt/light_metric.h"

namespace prt {

/// Adds a hundredth of `natural_metric` to a metric that has distant light alone, so that no error is free,
/// and lamps beside it as `natural_metric` has them.
void add_natural_share(LightMetric& metric);

} // namespace prt
