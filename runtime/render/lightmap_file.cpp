// Stores words of texels as PNG images.

#include "prt/render/lightmap_file.h"

#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "runtime/image/image_size.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace prt {
namespace {

std::vector<std::byte> word_png(const LightmapSize& size, std::span<const std::uint32_t> words) {
    std::vector<glm::u8vec4> pixels;
    pixels.reserve(words.size());
    for (const std::uint32_t word : words)
        pixels.emplace_back(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24);
    return encode_png(size.width, size.height, pixels);
}

/// Throws `Error` unless the image has the format and size of the words of a map; called before decoding.
void check_word_image(std::span<const std::byte> png, const LightmapSize& size) {
    if (!is_png_of_bytes(png))
        throw Error("is not a PNG with 8 bits per channel and channels red, green, blue and alpha");
    const ImageSize found = image_size(png);
    if (found.width != size.width || found.height != size.height)
        throw Error("has " + std::to_string(found.width) + " x " + std::to_string(found.height) +
                    " pixels, but the lightmap has " + std::to_string(size.width) + " x " +
                    std::to_string(size.height) + " texels");
}

/// Reads word `word` of all texels of a map, whose first texel is `first`.
void read_word(std::span<const std::byte> png, const LightmapSize& size, std::size_t first, int word,
               ClusteredReceivers& receivers) {
    check_word_image(png, size);
    const Image8 image = decode_image(png);
    for (std::size_t t = 0; t < image.pixels.size(); ++t) {
        const glm::u8vec4& p = image.pixels[t];
        const std::uint32_t value =
            p.r | std::uint32_t{p.g} << 8 | std::uint32_t{p.b} << 16 | std::uint32_t{p.a} << 24;
        std::memcpy(&receivers.weights[(first + t) * receivers.stride() + 4 * static_cast<std::size_t>(word)],
                    &value, sizeof value);
    }
}

} // namespace

std::vector<std::uint32_t> words_of_map(const CompressedLightmap& lightmap, std::size_t map, int word) {
    const ClusteredReceivers& receivers = lightmap.compressed.transfer.receivers;
    const std::size_t first = lightmap.layout.first_texels()[map];
    std::vector<std::uint32_t> words(lightmap.layout.maps[map].texels());
    for (std::size_t t = 0; t < words.size(); ++t)
        std::memcpy(&words[t],
                    &receivers.weights[(first + t) * receivers.stride() + 4 * static_cast<std::size_t>(word)],
                    sizeof words[t]);
    return words;
}

EncodedLightmap encoded_lightmap(const CompressedLightmap& lightmap) {
    const ClusteredReceivers& receivers = lightmap.compressed.transfer.receivers;
    if (receivers.format != WeightFormat::packed)
        throw Error("the weights of texels must be packed; compress with --bits N");
    EncodedLightmap encoded{{lightmap.layout, {lightmap.compressed.transfer, lightmap.compressed.record}},
                            {}};
    for (std::size_t m = 0; m < lightmap.layout.maps.size(); ++m)
        for (int w = 0; w < receivers.words; ++w)
            encoded.images.push_back(word_png(lightmap.layout.maps[m], words_of_map(lightmap, m, w)));
    return encoded;
}

CompressedLightmap decoded_lightmap(EncodedLightmap encoded) {
    CompressedLightmap& lightmap = encoded.lightmap;
    ClusteredReceivers& receivers = lightmap.compressed.transfer.receivers;
    const std::vector<std::size_t> first = lightmap.layout.first_texels();
    receivers.weights.resize(first.back() * receivers.stride());
    std::size_t image = 0;
    for (std::size_t m = 0; m < lightmap.layout.maps.size(); ++m)
        for (int w = 0; w < receivers.words; ++w)
            try {
                read_word(encoded.images[image++], lightmap.layout.maps[m], first[m], w, receivers);
            } catch (const Error& error) {
                throw Error("the image of word " + std::to_string(w) + " of map " + std::to_string(m) + " " +
                            error.what());
            }
    check_clusters(lightmap.compressed.transfer.bases.clusters(), 0, receivers.size(), "texel", receivers);
    return std::move(lightmap);
}

namespace {

/// Copies receiver `from` of `source` to receiver `to` of `target`.
void copy_receiver(const ClusteredReceivers& source, std::size_t from, ClusteredReceivers& target,
                   std::size_t to) {
    std::memcpy(&target.weights[to * target.stride()], &source.weights[from * source.stride()],
                source.stride());
}

ClusteredReceivers room_for(std::size_t count, const ClusteredReceivers& like) {
    ClusteredReceivers receivers{.format = like.format,
                                 .components = like.components,
                                 .cluster_bits = like.cluster_bits,
                                 .words = like.words,
                                 .clusters = {},
                                 .weights = std::vector<std::byte>(count * like.stride()),
                                 .predictors = {}};
    return receivers;
}

/// Calls `visit` with every texel and the index in `texels` of its receiver, or of a near receiver. Maps
/// without receivers are skipped.
template <class Visit>
void for_each_texel(const LightmapLayout& layout, std::span<const std::uint32_t> texels, Visit&& visit) {
    const std::vector<std::size_t> first = layout.first_texels();
    auto begin = texels.begin();
    for (std::size_t m = 0; m < layout.maps.size(); ++m) {
        const auto end = std::lower_bound(begin, texels.end(), first[m + 1]);
        std::vector<std::uint32_t> of_map(begin, end);
        for (std::uint32_t& texel : of_map)
            texel -= static_cast<std::uint32_t>(first[m]);
        const std::vector<std::uint32_t> nearest = nearest_receivers(layout.maps[m], of_map);
        const auto offset = static_cast<std::size_t>(begin - texels.begin());
        for (std::size_t t = 0; t < nearest.size() && !of_map.empty(); ++t)
            visit(first[m] + t, offset + nearest[t]);
        begin = end;
    }
}

} // namespace

CompressedLightmap scatter_to_maps(const BakedLightmap& baked, ClusteredTransfer compressed) {
    CompressedLightmap lightmap{baked.layout, {{std::move(compressed.bases), {}}, baked.baked.record}};
    ClusteredReceivers& all = lightmap.compressed.transfer.receivers =
        room_for(baked.layout.texels(), compressed.receivers);
    for_each_texel(baked.layout, baked.texels, [&](std::size_t texel, std::size_t receiver) {
        copy_receiver(compressed.receivers, receiver, all, texel);
    });
    return lightmap;
}

std::vector<glm::vec3> scatter_to_maps(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                       std::span<const glm::vec3> values) {
    std::vector<glm::vec3> all(layout.texels());
    for_each_texel(layout, texels,
                   [&](std::size_t texel, std::size_t receiver) { all[texel] = values[receiver]; });
    return all;
}

ClusteredTransfer gather_texels(const ClusteredTransfer& all, std::span<const std::uint32_t> texels) {
    ClusteredTransfer picked{all.bases, room_for(texels.size(), all.receivers)};
    for (std::size_t i = 0; i < texels.size(); ++i)
        copy_receiver(all.receivers, texels[i], picked.receivers, i);
    return picked;
}

} // namespace prt
