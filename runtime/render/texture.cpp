// Computes mip chains by a box filter, filters trilinearly, and loads the images that a scene needs.
#include "prt/render/texture.h"

#include "prt/core/error.h"
#include "prt/render/tone_map.h"
#include "runtime/image/image_size.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

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

glm::vec4 decoded(const glm::u8vec4& texel, TextureEncoding encoding) {
    if (encoding == TextureEncoding::linear)
        return glm::vec4(texel) / 255.0f;
    const auto& table = srgb_table();
    return {table[texel.r], table[texel.g], table[texel.b], static_cast<float>(texel.a) / 255.0f};
}

glm::u8vec4 encoded(const glm::vec4& color, TextureEncoding encoding) {
    glm::u8vec4 texel;
    for (int c = 0; c < 3; ++c) {
        const float value = encoding == TextureEncoding::srgb ? srgb_encode(color[c]) : color[c];
        texel[c] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
    texel.a = static_cast<std::uint8_t>(std::lround(255 * color.a));
    return texel;
}

const glm::u8vec4& texel(const Image8& image, int x, int y) {
    return image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x)];
}

Image8 half_size(const Image8& image, TextureEncoding encoding) {
    const auto value = [&](int x, int y) { return decoded(texel(image, x, y), encoding); };
    Image8 half{std::max(1, image.width / 2), std::max(1, image.height / 2), {}};
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const int x1 = std::min(2 * x + 1, image.width - 1), y1 = std::min(2 * y + 1, image.height - 1);
            half.pixels.push_back(
                encoded(0.25f * (value(2 * x, 2 * y) + value(x1, 2 * y) + value(2 * x, y1) + value(x1, y1)),
                        encoding));
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

glm::vec4 bilinear(const Texture& texture, std::size_t level, const TextureUse& use, const glm::vec2& uv) {
    const Image8& image = texture.levels[level];
    const float x = uv.x * static_cast<float>(image.width) - 0.5f,
                y = uv.y * static_cast<float>(image.height) - 0.5f;
    if (!(std::abs(x) < 1e9f) || !(std::abs(y) < 1e9f)) // texture coordinates that are not finite
        return glm::vec4(0, 0, 0, 1);
    const float fx = std::floor(x), fy = std::floor(y);
    const int x0 = wrapped(static_cast<int>(fx), image.width, use.wrap_u),
              x1 = wrapped(static_cast<int>(fx) + 1, image.width, use.wrap_u),
              y0 = wrapped(static_cast<int>(fy), image.height, use.wrap_v),
              y1 = wrapped(static_cast<int>(fy) + 1, image.height, use.wrap_v);
    const auto value = [&](int column, int row) {
        return decoded(texel(image, column, row), texture.encoding);
    };
    return glm::mix(glm::mix(value(x0, y0), value(x1, y0), x - fx),
                    glm::mix(value(x0, y1), value(x1, y1), x - fx), y - fy);
}

/// Throws `Error` for formats of glTF extensions that decode_image does not support, by their first bytes.
void check_format(std::span<const std::byte> file) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const char* format = text.starts_with("\xABKTX 20") ? "KTX 2"
                         : text.starts_with("DDS ")     ? "DDS"
                                                        : nullptr;
    if (format)
        throw Error("is " + std::string(format) +
                    ", which is not supported, and the texture has no PNG, JPEG, WebP or AVIF as a fallback");
}

} // namespace

Texture make_texture(Image8 image, TextureEncoding encoding) {
    Texture texture{{}, encoding};
    texture.levels.push_back(std::move(image));
    while (texture.levels.back().width > 1 || texture.levels.back().height > 1)
        texture.levels.push_back(half_size(texture.levels.back(), encoding));
    return texture;
}

glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod) {
    const auto last = static_cast<float>(texture.levels.size() - 1);
    const float level = std::clamp(lod, 0.0f, last);
    const auto fine = static_cast<std::size_t>(level);
    const std::size_t coarse = std::min(fine + 1, texture.levels.size() - 1);
    return glm::mix(bilinear(texture, fine, use, uv), bilinear(texture, coarse, use, uv),
                    level - static_cast<float>(fine));
}

