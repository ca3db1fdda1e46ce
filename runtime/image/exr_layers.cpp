// Finds color channels by name ("OpenEXR: Technical Introduction", sections on layers and channel names).
#include "runtime/image/exr_layers.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <OpenEXR/ImfChannelList.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace prt {
namespace {

/// Returns "R", "G", "B" or "Y" for a channel of that color, in upper or lower case; 0 for others.
char color_of(std::string_view name) {
    const char last = name.empty() ? '\0' : name.back();
    const auto upper = static_cast<char>(std::toupper(static_cast<unsigned char>(last)));
    const bool alone = name.size() == 1 || (name.size() > 1 && name[name.size() - 2] == '.');
    return alone && std::string_view("RGBY").find(upper) != std::string_view::npos && upper != '\0' ? upper
                                                                                                    : '\0';
}

/// Returns the layer of a part with this prefix; creates it if it does not exist.
ExrLayer& layer_of(std::vector<ExrLayer>& layers, std::size_t first, int part, const std::string& prefix,
                   const std::string& term_name) {
    const std::string name = prefix.empty() ? term_name : prefix;
    for (std::size_t i = first; i < layers.size(); ++i)
        if (layers[i].name == name && layers[i].plain == prefix.empty())
            return layers[i];
    layers.push_back({.part = part, .name = name, .plain = prefix.empty()});
    return layers.back();
}

/// Prefers the upper-case name if both exist.
void set_name(std::string& to, const std::string& name) {
    if (to.empty() || std::isupper(static_cast<unsigned char>(name.back())))
        to = name;
}

std::string names_of(const std::vector<ExrLayer>& layers) {
    constexpr std::size_t kMaxListed = 12, kMaxName = 60;
    std::string list;
    for (std::size_t i = 0; i < std::min(layers.size(), kMaxListed); ++i)
        list += (i > 0 ? ", '" : "'") + printable(layers[i].name, kMaxName) + "'";
    return layers.size() > kMaxListed ? list + ", ..." : list;
}

} // namespace

std::vector<ExrLayer> color_layers(std::span<const Imf::Header> parts) {
    std::vector<ExrLayer> layers;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const std::size_t first = layers.size();
        const std::string term_name = parts[part].hasName() ? parts[part].name() : "";
        const Imf::ChannelList& channels = parts[part].channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            const std::string name = channel.name();
            const char color = color_of(name);
            if (color == '\0')
                continue;
            const std::string prefix = name.size() > 1 ? name.substr(0, name.size() - 2) : "";
            ExrLayer& layer = layer_of(layers, first, static_cast<int>(part), prefix, term_name);
            if (color == 'Y')
                set_name(layer.grey, name);
            else
                set_name(layer.channels[std::string_view("RGB").find(color)], name);
        }
    }
    for (ExrLayer& layer : layers)
        if (std::any_of(layer.channels.begin(), layer.channels.end(),
                        [](const std::string& name) { return !name.empty(); }))
            layer.grey.clear();
    return layers;
}

ExrLayer choose_layer(const std::vector<ExrLayer>& layers, const std::string& wanted,
                      std::vector<std::string>& notices) {
    if (layers.empty())
        throw Error("it has no channel R, G, B or Y");
    const auto chosen = std::find_if(layers.begin(), layers.end(), [&](const ExrLayer& layer) {
        return wanted.empty() ? layer.plain && layer.part == 0 : layer.name == wanted;
    });
    if (chosen == layers.end() && !wanted.empty())
        throw Error("it has no color layer '" + printable(wanted, 60) + "'; its color layers are " +
                    names_of(layers));
    if (chosen == layers.end() && layers.size() > 1)
        throw Error("it has several color layers: " + names_of(layers) + "; choose one with --layer NAME");
    const ExrLayer& layer = chosen == layers.end() ? layers.front() : *chosen;
    if (wanted.empty() && layers.size() > 1)
        notices.push_back("has " + std::to_string(layers.size()) + " color layers: " + names_of(layers) +
                          "; the first is read, choose another with --layer NAME");
    else if (wanted.empty() && !layer.plain)
        notices.push_back("its only color layer, '" + printable(layer.name, 60) + "', is read");
    return layer;
}

} // namespace prt
