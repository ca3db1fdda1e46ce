#pragma once

// Layers of an OpenEXR file: groups of channels with a common prefix, and parts.

#include <OpenEXR/ImfHeader.h>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Color channels of one layer in one part.
struct ExrLayer {
    int part = 0;
    std::string name;                      ///< the prefix of the channels, or the name of the part
    std::array<std::string, 3> channels{}; ///< full names of R, G and B, empty where one is missing
    std::string grey = {};                 ///< full name of Y, where there is no R, G or B
    bool plain = false;                    ///< the channels have no prefix
};

/// All layers with R, G or B, or with Y, in the order of the file. Lower case counts as upper case.
std::vector<ExrLayer> color_layers(std::span<const Imf::Header> parts);

/// The layer called `wanted`; without a name the first part's plain channels, else the only layer. Adds a
/// notice where another could have been meant. Throws `Error` that lists the layers.
ExrLayer choose_layer(const std::vector<ExrLayer>& layers, const std::string& wanted,
                      std::vector<std::string>& notices);

} // namespace prt
