#pragma once

// Binary arithmetic coding with adaptive models (Martin 1979; Witten, Neal and Cleary 1987), as specified in
// docs/format.md.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Adaptive estimate of the probability that a bit is 1, in 65536ths. It adapts quickly at first.
class BitModel {
public:
    std::uint32_t one() const { return one_; }
    void learn(bool bit) {
        const std::int32_t wrong = (bit ? 65536 : 0) - static_cast<std::int32_t>(one_);
        one_ = static_cast<std::uint32_t>(static_cast<std::int32_t>(one_) + wrong / (seen_ + 2));
        one_ = one_ < kMin ? kMin : one_ > 65536 - kMin ? 65536 - kMin : one_;
        seen_ += seen_ < kMaxSeen ? 1 : 0;
    }

private:
    static constexpr std::uint32_t kMin = 64;
    static constexpr std::int32_t kMaxSeen = 62;
    std::uint32_t one_ = 32768;
    std::int32_t seen_ = 0;
};

class RangeEncoder {
public:
    void write(bool bit, BitModel& model) {
        const std::uint32_t bound = (range_ >> 16) * model.one();
        model.learn(bit);
        take(bit, bound);
    }
    /// Writes the lowest `width` bits of `value`, highest first, with probability 1/2 each.
    void write_plain(std::uint32_t value, int width) {
        while (width-- > 0)
            take(value >> width & 1, range_ >> 1);
    }
    std::vector<std::byte> finish();

private:
    void take(bool bit, std::uint32_t bound) {
        if (!bit)
            low_ += bound;
        range_ = bit ? bound : range_ - bound;
        while (range_ < 1u << 24) {
            shift_out();
            range_ <<= 8;
        }
    }
    /// Writes the highest byte of `low_`. A carry can still propagate through preceding bytes of 255.
    void shift_out();

    std::uint64_t low_ = 0; ///< 33 bits
    std::uint32_t range_ = ~0u;
    std::vector<std::byte> bytes_;
};

/// Range decoder; reads zeros after the end of the bytes.
class RangeDecoder {
public:
    explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
        for (int i = 0; i < 4; ++i)
            code_ = code_ << 8 | next();
    }
    bool read(BitModel& model) {
        const bool bit = take((range_ >> 16) * model.one());
        model.learn(bit);
        return bit;
    }
    std::uint32_t read_plain(int width) {
        std::uint32_t value = 0;
        while (width-- > 0)
            value = value << 1 | (take(range_ >> 1) ? 1u : 0u);
        return value;
    }
    /// Returns whether more bytes were read than an encoder writes.
    bool beyond_end() const { return position_ > bytes_.size(); }

private:
    bool take(std::uint32_t bound) {
        const bool bit = code_ < bound;
        if (!bit)
            code_ -= bound;
        range_ = bit ? bound : range_ - bound;
        while (range_ < 1u << 24) {
            code_ = code_ << 8 | next();
            range_ <<= 8;
        }
        return bit;
    }
    std::uint32_t next() {
        const std::size_t at = position_++;
        return at < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at]) : 0;
    }

    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
    std::uint32_t code_ = 0, range_ = ~0u;
};

} // namespace prt
