// Codes packed clusters and weights: prediction from neighbours, then entropy coding (docs/format.md).
#include "runtime/core/transfer/coded_words.h"

#include "prt/core/clustered_transfer.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/transfer/packed_weights.h"
#include "runtime/core/transfer/rans.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <string>

namespace prt {
namespace {

/// Number of receivers in an independently coded block, so that threads can share the work.
constexpr std::uint32_t kWordBlock = 16384;
constexpr int kMaxSymbolBits = 6; ///< maximum for the difference of a weight; lower bits are stored plain
constexpr std::uint32_t kColumns = 16;
constexpr std::uint32_t kClusterContexts = 9;
constexpr std::uint32_t kNewCluster = 3; ///< symbol of a cluster that no neighbour uses

/// Returns the first context of weights whose differences have symbols of `bits` bits, 1..kMaxSymbolBits + 1.
/// Each has bits + 3 contexts: no neighbour in the cluster, one neighbour, and several neighbours by the bit
/// width of their range.
constexpr std::uint32_t first_context(int bits) {
    return kClusterContexts + static_cast<std::uint32_t>((bits - 1) * (bits + 6) / 2);
}

constexpr std::uint32_t kContexts = first_context(kMaxSymbolBits + 1);

/// Number of rows of frequencies of a context.
constexpr std::uint32_t row_count(std::uint32_t context) {
    return context >= first_context(6) ? 4 : context >= first_context(5) ? 2 : 1;
}

constexpr std::size_t count_rows() {
    std::size_t rows = 0;
    for (std::uint32_t c = 0; c < kContexts; ++c)
        rows += row_count(c);
    return rows;
}

constexpr std::size_t kRows = count_rows();

/// Coding of one weight.
struct WeightField {
    std::uint8_t width = 0, plain = 0; ///< total bits, and the low bits of the difference that are stored
                                       ///< plain
    std::uint16_t first_context = 0;
};

struct ClusterFields {
    std::array<WeightField, kMaxPackedComponents> weights{};
    std::size_t components = 0;
};

std::vector<ClusterFields> cluster_fields(std::span<const ClusterLayout> clusters) {
    std::vector<ClusterFields> all(clusters.size());
    for (std::size_t k = 0; k < clusters.size(); ++k) {
        all[k].components = clusters[k].components;
        for (std::size_t j = 0; j < all[k].components; ++j) {
            const int width = width_of(clusters[k], j), symbol = std::min(width, kMaxSymbolBits);
            all[k].weights[j] = {static_cast<std::uint8_t>(width), static_cast<std::uint8_t>(width - symbol),
                                 static_cast<std::uint16_t>(first_context(symbol))};
        }
    }
    return all;
}

/// Clusters and weights of receivers, unpacked.
struct Fields {
    std::vector<std::uint16_t> clusters;
    std::vector<std::array<std::uint16_t, kMaxPackedComponents>> weights;

