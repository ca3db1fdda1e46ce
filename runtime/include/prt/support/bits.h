#pragma once

// Bit fields of up to 32 bits in a byte array, lowest bit first. Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Writes bit fields.
class BitWriter {
public:
    /// Appends the lowest `width` bits of `value`, width <= 32.
    void write(std::uint32_t value, int width) {
        for (int b = 0; b < width; ++b, ++position_) {
            if (position_ % 8 == 0)
                bytes_.push_back(std::byte{0});
            if (value >> b & 1)
                bytes_.back() |= std::byte{1} << static_cast<int>(position_ % 8);
        }
    }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

/// Reads bit fields.
class BitReader {
public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    /// Returns whether `width` bits are left.
    bool has(int width) const { return position_ + static_cast<std::size_t>(width) <= bytes_.size() * 8; }
    /// Reads the next `width` bits, width <= 32; they must exist.
    std::uint32_t read(int width) {
        std::uint32_t value = 0;
        for (int b = 0; b < width; ++b, ++position_)
            value |= (std::to_integer<std::uint32_t>(bytes_[position_ / 8]) >> (position_ % 8) & 1u) << b;
        return value;
    }

private:
    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
};

} // namespace prt
