// Codes rows of small integers (docs/format.md).
#include "prt/core/clustered_bases.h"

#include "prt/core/error.h"
#include "runtime/core/transfer/range_coder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <utility>

namespace prt {
namespace {

constexpr int kLevelBits = 4;
/// Maximum number of rows used to choose the drops, spread over all rows: a sample of a thousand is as good
/// as a hundred thousand.
constexpr std::size_t kRowsLookedAt = 1024;
constexpr std::size_t kColumnsLookedAt = 512;

/// Returns the bits of `value` in two's complement; 0 needs no bits.
int width_of(std::int32_t value) {
    if (value == 0)
        return 0;
    return 1 + static_cast<int>(std::bit_width(static_cast<std::uint32_t>(value < 0 ? ~value : value)));
}

/// Returns the minimum level at which all values of a row fit.
int level_of(std::span<const std::uint8_t> widths, std::span<const std::uint8_t> drops) {
    int level = 0;
    for (std::size_t i = 0; i < widths.size(); ++i)
        if (widths[i] > 0)
            level = std::max(level, widths[i] + drops[i]);
    return level;
}

int row_bits(int level, std::span<const std::uint8_t> drops) {
    int bits = kLevelBits;
    for (const std::uint8_t drop : drops)
        bits += std::max(0, level - drop);
    return bits;
}

class Widths {
public:
    Widths(std::span<const std::int32_t> values, std::size_t columns) : columns_(columns) {
        for (const std::int32_t value : values)
            widths_.push_back(static_cast<std::uint8_t>(width_of(value)));
    }
    std::size_t rows() const { return columns_ == 0 ? 0 : widths_.size() / columns_; }
    /// Returns at most `most` rows, evenly spread.
    Widths sample(std::size_t most) const {
        const std::size_t step =
            std::max(std::size_t{1}, (rows() + most - 1) / std::max(most, std::size_t{1}));
        Widths some({}, columns_);
        for (std::size_t r = 0; r < rows(); r += step)
            some.widths_.insert(some.widths_.end(), row(r).begin(), row(r).end());
        return some;
    }
    std::span<const std::uint8_t> row(std::size_t r) const {
        return std::span(widths_).subspan(r * columns_, columns_);
    }
    /// Returns the number of bits of all rows; maximum value of size_t if a level exceeds 15.
    std::size_t total(std::span<const std::uint8_t> drops) const {
        std::array<std::size_t, kMaxRowBits + 1> rows_of_level{};
        for (std::size_t r = 0; r < rows(); ++r) {
            const int level = level_of(row(r), drops);
            if (level > kMaxRowBits)
                return ~std::size_t{0};
            ++rows_of_level[static_cast<std::size_t>(level)];
        }
        std::size_t bits = 0;
        for (int level = 0; level <= kMaxRowBits; ++level)
            bits += rows_of_level[static_cast<std::size_t>(level)] *
                    static_cast<std::size_t>(row_bits(level, drops));
        return bits;
    }

private:
    std::size_t columns_;
    std::vector<std::uint8_t> widths_;
};

/// Returns `drops` with `by` added to all columns from `first` on.
std::vector<std::uint8_t> shifted(std::span<const std::uint8_t> drops, std::size_t first, int by) {
    std::vector<std::uint8_t> result(drops.begin(), drops.end());
    for (std::size_t i = first; i < result.size(); ++i)
        result[i] = static_cast<std::uint8_t>(std::clamp(result[i] + by, 0, kMaxRowBits));
    return result;
}

/// Returns for each column how many bits it is narrower than the widest column, on average.
std::vector<std::uint8_t> mean_drops(const Widths& widths, std::size_t columns) {
    std::vector<double> means(columns, 0);
    for (std::size_t r = 0; r < widths.rows(); ++r)
        for (std::size_t i = 0; i < columns; ++i)
            means[i] += widths.row(r)[i] / static_cast<double>(widths.rows());
    const double widest = columns > 0 ? *std::max_element(means.begin(), means.end()) : 0;
    std::vector<std::uint8_t> drops;
    for (const double mean : means)
        drops.push_back(static_cast<std::uint8_t>(std::clamp(widest - mean, 0.0, double{kMaxRowBits})));
    return drops;
}

/// Searches drops that make the code of these rows short. Starts from the mean drops, or from zero if those
/// make a row too wide. Then changes single columns, and all columns from some index on, by one bit while
/// this shortens the code.
std::vector<std::uint8_t> best_drops_of(const Widths& widths, std::size_t columns) {
    std::vector<std::uint8_t> drops = mean_drops(widths, columns);
    std::size_t least = widths.total(drops);
    if (least == ~std::size_t{0}) {
        drops.assign(columns, 0);
        least = widths.total(drops);
    }
    const auto better = [&](std::vector<std::uint8_t> tried) {
        const std::size_t bits = tried == drops ? least : widths.total(tried);
        if (bits >= least)
            return false;
        least = bits;
        drops = std::move(tried);
        return true;
    };
    // Rows as long as those of probes would take seconds; only some of their columns are tried.
    const std::size_t step = 1 + columns / kColumnsLookedAt;
    for (bool moved = true; moved;) {
        moved = false;
        for (std::size_t i = 0; i < columns; i += step)
            for (const int by : {1, -1}) {
                std::vector<std::uint8_t> one = drops;
                one[i] = static_cast<std::uint8_t>(std::clamp(one[i] + by, 0, kMaxRowBits));
                moved = better(std::move(one)) || moved;
                moved = better(shifted(drops, i, by)) || moved;
            }
    }
    return drops;
}

std::vector<std::uint8_t> best_drops(const Widths& widths, std::size_t columns) {
    const std::vector<std::uint8_t> drops = best_drops_of(widths.sample(kRowsLookedAt), columns);
    return widths.total(drops) == ~std::size_t{0} ? best_drops_of(widths, columns) : drops;
}

/// Adaptive models for values that have room for `width` bits.
struct ValueModels {
    BitModel zero;
    std::array<BitModel, kMaxRowBits> longer; ///< index i: whether the magnitude has more than i + 1 bits
    std::array<BitModel, kMaxRowBits> second; ///< the bit below the highest, indexed by the number of bits
                                              ///< below the highest
};

using Models = std::array<ValueModels, kMaxRowBits + 1>; ///< indexed by width

void write_value(std::int32_t value, int width, ValueModels& models, RangeEncoder& encoder) {
    encoder.write(value == 0, models.zero);
    if (value == 0)
        return;
    encoder.write_plain(value < 0 ? 1 : 0, 1);
    const auto magnitude = static_cast<std::uint32_t>(value < 0 ? -value : value);
    const int below = static_cast<int>(std::bit_width(magnitude)) - 1;
    for (int i = 0; i < std::min(below + 1, width - 1); ++i)
        encoder.write(i < below, models.longer[static_cast<std::size_t>(i)]);
    if (below == 0)
        return;
    encoder.write(magnitude >> (below - 1) & 1, models.second[static_cast<std::size_t>(below)]);
    encoder.write_plain(magnitude, below - 1);
}

std::int32_t read_value(int width, ValueModels& models, RangeDecoder& decoder) {
    if (decoder.read(models.zero))
        return 0;
    const bool negative = decoder.read_plain(1) != 0;
    int below = 0;
    while (below < width - 1 && decoder.read(models.longer[static_cast<std::size_t>(below)]))
        ++below;
    std::uint32_t magnitude = 1;
    if (below > 0) {
        magnitude = 2 + (decoder.read(models.second[static_cast<std::size_t>(below)]) ? 1u : 0u);
        magnitude = magnitude << (below - 1) | decoder.read_plain(below - 1);
    }
    return negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
}

} // namespace

RowCode encode_rows(std::span<const std::int32_t> values, std::size_t columns) {
    const Widths widths(values, columns);
    RowCode code{best_drops(widths, columns), {}};
    RangeEncoder encoder;
    Models models;
    for (std::size_t r = 0; r < widths.rows(); ++r) {
        const int level = level_of(widths.row(r), code.drops);
        assert(level <= kMaxRowBits);
        encoder.write_plain(static_cast<std::uint32_t>(level), kLevelBits);
        for (std::size_t i = 0; i < columns; ++i)
            if (const int width = level - code.drops[i]; width > 0)
                write_value(values[r * columns + i], width, models[static_cast<std::size_t>(width)], encoder);
    }
    if (widths.rows() > 0)
        code.bits = encoder.finish();
    return code;
}

std::vector<std::int32_t> decode_rows(const RowCode& code, std::size_t rows) {
    std::vector<std::int32_t> values;
    if (code.drops.empty()) // rows of no values take no bits
        return values;
    if (rows / 2 > code.bits.size()) // each row has at least four bits; rejects row counts that the data
                                     // cannot contain
        throw Error("the coded rows end too early");
    values.reserve(rows * code.drops.size());
    RangeDecoder decoder(code.bits);
    Models models;
    for (std::size_t r = 0; r < rows; ++r) {
        const int level = static_cast<int>(decoder.read_plain(kLevelBits));
        for (const std::uint8_t drop : code.drops) {
            const int width = level - drop;
            values.push_back(width > 0 ? read_value(width, models[static_cast<std::size_t>(width)], decoder)
                                       : 0);
        }
        if (decoder.beyond_end())
            throw Error("the coded rows end too early");
    }
    return values;
}

} // namespace prt
