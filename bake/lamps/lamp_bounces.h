#pragma once

// Bounces of lamps at receivers, with less noise than between them.

#include "lamps/lamp_rows.h"
#include "surface/bounce_filter.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Gathers the last bounce of lamps by LampRows, and filters it.
class LampBounces {
public:
    /// `first_row`: of LampRows::all among the rows of TransportOperators::check; those of `half` follow.
    /// `left_out` [receivers]: those whose light is not what their own rays gathered.
    LampBounces(const BakePlan& plan, const SharedPlaces& shared, std::vector<bool> left_out,
                std::size_t first_row);

    bool filters() const { return filter_.has_value(); }
    /// Replaces what `light` has more than `unbounced`, [receivers][channels][columns] both. `gathered` is
    /// Propagated::at_check.
    void apply(Transfer& light, const Transfer& unbounced, std::span<const float> gathered) const;

private:
    std::vector<bool> left_out_;
    std::size_t first_row_;
    std::optional<BounceFilter> filter_;
};

} // namespace prt
