#include "prt/texture.h"

#include "prt/error.h"
#include "prt/tone_map.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace prt {
namespace {

const std::array<float, 256>& srgb_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = srgb_decode(static_cast<float>(i) / 255.0f);
        return values;
    }();
    return table;
}

glm::vec4 decoded(const glm::u8vec4& texel) {
    const auto& table = srgb_table();
    return {table[texel.r], table[texel.g], table[texel.b], static_cast<float>(texel.a) / 255.0f};
}

glm::u8vec4 encoded(const glm::vec4& colour) {
    glm::u8vec4 texel;
    for (int c = 0; c < 3; ++c)
        texel[c] = static_cast<std::uint8_t>(std::lround(255 * srgb_encode(colour[c])));
    texel.a = static_cast<std::uint8_t>(std::lround(255 * colour.a));
    return texel;
}

const glm::u8vec4& texel(const Image8& image, int x, int y) {
    return image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x)];
}

Image8 half_size(const Image8& image) {
    Image8 half{std::max(1, image.width / 2), std::max(1, image.height / 2), {}};
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const int x1 = std::min(2 * x + 1, image.width - 1), y1 = std::min(2 * y + 1, image.height - 1);
            half.pixels.push_back(
                encoded(0.25f * (decoded(texel(image, 2 * x, 2 * y)) + decoded(texel(image, x1, 2 * y)) +
                                 decoded(texel(image, 2 * x, y1)) + decoded(texel(image, x1, y1)))));
        }
    return half;
}

int wrapped(int i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp)
        return std::clamp(i, 0, size - 1);
    if (wrap == Wrap::repeat)
        return (i % size + size) % size;
    const int period = (i % (2 * size) + 2 * size) % (2 * size);
    return period < size ? period : 2 * size - 1 - period;
}

glm::vec4 bilinear(const Image8& image, const TextureUse& use, const glm::vec2& uv) {
    const float x = uv.x * static_cast<float>(image.width) - 0.5f,
                y = uv.y * static_cast<float>(image.height) - 0.5f;
    if (!(std::abs(x) < 1e9f) || !(std::abs(y) < 1e9f)) // texture coordinates that are not finite
        return glm::vec4(0, 0, 0, 1);
    const float fx = std::floor(x), fy = std::floor(y);
    const int x0 = wrapped(static_cast<int>(fx), image.width, use.wrap_u),
              x1 = wrapped(static_cast<int>(fx) + 1, image.width, use.wrap_u),
              y0 = wrapped(static_cast<int>(fy), image.height, use.wrap_v),
              y1 = wrapped(static_cast<int>(fy) + 1, image.height, use.wrap_v);
    return glm::mix(glm::mix(decoded(texel(image, x0, y0)), decoded(texel(image, x1, y0)), x - fx),
                    glm::mix(decoded(texel(image, x0, y1)), decoded(texel(image, x1, y1)), x - fx), y - fy);
}

} // namespace

Texture make_texture(Image8 image) {
    Texture texture;
    texture.levels.push_back(std::move(image));
    while (texture.levels.back().width > 1 || texture.levels.back().height > 1)
        texture.levels.push_back(half_size(texture.levels.back()));
    return texture;
}

glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod) {
    const auto last = static_cast<float>(texture.levels.size() - 1);
    const float level = std::clamp(lod, 0.0f, last);
    const auto fine = static_cast<std::size_t>(level);
    const std::size_t coarse = std::min(fine + 1, texture.levels.size() - 1);
    return glm::mix(bilinear(texture.levels[fine], use, uv), bilinear(texture.levels[coarse], use, uv),
                    level - static_cast<float>(fine));
}

std::vector<Texture> load_textures(const Scene& scene, BadTextures bad) {
    std::set<int> images;
    for (const Primitive& primitive : scene.primitives) {
        const Material& material = scene.materials[primitive.material];
        for (const TextureUse* use : {&material.base_color_texture, &material.transmission.factor_texture,
                                      &material.transmission.color_texture})
            images.insert(use->image);
    }
    images.erase(-1);
    const std::size_t used = images.empty() ? 0 : static_cast<std::size_t>(*images.rbegin()) + 1;
    std::vector<Texture> textures(std::max(scene.images.size(), used));
    for (const int image : images) {
        EncodedImage nothing{"image " + std::to_string(image), {}};
        const bool there = static_cast<std::size_t>(image) < scene.images.size();
        const EncodedImage& encoded_image = there ? scene.images[static_cast<std::size_t>(image)] : nothing;
        try {
            if (encoded_image.bytes.empty())
                throw Error("is not there");
            textures[static_cast<std::size_t>(image)] = make_texture(decode_image(encoded_image.bytes));
        } catch (const Error& error) {
            if (bad == BadTextures::error)
                throw Error(encoded_image.name + " " + error.what());
        }
    }
    return textures;
}

} // namespace prt
