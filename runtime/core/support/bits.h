#pragma once

// Reading and writing of bit fields of up to 32 bits in a byte array. Fields follow each other without gaps,
// lowest bit first, from the lowest bit of each byte. Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Writes bit fields to a byte array that it owns and that grows as needed.
class BitWriter {
public:
    /// Appends the lowest `width` bits of `value`, lowest bit first; 0 <= width <= 32.
    void write(std::uint32_t value, int width) {
        for (int b = 0; b < width; ++b, ++position_) {
            if (position_ % 8 == 0)
                bytes_.push_back(std::byte{0});
            if (value >> b & 1)
                bytes_.back() |= std::byte{1} << static_cast<int>(position_ % 8);
        }
    }
    /// Moves the bytes written so far to the caller. Unused high bits of the last byte are 0. The writer must
    /// not be used afterwards.
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

/// Reads the bit fields that `BitWriter` wrote, from first to last.
class BitReader {
public:
    /// Starts at the lowest bit of the first byte. Keeps a reference to `bytes`, which must outlive the
    /// reader.
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    /// Returns whether at least `width` >= 0 unread bits are left, including unused bits of the last byte.
    bool has(int width) const { return position_ + static_cast<std::size_t>(width) <= bytes_.size() * 8; }
    /// Returns the next `width` bits as a number, lowest bit first, and moves past them; 0 <= width <= 32.
    /// The caller must ensure `has(width)`.
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
