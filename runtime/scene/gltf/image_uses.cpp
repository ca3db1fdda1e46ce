// Finds images without effect on light transfer.
#include "gltf/image_uses.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace prt {
namespace {

/// Prefixes of material textures that this program does not read.
constexpr std::array<std::string_view, 7> kUnread = {"normalTexture",  "occlusionTexture", "clearcoat",
                                                     "sheen",          "iridescence",      "anisotropy",
                                                     "specularTexture"};

/// Adds the images of a texture, including those of its extensions.
void add_images(const Json& texture, std::set<std::size_t>& images) {
    const auto add = [&](const Json& owner) {
        if (owner.is_object() && owner.contains("source") && owner["source"].is_number_unsigned())
            images.insert(owner["source"].get<std::size_t>());
    };
    add(texture);
    if (texture.contains("extensions"))
        for (const Json& extension : texture["extensions"])
            add(extension);
}

/// Adds the textures of a material's `json` to `read` or `unread`.
void sort_textures(const Json& json, std::set<std::size_t>& read, std::set<std::size_t>& unread) {
    if (!json.is_object())
        return;
    for (const auto& [key, value] : json.items()) {
        const std::string_view name = key;
        const bool texture = name.ends_with("Texture") && value.is_object() && value.contains("index") &&
                             value["index"].is_number_unsigned();
        if (!texture)
            sort_textures(value, read, unread);
        else if (std::any_of(kUnread.begin(), kUnread.end(),
                             [&](auto begin) { return name.starts_with(begin); }))
            unread.insert(value["index"].get<std::size_t>());
        else
            read.insert(value["index"].get<std::size_t>());
    }
}

} // namespace

std::set<std::size_t> images_without_light(const Json& json) {
    std::set<std::size_t> read, unread, needed, images;
    if (json.contains("materials"))
        for (const Json& material : json["materials"])
            sort_textures(material, read, unread);
    const Json textures = json.value("textures", Json::array());
    for (std::size_t t = 0; t < textures.size(); ++t)
        add_images(textures[t], unread.contains(t) && !read.contains(t) ? images : needed);
    for (const std::size_t image : needed)
        images.erase(image);
    return images;
}

} // namespace prt