    explicit Fields(std::size_t receivers) : clusters(receivers), weights(receivers) {}
};

/// Prediction of a receiver's cluster from earlier receivers.
struct ClusterPrediction {
    std::array<std::uint32_t, 3> receivers{}; ///< that predict
    std::uint32_t count = 0;                  ///< number of `receivers`
    std::array<std::uint16_t, 3> clusters{};  ///< distinct clusters of `receivers`
    std::uint32_t distinct = 0;
    std::uint32_t context = 0;
};

/// Predicts from receivers before `v`, which is not the first of its block. Without neighbours it uses
/// receiver v - 1.
ClusterPrediction predict_cluster(const Fields& fields, const EarlierNeighbors& neighbors, std::uint32_t v) {
    ClusterPrediction p;
    for (; p.count < 3 && neighbors[p.count] < v; ++p.count)
        p.receivers[p.count] = neighbors[p.count];
    const std::uint16_t* cluster = fields.clusters.data();
    if (p.count == 0) {
        p.receivers[p.count++] = v - 1;
        p.clusters[p.distinct++] = cluster[v - 1];
        return p;
    }
    const std::uint16_t a = cluster[p.receivers[0]];
    p.clusters[p.distinct++] = a;
    if (p.count == 1) {
        p.context = 1;
        return p;
    }
    const std::uint16_t b = cluster[p.receivers[1]];
    if (b != a)
        p.clusters[p.distinct++] = b;
    if (p.count == 2) {
        p.context = b == a ? 2 : 3;
        return p;
    }
    const std::uint16_t c = cluster[p.receivers[2]];
    if (c != a && c != b)
        p.clusters[p.distinct++] = c;
    p.context = b == a ? (c == a ? 4 : 5) : c == a ? 6 : c == b ? 7 : 8;
    return p;
}

/// Weights of those predicting receivers that are in the same cluster.
struct WeightPrediction {
    std::array<const std::uint16_t*, 3> weights{};
    std::uint32_t count = 0;
};

WeightPrediction predict_weights(const Fields& fields, const ClusterPrediction& by, std::uint16_t cluster) {
    WeightPrediction p;
    for (std::uint32_t i = 0; i < by.count; ++i)
        if (fields.clusters[by.receivers[i]] == cluster)
            p.weights[p.count++] = fields.weights[by.receivers[i]].data();
    return p;
}

struct ExpectedWeight {
    std::uint32_t value, context;
};

/// Predicts weight `j` from `kCount` receivers.
template <int kCount>
[[gnu::always_inline]] inline ExpectedWeight expect_weight(const WeightPrediction& p, std::size_t j,
                                                           const WeightField& field) {
    if constexpr (kCount == 0)
        return {1u << (field.width - 1), field.first_context};
    const std::uint32_t a = p.weights[0][j];
    if constexpr (kCount == 1)
        return {a, field.first_context + 1u};
    const std::uint32_t b = p.weights[1][j], c = p.weights[kCount == 3 ? 2 : 1][j];
    const std::uint32_t range = std::max({a, b, c}) - std::min({a, b, c});
    const auto width = static_cast<std::uint32_t>(std::bit_width(range >> field.plain));
    return {kCount == 2 ? (a + b + 1) / 2 : (a + b + c + 1) / 3, field.first_context + 2u + width};
}

template <int kCount, class Coder>
[[gnu::always_inline]] inline void code_weights(Coder& coder, const WeightPrediction& prediction,
                                                const ClusterFields& own, std::uint32_t v) {
    for (std::size_t j = 0; j < own.components; ++j)
        coder.weight(expect_weight<kCount>(prediction, j, own.weights[j]), own.weights[j], v, j);
}

/// Visits the coded steps of one receiver: `Coder` writes or reads a symbol or plain bits.
template <class Coder>
[[gnu::always_inline]] inline void code_receiver(Coder& coder, const EarlierNeighbors& neighbors,
                                                 std::uint32_t v, const Fields& fields,
                                                 std::span<const ClusterFields> clusters) {
    ClusterPrediction by;
    if (v % kWordBlock != 0)
        by = predict_cluster(fields, neighbors, v);
    const std::uint16_t cluster = coder.cluster(by, v);
    const WeightPrediction prediction = predict_weights(fields, by, cluster);
    const ClusterFields& own = clusters[cluster];
    switch (prediction.count) {
    case 0:
        return code_weights<0>(coder, prediction, own, v);
    case 1:
        return code_weights<1>(coder, prediction, own, v);
    case 2:
        return code_weights<2>(coder, prediction, own, v);
    default:
        return code_weights<3>(coder, prediction, own, v);
    }
}

/// Maps the difference to an unsigned number: 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
std::uint32_t folded(std::uint32_t value, std::uint32_t expected, int width) {
    const std::uint32_t difference = (value - expected) << (32 - width); // wraps around within the width
    return (difference << 1 ^ (0u - (difference >> 31))) >> (32 - width);
}

[[gnu::always_inline]] inline std::uint32_t unfolded(std::uint32_t code, std::uint32_t expected, int width) {
    return (expected + (code >> 1 ^ (0u - (code & 1)))) & ((1u << width) - 1);
}

/// A symbol in its context, or plain bits.
struct WordSymbol {
    std::uint32_t value;
    std::uint16_t context; ///< kContexts: plain bits
    std::uint8_t bits;     ///< number of plain bits
};

/// Converts fields to symbols.
class SymbolWriter {
public:
    SymbolWriter(const Fields& fields, int cluster_bits) : fields_(fields), cluster_bits_(cluster_bits) {}
    std::uint16_t cluster(const ClusterPrediction& by, std::uint32_t v) {
        const std::uint16_t cluster = fields_.clusters[v];
        const auto end = by.clusters.begin() + by.distinct, at = std::find(by.clusters.begin(), end, cluster);
        if (v % kWordBlock != 0)
            add_symbol(at != end ? static_cast<std::uint32_t>(at - by.clusters.begin()) : kNewCluster,
                       by.context);
        if (at == end)
            add_plain(cluster, cluster_bits_);
        return cluster;
    }
    void weight(const ExpectedWeight& expected, const WeightField& field, std::uint32_t v, std::size_t j) {
        const std::uint32_t code = folded(fields_.weights[v][j], expected.value, field.width);
        add_symbol(code >> field.plain, expected.context);
        if (field.plain > 0)
            add_plain(code & ((1u << field.plain) - 1), field.plain);
    }
    std::vector<WordSymbol> symbols;

private:
    void add_symbol(std::uint32_t symbol, std::uint32_t context) {
        symbols.push_back({symbol, static_cast<std::uint16_t>(context), 0});
    }
    void add_plain(std::uint32_t value, int bits) {
        symbols.push_back({value, static_cast<std::uint16_t>(kContexts), static_cast<std::uint8_t>(bits)});
    }

