#pragma once

// Range asymmetric numeral systems (rANS; Duda 2013) with four states that take turns (Giesen 2014), as
// docs/format.md says it.

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
inline constexpr std::uint32_t kFrequencyTotal = 1u << kFrequencyBits; ///< of the symbols of a model
inline constexpr std::uint32_t kLeastRansState = 1u << 16;
inline constexpr std::size_t kRansStates = 4;

/// A coded step: `frequency` of 2^bits slots from `first` on.
struct RansStep {
    std::uint32_t frequency, first;
    int bits;
};

/// Bytes from which RansDecoder takes these steps in their order.
std::vector<std::byte> encode_rans(std::span<const RansStep> steps);

/// Symbol of a slot of a model.
class RansSlot {
public:
    RansSlot() = default;
    RansSlot(std::uint32_t symbol, std::uint32_t frequency, std::uint32_t offset)
        : bits_(symbol | frequency << 8 | offset << 20) {}
    std::uint32_t symbol() const { return bits_ & 0xff; }
    std::uint32_t frequency() const { return bits_ >> 8 & 0xfff; }
    std::uint32_t offset() const { return bits_ >> 20; } ///< of the slot from the first of its symbol

private:
    std::uint32_t bits_ = 0;
};

/// Takes up to kMaxSteps steps between two looks at is_beyond_end. Reads zeros where the bytes end.
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
    /// A symbol of the model whose slots are `slots` [kFrequencyTotal].
    [[gnu::always_inline]] std::uint32_t read(const RansSlot* slots) {
        const std::uint32_t state = states_[turn_];
        const RansSlot slot = slots[state & (kFrequencyTotal - 1)];
        take_turns(slot.frequency() * (state >> kFrequencyBits) + slot.offset());
        return slot.symbol();
    }
    /// `width` bits, 0..16, each as likely as not.
    [[gnu::always_inline]] std::uint32_t read_plain(int width) {
        const std::uint32_t state = states_[turn_];
        take_turns(state >> width);
        return state & ((1u << width) - 1);
    }
    /// Whether an encoder wrote these bytes, and all of them were read.
    bool ends_well() const {
        return position_ == end_ &&
               std::ranges::all_of(states_, [](std::uint32_t state) { return state == kLeastRansState; });
    }

private:
    /// Without a branch on the state, which nothing could predict.
    [[gnu::always_inline]] void take_turns(std::uint32_t state) {
        const std::uint32_t is_small = state < kLeastRansState ? 1 : 0;
        states_[turn_] = state << (16 * is_small) | (unit(position_) & (0u - is_small));
        position_ += 2 * is_small;
        turn_ = (turn_ + 1) % kRansStates;
    }
    [[gnu::always_inline]] std::uint32_t unit(std::size_t position) const {
        std::uint16_t value = 0; // little-endian, as glTF is
        std::memcpy(&value, bytes_.data() + position, sizeof value);
        return value;
    }

    std::vector<std::byte> bytes_; ///< and zeros, so that no step has to look for the end
    std::size_t end_;
    std::array<std::uint32_t, kRansStates> states_{};
    std::size_t turn_ = 0;
    std::size_t position_ = 4 * kRansStates;
};

} // namespace prt
