#pragma once

// How a transfer vector is made up: parts that answer to different light, side by side. Experimental.

#include "prt/light.h"
#include "prt/sh_basis.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// What a part of transfer carries, and by that what lights it.
enum class PartKind {
    direct,   ///< distant light that arrives without a bounce: suns can be left to the renderer
    indirect, ///< distant light that arrives after one bounce or more, and through media
    whole,    ///< both in one
    lamp,     ///< light of lamps of the scene that are dimmed together
};

/// The words of files and reports: "direct", "indirect", "whole", "lamp".
const char* to_string(PartKind kind);

struct TransferPart {
    PartKind kind = PartKind::whole;
    int channels = 1;      ///< 1: the same for red, green and blue; else 3
    std::string name = {}; ///< of a lamp, by which it is dimmed; the others have none
    /// Names of the lights and materials of the scene that are in a group; empty: its own is the one.
    std::vector<std::string> members = {};

    /// Whether a light or material of that name is in the lamp.
    bool has_member(const std::string& member) const;
    friend bool operator==(const TransferPart&, const TransferPart&) = default;
};

/// Lamps of a layout at most: a group of any number of lights is one.
inline constexpr std::size_t kMostLamps = 64;

/// A transfer vector is its parts one behind the other, each [channels][columns_of(part)]; of several outputs
/// it is one such vector for each of them.
struct TransferLayout {
    int order = 0;
    std::vector<TransferPart> parts = {}; ///< at most one of each kind but lamps, in the order of `PartKind`
    /// Colors that a receiver makes of a lighting: its exit radiance, or 4, 9 or 16 coefficients of the light
    /// that comes in at a probe.
    std::size_t outputs = 1;

    /// 3 where any part has color, else 1.
    int channels() const;
    /// Whether there is a part of that kind: `direct` where suns can be lit apart from the sky.
    bool has(PartKind kind) const;
    /// Colors that light a part: order² coefficients of a sky, or the one strength of a lamp.
    std::size_t columns_of(const TransferPart& part) const {
        return part.kind == PartKind::lamp ? 1 : static_cast<std::size_t>(coefficient_count(order));
    }
    /// Numbers of a part.
    std::size_t numbers_of(const TransferPart& part) const {
        return static_cast<std::size_t>(part.channels) * columns_of(part);
    }
    /// Numbers of a transfer vector, of all outputs.
    std::size_t dimension() const;
    /// The layout of the vector of one output.
    TransferLayout of_one_output() const { return {order, parts}; }
    /// Colors of light that a transfer vector is multiplied with.
    std::size_t columns() const;
    /// The parts of distant light, and behind them those that are lamps.
    std::span<const TransferPart> distant_parts() const;
    std::span<const TransferPart> lamp_parts() const;
    std::size_t lamps() const { return lamp_parts().size(); }
    /// Numbers of a vector that distant light is multiplied with: the first of one output.
    std::size_t distant_numbers() const;

    friend bool operator==(const TransferLayout&, const TransferLayout&) = default;
};

/// The layout of a single part.
TransferLayout layout_of_one(int order, int channels, PartKind kind = PartKind::whole);

/// Throws `Error` unless the order is one, and the parts are such as the comments above say.
void check_layout(const TransferLayout& layout);

/// What a frame is lit with. `direct` transfer is lit by `sky`, other parts of distant light by `sky` and
/// `suns`.
struct Lighting {
    Light sky;
    /// Those that the renderer adds to direct light with sharp shadows: `as_light` of each. Without them all
    /// light is in `sky`.
    std::optional<Light> suns = {};
    /// What each lamp of the layout is dimmed or colored by; empty: 1, as in the scene.
    std::vector<glm::vec3> lamps = {};
};

/// The coefficients of a lighting, wherever they are: of a sky alone, or of a sky, its suns and lamps.
struct LightingView {
    std::span<const glm::vec3> sky;   ///< [order² or more]
    std::span<const glm::vec3> suns;  ///< the same; empty: all light is in `sky`
    std::span<const glm::vec3> lamps; ///< [lamps]; empty: 1, as in the scene

    LightingView(std::span<const glm::vec3> of_sky, std::span<const glm::vec3> of_suns = {},
                 std::span<const glm::vec3> of_lamps = {})
        : sky(of_sky), suns(of_suns), lamps(of_lamps) {}
    LightingView(const std::vector<glm::vec3>& of_sky) : sky(of_sky) {}
    LightingView(const Light& light) : sky(light.coefficients) {}
    LightingView(const Lighting& lighting) : sky(lighting.sky.coefficients), lamps(lighting.lamps) {
        if (lighting.suns)
            suns = lighting.suns->coefficients;
    }
};

/// Numbers of a transfer vector of the largest layout that `check_layout` lets pass, and its columns of
/// light.
inline constexpr std::size_t kMostTransferNumbers = // of an output
    6 * static_cast<std::size_t>(coefficient_count(kMaxOrder)) + 3 * kMostLamps;
inline constexpr std::size_t kMostLightColumns =
    2 * static_cast<std::size_t>(coefficient_count(kMaxOrder)) + kMostLamps;

/// The colors that each part is multiplied with, part behind part: [layout.columns()]. Throws `Error` where
/// `lighting` has fewer bands than the layout, or strengths of another number of lamps.
std::vector<glm::vec3> light_columns(const TransferLayout& layout, const LightingView& lighting);
/// The same into `columns` [layout.columns()]; allocates nothing.
void write_light_columns(const TransferLayout& layout, const LightingView& lighting,
                         std::span<glm::vec3> columns);

} // namespace prt
