// Copies weights of points into SIMD lanes.

#include "compress/metric/point_scales.h"

namespace prt {

void PointScales::gather(std::span<const std::uint32_t> points, float* to) const {
    for (std::size_t lane = 0; lane < kLanes && groups > 0; ++lane) {
        const std::span<const float> own = of(points[lane < points.size() ? lane : 0]);
        for (std::size_t g = 0; g < groups; ++g)
            to[g * kLanes + lane] = own[g];
    }
}

} // namespace prt