    const Fields& fields_;
    int cluster_bits_;
};

/// Concatenates bit fields into 32-bit words, lowest bit first.
class WordPacker {
public:
    explicit WordPacker(std::uint32_t* to) : to_(to) {}
    [[gnu::always_inline]] void add(std::uint32_t value, int width) {
        bits_ |= std::uint64_t{value} << used_;
        used_ += width;
        if (used_ < 32)
            return;
        *to_++ = static_cast<std::uint32_t>(bits_);
        bits_ >>= 32;
        used_ -= 32;
    }
    void finish() {
        if (used_ > 0)
            *to_ = static_cast<std::uint32_t>(bits_);
    }

private:
    std::uint32_t* to_;
    std::uint64_t bits_ = 0;
    int used_ = 0;
};

/// Decodes symbols to fields, and packs the fields into words.
class SymbolReader {
public:
    SymbolReader(Fields& fields, const WordLayout& layout, std::span<const std::byte> bytes,
                 std::span<const RansSlot> slots)
        : fields_(fields), clusters_(layout.clusters.size()), cluster_bits_(layout.cluster_bits),
          decoder_(bytes), slots_(slots.data()) {}
    void begin(std::uint32_t* words) { packer_ = WordPacker(words); }
    void finish() { packer_.finish(); }
    [[gnu::always_inline]] std::uint16_t cluster(const ClusterPrediction& by, std::uint32_t v) {
        const std::uint32_t symbol = v % kWordBlock != 0 ? read(by.context) : kNewCluster;
        std::uint32_t cluster = 0;
        if (symbol < by.distinct)
            cluster = by.clusters[symbol];
        else if (symbol == kNewCluster)
            cluster = decoder_.read_plain(cluster_bits_);
        else
            throw Error("the coded words are damaged: receiver " + std::to_string(v) +
                        " takes the cluster of a neighbor that does not exist");
        if (cluster >= clusters_)
            throw Error("the coded words are damaged: receiver " + std::to_string(v) + " has cluster " +
                        std::to_string(cluster) + ", but there are only " + std::to_string(clusters_));
        packer_.add(cluster, cluster_bits_);
        return fields_.clusters[v] = static_cast<std::uint16_t>(cluster);
    }
    [[gnu::always_inline]] void weight(const ExpectedWeight& expected, const WeightField& field,
                                       std::uint32_t v, std::size_t j) {
        std::uint32_t code = read(expected.context);
        if (field.plain > 0)
            code = code << field.plain | decoder_.read_plain(field.plain);
        const std::uint32_t value = unfolded(code, expected.value, field.width);
        packer_.add(value, field.width);
        fields_.weights[v][j] = static_cast<std::uint16_t>(value);
    }
    bool is_beyond_end() const { return decoder_.is_beyond_end(); }
    bool ends_well() const { return decoder_.ends_well(); }

private:
    [[gnu::always_inline]] std::uint32_t read(std::uint32_t context) {
        return decoder_.read(slots_ + std::size_t{context} * kFrequencyTotal);
    }

