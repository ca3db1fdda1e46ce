// Distance fall-off of occlusion.

#include "prt/bake/bake_options.h"

#include "prt/core/error.h"

#include <cmath>

namespace prt {

bool Falloff::blocks_everywhere() const {
    return terms.empty() && std::isinf(farthest);
}

double Falloff::passes(double distance) const {
    if (distance > farthest)
        return 1;
    double passing = 0, shares = 0;
    for (const Term& term : terms) {
        passing += term.share * (1 - std::exp2(-distance / term.half_distance));
        shares += term.share;
    }
    return shares > 0 ? passing / shares : 0;
}

void check_falloff(const Falloff& falloff) {
    double shares = 0;
    for (const Falloff::Term& term : falloff.terms) {
        if (!(term.half_distance > 0 && std::isfinite(term.half_distance)))
            throw Error("the half distance of a fall-off must be finite and greater than 0");
        if (!(term.share >= 0 && std::isfinite(term.share)))
            throw Error("the share of a fall-off must be finite and not negative");
        shares += term.share;
    }
    if (!falloff.terms.empty() && !(shares > 0))
        throw Error("the shares of the fall-off are all 0");
    if (!(falloff.farthest > 0))
        throw Error("the maximum distance of occlusion must be greater than 0");
}

} // namespace prt
