#pragma once

// How a transfer vector is made up: parts that answer to different light, side by side. Experimental.

#include "prt/light.h"
#include "prt/sh_basis.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// What a part of transfer carries of the light of a distant environment.
enum class PartKind {
    direct,   ///< what arrives without a bounce: suns can be left to the renderer, which shadows them sharply
    indirect, ///< what arrives after one bounce or more, and through media
    whole,    ///< both in one
};

/// The words of files and reports: "direct", "indirect", "whole".
const char* to_string(PartKind kind);

struct TransferPart {
    PartKind kind = PartKind::whole;
    int channels = 1; ///< 1: the same for red, green and blue; else 3

    friend bool operator==(const TransferPart&, const TransferPart&) = default;
};

/// A transfer vector is its parts one behind the other, each [channels][order²]: in all [blocks][order²].
struct TransferLayout {
    int order = 0;
    std::vector<TransferPart> parts = {}; ///< at most one of each kind, in the order of `PartKind`

    /// 3 where any part has color, else 1.
    int channels() const;
    /// Whether there is a part of that kind: `direct` where suns can be lit apart from the sky.
    bool has(PartKind kind) const;
    /// Runs of order² numbers: the channels of all parts together.
    std::size_t blocks() const;
    /// Numbers of a transfer vector.
    std::size_t dimension() const { return blocks() * static_cast<std::size_t>(coefficient_count(order)); }
    /// Colors of light that a transfer vector is multiplied with, order² for each part.
    std::size_t columns() const { return parts.size() * static_cast<std::size_t>(coefficient_count(order)); }

    friend bool operator==(const TransferLayout&, const TransferLayout&) = default;
};

/// The layout of a single part.
TransferLayout layout_of_one(int order, int channels, PartKind kind = PartKind::whole);

/// Throws `Error` unless the order is one, and the parts are such as the comments above say.
void check_layout(const TransferLayout& layout);

/// What a frame is lit with. `direct` transfer is lit by `sky`, the other parts by `sky` and `suns`.
struct Lighting {
    Light sky;
    /// Those that the renderer adds to direct light with sharp shadows: `as_light` of each. Without them all
    /// light is in `sky`.
    std::optional<Light> suns = {};
};

/// The coefficients of a lighting, wherever they are: of a sky alone, or of a sky and its suns.
struct LightingView {
    std::span<const glm::vec3> sky;  ///< [order² or more]
    std::span<const glm::vec3> suns; ///< the same; empty: all light is in `sky`

    LightingView(std::span<const glm::vec3> of_sky, std::span<const glm::vec3> of_suns = {})
        : sky(of_sky), suns(of_suns) {}
    LightingView(const std::vector<glm::vec3>& of_sky) : sky(of_sky) {}
    LightingView(const Light& light) : sky(light.coefficients) {}
    LightingView(const Lighting& lighting) : sky(lighting.sky.coefficients) {
        if (lighting.suns)
            suns = lighting.suns->coefficients;
    }
};

/// Numbers of a transfer vector of the largest layout that `check_layout` lets pass, and its columns of
/// light.
inline constexpr std::size_t kMostTransferNumbers =
    6 * static_cast<std::size_t>(coefficient_count(kMaxOrder));
inline constexpr std::size_t kMostLightColumns = 2 * static_cast<std::size_t>(coefficient_count(kMaxOrder));

/// The colors that each part is multiplied with: [parts][order²]. Throws `Error` where `lighting` has fewer
/// bands than the layout.
std::vector<glm::vec3> light_columns(const TransferLayout& layout, const LightingView& lighting);
/// The same into `columns` [layout.columns()]; allocates nothing.
void write_light_columns(const TransferLayout& layout, const LightingView& lighting,
                         std::span<glm::vec3> columns);

} // namespace prt
