#include "make/choices.h"

#include "prt/bake.h"
#include "prt/sh_basis.h"

#include <algorithm>
#include <cmath>

namespace prt::cli {

CutChoice choose_cut(const CutErrors& errors, double allowed) {
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
    constexpr int kFewest = 128, kMost = 1 << 14;
    const double times = std::pow(measured / (kShareOfRays * allowed), 1 / kFall);
    int chosen = kFewest;
    while (chosen < kMost && chosen < times * rays)
        chosen *= 2;
    return chosen;
}

} // namespace prt::cli
