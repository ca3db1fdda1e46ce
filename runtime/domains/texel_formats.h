#pragma once

// Conversion of radiance to texture formats, sixteen texels at a time.

#include "prt/core/texture_relighter.h"
#include "runtime/core/support/vector_lanes.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace prt {

/// Radiance of consecutive texels, one vector per color.
struct RadianceLanes {
    Lanes colors[3];
};

using WordLanes [[gnu::vector_size(4 * kLaneCount)]] = std::int32_t;

namespace texel_formats {

[[gnu::always_inline]] inline WordLanes bits_of(const Lanes& values) {
    WordLanes bits;
    std::memcpy(&bits, &values, sizeof bits);
    return bits;
}

[[gnu::always_inline]] inline Lanes floats_of(const WordLanes& bits) {
    Lanes values;
    std::memcpy(&values, &bits, sizeof values);
    return values;
}

/// Clamps to [0, most]; NaN becomes 0.
[[gnu::always_inline]] inline Lanes within(const Lanes& v, float most) {
    const Lanes positive = v > 0 ? v : Lanes{};
    return positive < most ? positive : Lanes{} + most;
}

/// Returns the bits of a float with five exponent bits, `mantissa` mantissa bits and no sign, rounded to
/// nearest.
[[gnu::always_inline]] inline WordLanes small_float(const Lanes& v, float most, int mantissa) {
    constexpr float kBias = 0x1p-112f; // changes the exponent bias from 127 to 15
    const WordLanes bits = bits_of(within(v, most) * kBias);
    return (bits + (1 << (22 - mantissa))) >> (23 - mantissa);
}

/// Returns a half float with sign, rounded to nearest, at most 65 504 in magnitude; NaN becomes 0.
[[gnu::always_inline]] inline WordLanes signed_half(const Lanes& v) {
    const WordLanes bits = bits_of(v);
    return small_float(floats_of(bits & 0x7FFFFFFF), 65504, 10) | (bits >> 16 & 0x8000);
}

/// Packs EXT_texture_shared_exponent: the largest color, rounded to nine bits, determines the shared
/// exponent.
[[gnu::always_inline]] inline WordLanes shared_exponent(const RadianceLanes& radiance) {
    constexpr float kMax = 65408;
    Lanes colors[3], largest = {};
    for (int c = 0; c < 3; ++c) {
        colors[c] = within(radiance.colors[c], kMax);
        largest = colors[c] > largest ? colors[c] : largest;
    }
    const WordLanes exponent = ((bits_of(largest) + 0x4000) >> 23) - 127 + 16;
    const WordLanes shared = exponent > 0 ? exponent : WordLanes{};
    const Lanes scale = floats_of((24 - shared + 127) << 23);
    WordLanes word = shared << 27;
    for (int c = 0; c < 3; ++c)
        word |= __builtin_convertvector(colors[c] * scale + 0.5f, WordLanes) << (9 * c);
    return word;
}

/// Returns the value of a float with five exponent bits and `mantissa` mantissa bits.
inline float small_float(std::uint32_t bits, int mantissa) {
    return std::bit_cast<float>(bits << (23 - mantissa)) * 0x1p112f;
}

} // namespace texel_formats

inline glm::vec3 read_texel(TexelFormat format, const std::byte* texel) {
    using texel_formats::small_float;
    if (format == TexelFormat::rgba32) {
        glm::vec3 color;
        std::memcpy(&color, texel, sizeof color);
        return color;
    }
    if (format == TexelFormat::rgba16) {
        std::uint16_t halves[3];
        std::memcpy(halves, texel, sizeof halves);
        return {small_float(halves[0], 10), small_float(halves[1], 10), small_float(halves[2], 10)};
    }
    std::uint32_t word = 0;
    std::memcpy(&word, texel, sizeof word);
    if (format == TexelFormat::r11g11b10)
        return {small_float(word & 2047u, 6), small_float(word >> 11 & 2047u, 6), small_float(word >> 22, 5)};
    const auto scale = std::bit_cast<float>(((word >> 27) + 103) << 23); // 2^(exponent - 24)
    return scale * glm::vec3(word & 511u, word >> 9 & 511u, word >> 18 & 511u);
}

/// Writes the first `count` texels of the lanes to `to`.
[[gnu::always_inline]] inline void write_texels(TexelFormat format, const RadianceLanes& radiance,
                                                std::size_t count, std::byte* to) {
    using namespace texel_formats;
    if (format == TexelFormat::rgba32) {
        Lanes colors[3];
        for (int c = 0; c < 3; ++c)
            colors[c] = within(radiance.colors[c], std::numeric_limits<float>::max());
        for (std::size_t i = 0; i < count; ++i) {
            const float texel[] = {colors[0][i], colors[1][i], colors[2][i], 1};
            std::memcpy(to + i * sizeof texel, texel, sizeof texel);
        }
        return;
    }
    if (format == TexelFormat::rgba16) {
        std::uint16_t halves[kLaneCount][4];
        WordLanes colors[3];
        for (int c = 0; c < 3; ++c)
            colors[c] = small_float(radiance.colors[c], 65504, 10);
        for (std::size_t i = 0; i < kLaneCount; ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                halves[i][c] = static_cast<std::uint16_t>(colors[c][i]);
            halves[i][3] = 0x3C00; // 1
        }
        std::memcpy(to, halves, count * sizeof halves[0]);
        return;
    }
    const WordLanes words = format == TexelFormat::rgb9e5
                                ? shared_exponent(radiance)
                                : small_float(radiance.colors[0], 65024, 6) |
                                      small_float(radiance.colors[1], 65024, 6) << 11 |
                                      small_float(radiance.colors[2], 64512, 5) << 22;
    std::memcpy(to, &words, count * sizeof(std::int32_t));
}

} // namespace prt