    Fields& fields_;
    std::size_t clusters_;
    int cluster_bits_;
    RansDecoder decoder_;
    const RansSlot* slots_;
    WordPacker packer_{nullptr};
};

/// Scales counts to frequencies of sum kFrequencyTotal, at least 1 for each counted symbol; all 0 if nothing
/// is counted.
void normalize(std::span<std::int32_t> counts) {
    const std::int64_t sum = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
    if (sum == 0)
        return;
    constexpr auto kTotal = std::int64_t{kFrequencyTotal};
    std::int64_t left = kTotal;
    for (std::int32_t& count : counts)
        if (count > 0) {
            count = static_cast<std::int32_t>(std::max<std::int64_t>(1, (count * kTotal + sum / 2) / sum));
            left -= count;
        }
    for (; left != 0; left += left > 0 ? -1 : 1) // rounding error: at most half a step per symbol, plus the
                                                 // symbols raised to 1
        *std::ranges::max_element(counts) += left > 0 ? 1 : -1;
}

/// Returns the frequencies [kRows][kColumns] of all contexts.
std::vector<std::int32_t> count_symbols(std::span<const WordSymbol> symbols) {
    std::array<std::size_t, kContexts + 1> begin{};
    for (std::uint32_t c = 0; c < kContexts; ++c)
        begin[c + 1] = begin[c] + std::size_t{row_count(c)} * kColumns;
    std::vector<std::int32_t> counts(kRows * kColumns);
    for (const WordSymbol& symbol : symbols)
        if (symbol.context < kContexts)
            ++counts[begin[symbol.context] + symbol.value];
    for (std::uint32_t c = 0; c < kContexts; ++c)
        normalize(std::span(counts).subspan(begin[c], begin[c + 1] - begin[c]));
    return counts;
}

/// Returns the slots [kContexts][kFrequencyTotal] of these frequencies.
std::vector<RansSlot> slots_of(std::span<const std::int32_t> frequencies) {
    std::vector<RansSlot> slots(std::size_t{kContexts} * kFrequencyTotal);
    for (std::uint32_t c = 0; c < kContexts; ++c) {
        const auto own = frequencies.first(std::size_t{row_count(c)} * kColumns);
        frequencies = frequencies.subspan(own.size());
        std::size_t slot = std::size_t{c} * kFrequencyTotal, end = slot + kFrequencyTotal;
        for (std::uint32_t symbol = 0; symbol < own.size(); ++symbol) {
            const std::int32_t frequency = own[symbol];
            if (frequency < 0 || static_cast<std::size_t>(frequency) > end - slot)
                throw Error("the coded words are damaged: the sum of the frequencies is not " +
                            std::to_string(kFrequencyTotal));
            for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(frequency); ++i)
                slots[slot++] = RansSlot(symbol, static_cast<std::uint32_t>(frequency), i);
        }
        if (slot + kFrequencyTotal == end) { // context not used
            for (std::uint32_t i = 0; i < kFrequencyTotal; ++i)
                slots[slot++] = RansSlot(0, kFrequencyTotal, i);
        }
        if (slot != end)
            throw Error("the coded words are damaged: the sum of the frequencies is not " +
                        std::to_string(kFrequencyTotal));
    }
    return slots;
}

std::vector<RansStep> steps_of(std::span<const WordSymbol> symbols, std::span<const RansSlot> slots) {
    std::array<std::array<RansStep, 64>, kContexts> models{};
    for (std::uint32_t c = 0; c < kContexts; ++c)
        for (std::uint32_t s = 0; s < kFrequencyTotal; ++s) {
            const RansSlot& slot = slots[std::size_t{c} * kFrequencyTotal + s];
            models[c][slot.symbol()] = {slot.frequency(), s - slot.offset(), kFrequencyBits};
        }
    std::vector<RansStep> steps;
    for (const auto& [value, context, bits] : symbols)
        steps.push_back(context < kContexts ? models[context][value] : RansStep{1, value, bits});
    return steps;
}

/// Returns the bytes of each block.
std::vector<std::span<const std::byte>> split_blocks(std::span<const std::byte> bytes,
                                                     std::size_t receivers) {
    const std::size_t count = (receivers + kWordBlock - 1) / kWordBlock;
    std::vector<std::span<const std::byte>> blocks;
    std::span<const std::byte> rest = bytes.subspan(std::min(4 * count, bytes.size()));
    for (std::size_t b = 0; b < count; ++b) {
        const std::size_t length = 4 * count <= bytes.size() ? load<std::uint32_t>(&bytes[4 * b]) : ~0u;
        if (length > rest.size())
            throw Error("the coded words end too early");
        blocks.push_back(rest.first(length));
        rest = rest.subspan(length);
    }
    if (!rest.empty())
        throw Error("the coded words are damaged: there are bytes after the last block");
    return blocks;
}

Fields unpacked(const WordLayout& layout, std::span<const std::uint32_t> words) {
    const auto stride = static_cast<std::size_t>(layout.words);
    Fields fields(words.size() / stride);
    const auto* bytes = reinterpret_cast<const std::byte*>(words.data());
    for (std::size_t v = 0; v < fields.clusters.size(); ++v) {
        const std::byte* own = bytes + v * stride * 4;
        const std::uint32_t cluster = load<std::uint32_t>(own) & ((1u << layout.cluster_bits) - 1);
        if (cluster >= layout.clusters.size())
            throw Error("receiver " + std::to_string(v) + " has a cluster that does not exist");
        fields.clusters[v] = static_cast<std::uint16_t>(cluster);
        auto position = static_cast<std::size_t>(layout.cluster_bits);
        for (std::size_t j = 0; j < layout.clusters[cluster].components; ++j) {
            const int width = width_of(layout.clusters[cluster], j);
            fields.weights[v][j] = static_cast<std::uint16_t>(bits_at(own, position, width));
            position += static_cast<std::size_t>(width);
        }
    }
    return fields;
}

std::vector<std::uint32_t> packed(const WordLayout& layout, const Fields& fields) {
    const auto stride = static_cast<std::size_t>(layout.words);
    std::vector<std::uint32_t> words(fields.clusters.size() * stride);
    std::array<std::uint32_t, kMaxPackedComponents> values{};
    for (std::size_t v = 0; v < fields.clusters.size(); ++v) {
        std::ranges::copy(fields.weights[v], values.begin());
        pack_words(fields.clusters[v], layout.cluster_bits, layout.clusters[fields.clusters[v]], values,
                   std::span(words).subspan(v * stride, stride));
    }
    return words;
}

} // namespace

