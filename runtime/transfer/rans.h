#pragma once

// Range asymmetric numeral systems (rANS; Duda 2013) with four states that take turns (Giesen 2014), as
// docs/format.md says it.

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

/// Symbol of each slot of a model; what is 0 stands for no symbol.
class RansSlot {
public:
    RansSlot() = default;
    RansSlot(std::uint32_t symbol, std::uint32_t frequency, std::uint32_t offset)
        : bits_(symbol | frequency << 8 | offset << 20) {}
    bool is_empty() const { return bits_ == 0; }
    std::uint32_t symbol() const { return bits_ & 0xff; }
    std::uint32_t frequency() const { return bits_ >> 8 & 0xfff; }
    std::uint32_t offset() const { return bits_ >> 20; } ///< of the slot from the first of its symbol

private:
    std::uint32_t bits_ = 0;
};

/// Reads zeros where the bytes end.
class RansDecoder {
public:
    explicit RansDecoder(std::span<const std::byte> bytes)
        : bytes_(bytes), state_(first_state(0)), second_(first_state(1)), third_(first_state(2)),
          fourth_(first_state(3)), position_(4 * kRansStates) {}
    /// A symbol of the model whose slots are `slots` [kFrequencyTotal].
    [[gnu::always_inline]] std::uint32_t read(const RansSlot* slots) {
        const RansSlot slot = slots[state_ & (kFrequencyTotal - 1)];
        damaged_ |= slot.is_empty();
        take_turns(slot.frequency() * (state_ >> kFrequencyBits) + slot.offset());
        return slot.symbol();
    }
    /// `width` bits, 0..16, each as likely as not.
    [[gnu::always_inline]] std::uint32_t read_plain(int width) {
        const std::uint32_t value = state_ & ((1u << width) - 1);
        take_turns(state_ >> width);
        return value;
    }
    /// Whether an encoder wrote these bytes, and all of them were read.
    bool ends_well() const {
        return !damaged_ && position_ == bytes_.size() && state_ == kLeastRansState &&
               second_ == kLeastRansState && third_ == kLeastRansState && fourth_ == kLeastRansState;
    }

private:
    /// Without a branch on the state, which nothing could predict.
    [[gnu::always_inline]] void take_turns(std::uint32_t state) {
        const bool is_small = state < kLeastRansState;
        const std::uint32_t longer = state << 16 | unit(position_);
        position_ += is_small ? 2 : 0;
        state_ = second_;
        second_ = third_;
        third_ = fourth_;
        fourth_ = is_small ? longer : state;
    }
    [[gnu::always_inline]] std::uint32_t unit(std::size_t position) const {
        std::uint16_t value = 0; // little-endian, as glTF is
        if (position + 2 <= bytes_.size())
            std::memcpy(&value, bytes_.data() + position, sizeof value);
        return value;
    }
    std::uint32_t first_state(std::size_t state) const { return unit(4 * state) | unit(4 * state + 2) << 16; }

    std::span<const std::byte> bytes_;
    std::uint32_t state_, second_, third_, fourth_; ///< the one that is next, first
    std::size_t position_;
    bool damaged_ = false;
};

} // namespace prt
