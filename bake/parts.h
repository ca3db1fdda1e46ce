#pragma once

// Exit transfer taken apart: what arrives without a bounce, and the rest (docs/math.md, section 7).

#include "plan.h"
#include "scene/refill.h"

namespace prt {

/// Exit transfer without bounces and media, of all receivers of `plan`: `incident` light, one channel, with
/// `refill`. Dark where all light goes through a medium.
Transfer exit_without_bounces(const BakePlan& plan, Transfer incident, const Refill& refill);

/// `all` exit transfer with the part `direct` apart from the rest; a part that is nothing is left out
/// beside another. Both of the same receivers; `direct` may have one channel where `all` has three.
Transfer in_parts(const Transfer& direct, const Transfer& all);

/// The part `direct` and the part `rest`, but for one that is nothing beside another.
Transfer joined(const Transfer& direct, const Transfer& rest);

/// `sky` transfer with a part for each of `lamps` behind, whose light is coefficient k of `light`; of as many
/// channels as it needs. Throws `Error` where floats of a file do not hold it.
Transfer with_lamps(const Transfer& sky, const Transfer& light, const std::vector<Lamp>& lamps);

/// `transfer` of one part in one channel where all three are the same.
Transfer narrowed(Transfer transfer);

/// `colored` transfer of one part: one of its channels.
Transfer one_channel(const Transfer& colored, int channel);

/// Three channels of one part.
Transfer in_color(const Transfer& red, const Transfer& green, const Transfer& blue);
/// `white` in three equal channels.
inline Transfer in_color(const Transfer& white) {
    return in_color(white, white, white);
}

} // namespace prt