std::vector<EarlierNeighbors> earlier_neighbors(std::span<const std::uint32_t> triangles,
                                                std::size_t receivers) {
    std::vector<EarlierNeighbors> neighbors(receivers);
    for (std::uint32_t v = 0; v < receivers; ++v)
        neighbors[v].fill(v);
    const auto add = [&](std::uint32_t v, std::uint32_t before) {
        if (v / kWordBlock != before / kWordBlock)
            return;
        for (std::uint32_t& entry : neighbors[v]) {
            if (entry == v)
                entry = before;
            if (entry == before)
                return;
        }
    };
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        // Uses only the sorted indices, because EXT_meshopt_compression rotates the vertices of triangles.
        const auto [low, high] = std::minmax({triangles[t], triangles[t + 1], triangles[t + 2]});
        const std::uint32_t middle = triangles[t] ^ triangles[t + 1] ^ triangles[t + 2] ^ low ^ high;
        if (high >= receivers)
            throw Error("a triangle refers to vertex " + std::to_string(high) + ", but there are only " +
                        std::to_string(receivers));
        add(middle, low);
        add(high, low);
        add(high, middle);
    }
    return neighbors;
}

bool can_code_words(const WordLayout& layout, std::span<const std::uint32_t> words) {
    const auto stride = static_cast<std::size_t>(layout.words);
    for (std::size_t v = 0; v < words.size(); v += stride)
        if ((words[v] & ((1u << layout.cluster_bits) - 1)) >= layout.clusters.size())
            return false;
    return std::ranges::equal(packed(layout, unpacked(layout, words)), words);
}

