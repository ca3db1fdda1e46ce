#pragma once

// Range asymmetric numeral systems (rANS; Duda 2013) with four interleaved states (Giesen 2014), as specified
// in docs/format.md.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace prt {

inline constexpr int kFrequencyBits = 10;
inline constexpr std::uint32_t kFrequencyTotal = 1u << kFrequencyBits; ///< sum over the symbols of a model
inline constexpr std::uint32_t kMinRansState = 1u << 16;
inline constexpr std::size_t kRansStates = 4;

/// A coded step: `frequency` of 2^bits slots, starting at `first`.
struct RansStep {
    std::uint32_t frequency, first;
    int bits;
};

/// Returns the bytes from which RansDecoder reads these steps in order.
std::vector<std::byte> encode_rans(std::span<const RansStep> steps);

/// One slot of a model with its symbol.
class RansSlot {
public:
    RansSlot() = default;
    RansSlot(std::uint32_t symbol, std::uint32_t frequency, std::uint32_t offset)
        : bits_(symbol | frequency << 8 | offset << 20) {}
    std::uint32_t symbol() const { return bits_ & 0xff; }
    std::uint32_t frequency() const { return bits_ >> 8 & 0xfff; }
    /// Distance of the slot from the first slot of its symbol.
    std::uint32_t offset() const { return bits_ >> 20; }

private:
    std::uint32_t bits_ = 0;
};

/// rANS decoder. It may read up to kMaxSteps steps between two calls of is_beyond_end. Reads zeros after the
/// end of the bytes.
class RansDecoder {
public:
    static constexpr std::size_t kMaxSteps = 64;

    explicit RansDecoder(std::span<const std::byte> bytes)
        : bytes_(bytes.begin(), bytes.end()), end_(bytes.size()) {
        bytes_.resize(end_ + position_ + 2 * kMaxSteps);
        for (std::size_t i = 0; i < kRansStates; ++i)
            states_[i] = unit(4 * i) | unit(4 * i + 2) << 16;
    }
    bool is_beyond_end() const { return position_ > end_; }
    /// Reads a symbol of the model whose slots are `slots` [kFrequencyTotal].
    [[gnu::always_inline]] std::uint32_t read(const RansSlot* slots) {
        const std::uint32_t state = states_[turn_];
        const RansSlot slot = slots[state & (kFrequencyTotal - 1)];
        take_turns(slot.frequency() * (state >> kFrequencyBits) + slot.offset());
        return slot.symbol();
    }
    /// Reads `width` bits, 0..16, with uniform probability.
    [[gnu::always_inline]] std::uint32_t read_plain(int width) {
        const std::uint32_t state = states_[turn_];
        take_turns(state >> width);
        return state & ((1u << width) - 1);
    }
    /// Returns whether all bytes were read and the states are those of a valid end.
    bool ends_well() const {
        return position_ == end_ &&
               std::ranges::all_of(states_, [](std::uint32_t state) { return state == kMinRansState; });
    }

private:
    /// Refills the state without a branch, because the branch would be unpredictable.
    [[gnu::always_inline]] void take_turns(std::uint32_t state) {
        const std::uint32_t is_small = state < kMinRansState ? 1 : 0;
        states_[turn_] = state << (16 * is_small) | (unit(position_) & (0u - is_small));
        position_ += 2 * is_small;
        turn_ = (turn_ + 1) % kRansStates;
    }
    [[gnu::always_inline]] std::uint32_t unit(std::size_t position) const {
        std::uint16_t value = 0; // little-endian, like glTF
        std::memcpy(&value, bytes_.data() + position, sizeof value);
        return value;
    }

    std::vector<std::byte> bytes_; ///< the bytes, then zeros, so that steps need no bounds check
    std::size_t end_;
    std::array<std::uint32_t, kRansStates> states_{};
    std::size_t turn_ = 0;
    std::size_t position_ = 4 * kRansStates;
};

} // namespace prt
