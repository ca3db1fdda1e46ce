// Decodes coded words: the first bytes select clusters and vertices (word_input.h), the rest is the code.
// Decoded words are coded and decoded again. The bytes are also used as words, which must survive coding and
// decoding.
#include "target.h"
#include "word_input.h"

#include <cstring>

namespace prt::fuzz {
namespace {

constexpr std::size_t kColumns = 16; ///< columns of frequencies; their drops precede them

void expect_round_trip(const WordInput& input, const std::vector<std::uint32_t>& words) {
    const WordCode code = encode_words(input.layout, input.neighbors, words);
    expect(decode_words(code, input.layout, input.neighbors) == words, "words are decoded to others");
}

void decode(const WordInput& input, std::size_t split, std::span<const std::byte> data) {
    WordCode code;
    for (std::size_t i = 0; i < std::min(kColumns, data.size()); ++i)
        code.frequencies.drops.push_back(std::to_integer<std::uint8_t>(data[i]) & 15);
    data = data.subspan(code.frequencies.drops.size());
    split = std::min(split, data.size());
    code.frequencies.bits.assign(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(split));
    code.bits.assign(data.begin() + static_cast<std::ptrdiff_t>(split), data.end());
    const std::vector<std::uint32_t> words = decode_words(code, input.layout, input.neighbors);
    expect(can_code_words(input.layout, words), "decoded words are no words");
    expect_round_trip(input, words);
}

} // namespace
} // namespace prt::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt::fuzz;
    if (size < kWordHead)
        return 0;
    const WordInput input = word_input({data, kWordHead});
    const std::span<const std::byte> rest = bytes(data, size).subspan(kWordHead);
    std::vector<std::uint32_t> words(input.neighbors.size() * static_cast<std::size_t>(input.layout.words));
    std::memcpy(words.data(), rest.data(), std::min(rest.size(), 4 * words.size()));
    if (prt::can_code_words(input.layout, words))
        expect_round_trip(input, words);
    return take([&] { decode(input, 4 * std::size_t{data[kWordHead - 1]}, rest); });
}
