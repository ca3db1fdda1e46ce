#pragma once

// Splits exit transfer into light that arrives without a bounce and the rest (docs/math.md, section 7).

#include "bake/plan/plan.h"
#include "bake/scene/refill.h"

namespace prt {

/// Computes exit transfer without bounces and media for all receivers of `plan`: `incident` light with one
/// channel, after `refill`. Receivers on media are dark, because all their light passes the medium.
Transfer exit_without_bounces(const BakePlan& plan, Transfer incident, const Refill& refill);

/// Splits `all` exit transfer into the term `direct` and the rest. A term that is zero is omitted if the
/// other is not. Both have the same receivers; `direct` may have one channel if `all` has three.
Transfer in_terms(const Transfer& direct, const Transfer& all);

/// Joins the term `direct` and the term `rest`. A term that is zero is omitted if the other is not.
Transfer joined(const Transfer& direct, const Transfer& rest);

/// Appends a term for each of `lamps` to `sky` transfer. The light of lamp k is coefficient k of `light`; its
/// term has one channel if the light is white, otherwise three. Throws `Error` if a value exceeds the range
/// of the file format.
Transfer with_lamps(const Transfer& sky, const Transfer& light, const std::vector<Lamp>& lamps);

/// Converts `transfer` of one term to one channel if its three channels are equal.
Transfer narrowed(Transfer transfer);

/// Extracts one channel of `colored` transfer of one term.
Transfer one_channel(const Transfer& colored, int channel);

/// Joins three channels of one term.
Transfer in_color(const Transfer& red, const Transfer& green, const Transfer& blue);
/// Copies `white` to three equal channels.
inline Transfer in_color(const Transfer& white) {
    return in_color(white, white, white);
}

} // namespace prt
