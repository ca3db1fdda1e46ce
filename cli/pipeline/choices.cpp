// Chooses order, bounces, rays and the requested compression error.

#include "cli/pipeline/choices.h"

#include "prt/bake/bake.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <cmath>

namespace prt::pipeline {

TruncationChoice choose_truncation(const TruncationErrors& errors, double allowed) {
    constexpr double kLittleMore = 1.25;
    int bounces = 0;
    while (bounces < kCountedBounces && errors.bounces(bounces) > kShareOfBounces * allowed)
        ++bounces;
    if (bounces == kCountedBounces)
        bounces = kEndlessBounces;
    const double wanted = std::max(kShareOfLight * allowed, kLittleMore * errors.light(kMaxOrder));
    int order = 2; // a single band has no directions
    while (order < kMaxOrder && errors.light(order) > wanted)
        ++order;
    return {order, bounces, errors.light(order) + errors.bounces(bounces)};
}

int choose_rays(double measured, int rays, double allowed) {
    // Squared noise of nets falls by n^-1.5 at vertices and by n^-1 to n^-1.2 where few samples share them.
    constexpr double kFall = 1.2;
    constexpr int kFewest = 128, kMax = 1 << 14;
    const double times = std::pow(measured / (kShareOfRays * allowed), 1 / kFall);
    int chosen = kFewest;
    while (chosen < kMax && chosen < times * rays)
        chosen *= 2;
    return chosen;
}

void AskedError::came_out(double allowed, double total, double of_bytes, double size) {
    constexpr double kEnough = 0.87;                  // fraction of the squared error: its root is within 7 %
    constexpr double kFarthest = 2.5, kClosest = 1.1; // steps
    const bool keeps = total <= allowed;
    const bool same = size == last_size_;
    last_size_ = size;
    (keeps ? low_ : high_) = next_;
    open_ = of_bytes > 0 && !(keeps && total > kEnough * allowed) &&
            !(keeps && same && high_ == 0) && // no smaller size exists

            !(low_ > 0 && high_ > 0 && high_ < kClosest * low_);
    const double left = std::max(allowed - (total - of_bytes), 0.02 * allowed);
    next_ *= std::clamp(std::sqrt(0.97 * left / std::max(of_bytes, 1e-12)), 1 / kFarthest, kFarthest);
    const bool between = (low_ == 0 || next_ > low_) && (high_ == 0 || next_ < high_);
    if (low_ > 0 && high_ > 0 && (!between || same))
        next_ = std::sqrt(low_ * high_);
    else if (!between)
        next_ = keeps ? kFarthest * low_ : high_ / kFarthest;
}

} // namespace prt::pipeline