WordCode encode_words(const WordLayout& layout, std::span<const EarlierNeighbors> neighbors,
                      std::span<const std::uint32_t> words) {
    const Fields fields = unpacked(layout, words);
    const std::vector<ClusterFields> clusters = cluster_fields(layout.clusters);
    SymbolWriter writer(fields, layout.cluster_bits);
    std::vector<std::size_t> ends; // end of the symbols of each block
    for (std::uint32_t v = 0; v < neighbors.size(); ++v) {
        code_receiver(writer, neighbors[v], v, fields, clusters);
        if ((v + 1) % kWordBlock == 0 || v + 1 == neighbors.size())
            ends.push_back(writer.symbols.size());
    }
    const std::vector<std::int32_t> frequencies = count_symbols(writer.symbols);
    const std::vector<RansStep> steps = steps_of(writer.symbols, slots_of(frequencies));
    WordCode code{encode_rows(frequencies, kColumns), std::vector<std::byte>(4 * ends.size())};
    for (std::size_t b = 0; b < ends.size(); ++b) {
        const std::size_t begin = b > 0 ? ends[b - 1] : 0;
        const std::vector<std::byte> block = encode_rans(std::span(steps).subspan(begin, ends[b] - begin));
        const auto length = static_cast<std::uint32_t>(block.size());
        std::memcpy(&code.bits[4 * b], &length, sizeof length); // little-endian, as glTF is
        code.bits.insert(code.bits.end(), block.begin(), block.end());
    }
    return code;
}

std::vector<std::uint32_t> decode_words(const WordCode& code, const WordLayout& layout,
                                        std::span<const EarlierNeighbors> neighbors, int threads) {
    if (code.frequencies.drops.size() != kColumns)
        throw Error("the frequencies of the coded words have " +
                    std::to_string(code.frequencies.drops.size()) + " columns, but must have " +
                    std::to_string(kColumns));
    const std::vector<RansSlot> slots = slots_of(decode_rows(code.frequencies, kRows));
    const std::vector<std::span<const std::byte>> blocks = split_blocks(code.bits, neighbors.size());
    const std::vector<ClusterFields> clusters = cluster_fields(layout.clusters);
    const auto stride = static_cast<std::size_t>(layout.words);
    Fields fields(neighbors.size());
    std::vector<std::uint32_t> words(neighbors.size() * stride);
    parallel_for(neighbors.size(), kWordBlock, threads, [&](std::size_t begin, std::size_t end) {
        SymbolReader reader(fields, layout, blocks[begin / kWordBlock], slots);
        for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
            reader.begin(words.data() + v * stride);
            code_receiver(reader, neighbors[v], v, fields, clusters);
            reader.finish();
            if (reader.is_beyond_end())
                throw Error("the coded words end too early");
        }
        if (!reader.ends_well())
            throw Error("the coded words are damaged");
    });
    return words;
}

} // namespace prt