bool is_missing(const TextureUse& use, std::span<const Texture> textures) {
    return use.image >= 0 && !textures.empty() &&
           textures[static_cast<std::size_t>(use.image)].levels.empty();
}

std::map<int, TextureEncoding> needed_images(const Scene& scene, TextureNeeds needs) {
    std::map<int, TextureEncoding> images;
    const auto add = [&](const TextureUse& use, TextureEncoding encoding) {
        if (use.image >= 0 && (images.try_emplace(use.image, encoding), encoding == TextureEncoding::srgb))
            images[use.image] = encoding;
    };
    for (const Primitive& primitive : scene.primitives) {
        const Material& m = scene.materials[primitive.material];
        const bool leaf = m.transmission.factor > 0 && needs != TextureNeeds::pictures;
        const bool colors = needs == TextureNeeds::pictures || needs == TextureNeeds::all;
        if (colors || m.alpha_mode != AlphaMode::opaque || leaf)
            add(m.base_color_texture, TextureEncoding::srgb);
        if (needs != TextureNeeds::shadows)
            add(m.emission.texture, TextureEncoding::srgb);
        if (leaf) {
            add(m.transmission.factor_texture, TextureEncoding::srgb); // linear data, but in the alpha
                                                                       // channel
            add(m.transmission.color_texture, TextureEncoding::srgb);
        }
        if (m.glass.factor > 0 && needs != TextureNeeds::pictures)
            add(m.glass.texture, TextureEncoding::linear);
        if (m.metal.factor > 0 && needs == TextureNeeds::all)
            add(m.metal.texture, TextureEncoding::linear);
    }
    return images;
}

namespace {

/// Throws `Error` if the sizes in the headers of `images` exceed the memory limit for all images of the scene
/// together: the limit of one image in a file with the size of all files.
void check_memory(const Scene& scene, const std::map<int, TextureEncoding>& images) {
    constexpr std::uint64_t kFree = std::uint64_t{192} << 20, kPerByte = 64, kBytesPerTexel = 6;
    std::uint64_t bytes = 0, texels = 0;
    for (const auto& [image, encoding] : images)
        if (static_cast<std::size_t>(image) < scene.images.size())
            try {
                const std::span<const std::byte> file = scene.images[static_cast<std::size_t>(image)].bytes;
                const ImageSize size = image_size(file);
                bytes += file.size();
                texels += static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
            } catch (const Error&) { // reported, or ignored, when the image is decoded
            }
    if (texels * kBytesPerTexel > kFree + kPerByte * bytes)
        throw Error(
            "its images claim " + std::to_string(texels) + " pixels in files of " + std::to_string(bytes) +
            " bytes; the limit for the memory of all images is 192 MB plus 64 times their file sizes");
}

} // namespace

std::vector<Texture> load_textures(const Scene& scene, BadTextures bad, TextureNeeds needs) {
    const std::map<int, TextureEncoding> images = needed_images(scene, needs);
    const std::size_t used = images.empty() ? 0 : static_cast<std::size_t>(images.rbegin()->first) + 1;
    std::vector<Texture> textures(std::max(scene.images.size(), used));
    check_memory(scene, images);
    for (const auto& [image, encoding] : images) {
        EncodedImage nothing{"image " + std::to_string(image), {}};
        const bool there = static_cast<std::size_t>(image) < scene.images.size();
        const EncodedImage& encoded_image = there ? scene.images[static_cast<std::size_t>(image)] : nothing;
        try {
            if (encoded_image.bytes.empty())
                throw Error(encoded_image.trouble.empty() ? "does not exist" : encoded_image.trouble);
            check_format(encoded_image.bytes);
            textures[static_cast<std::size_t>(image)] =
                make_texture(decode_image(encoded_image.bytes), encoding);
        } catch (const Error& error) {
            if (bad == BadTextures::error)
                throw Error(encoded_image.name + " " + error.what() +
                            "; ignore such textures with --bad-textures ignore");
        }
    }
    return textures;
}

} // namespace prt
