// Encodes rANS symbols, from the last to the first.
#include "runtime/core/transfer/rans.h"

#include <algorithm>

namespace prt {

std::vector<std::byte> encode_rans(std::span<const RansStep> steps) {
    std::vector<std::uint16_t> units; // in reverse order
    std::array<std::uint32_t, kRansStates> states;
    states.fill(kMinRansState);
    for (std::size_t i = steps.size(); i-- > 0;) {
        const auto& [frequency, first, bits] = steps[i];
        std::uint32_t& state = states[i % kRansStates];
        if (state >= static_cast<std::uint64_t>(frequency) << (32 - bits)) {
            units.push_back(static_cast<std::uint16_t>(state));
            state >>= 16;
        }
        state = ((state / frequency) << bits) + state % frequency + first;
    }
    for (std::size_t i = kRansStates; i-- > 0;)
        for (const int shift : {16, 0})
            units.push_back(static_cast<std::uint16_t>(states[i] >> shift));
    std::vector<std::byte> bytes;
    for (std::size_t i = units.size(); i-- > 0;)
        for (const int shift : {0, 8})
            bytes.push_back(static_cast<std::byte>(units[i] >> shift & 0xff));
    return bytes;
}

} // namespace prt
