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
    std::string name;                      ///< prefix of the channels, or name of the part
    std::array<std::string, 3> channels{}; ///< full names of R, G and B; empty if missing
    std::string grey = {};                 ///< full name of Y, if there is no R, G or B
    bool plain = false;                    ///< the channels have no prefix
};

/// Returns all layers with R, G or B, or with Y, in the order of the file, ignoring case.
std::vector<ExrLayer> color_layers(std::span<const Imf::Header> parts);

/// Returns the layer called `wanted`. If `wanted` is empty, returns the channels of the first part without a
/// prefix, else the only layer. Adds a notice if the choice is ambiguous. Throws `Error` with a list of the
/// layers.
ExrLayer choose_layer(const std::vector<ExrLayer>& layers, const std::string& wanted,
                      std::vector<std::string>& notices);

} // namespace prt
