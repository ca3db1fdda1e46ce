#pragma once

// Layout of a transfer vector. Its terms respond to different kinds of light and are stored one after
// another. Experimental.

#include "prt/light.h"
#include "prt/sh_basis.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Type of light that a term of transfer carries. It determines the lighting of the term.
enum class TermKind {
    direct,   ///< distant light without a bounce: the renderer can shadow suns itself
    indirect, ///< distant light after one bounce or more, and through participating media
    combined, ///< direct and indirect combined
    lamp,     ///< light of a group of scene lamps that share one strength
};

/// Returns the identifier used in files and reports: "direct", "indirect", "combined", "lamp".
const char* to_string(TermKind kind);

/// One term of a transfer vector.
struct TransferTerm {
    TermKind kind = TermKind::combined;
    int channels = 1;      ///< 1: grey, the same for red, green and blue; else 3
    std::string name = {}; ///< name of a lamp, to set its strength; empty for all other kinds
    /// Names of the lights and materials of the scene in this group; empty: `name` is the only member.
    std::vector<std::string> members = {};

    /// Returns whether a light or material of that name belongs to the lamp.
    bool has_member(const std::string& member) const;
    friend bool operator==(const TransferTerm&, const TransferTerm&) = default;
};

/// Maximum number of lamps of a layout; a group with any number of lights counts once.
inline constexpr std::size_t kMaxLamps = 64;

/// Layout of a transfer vector: the concatenation of its terms, each [channels][columns_of(term)]. With
/// several outputs the vector contains one such concatenation per output.
struct TransferLayout {
    int order = 0;
    std::vector<TransferTerm> terms = {}; ///< at most one of each kind except lamps, in the order of
                                          ///< `TermKind`
    /// Number of colors that a receiver computes from a lighting: 1 for exit radiance; 4, 9 or 16 for the
    /// coefficients of incident light at a probe.
    std::size_t outputs = 1;

    /// Returns 3 if any term has color, else 1.
    int channels() const;
    /// Returns whether a term of that kind exists. With `direct`, suns can be lit separately from the sky.
    bool has(TermKind kind) const;
    /// Number of colors that light a term: order² coefficients of a sky, or the one strength of a lamp.
    std::size_t columns_of(const TransferTerm& term) const {
        return term.kind == TermKind::lamp ? 1 : static_cast<std::size_t>(coefficient_count(order));
    }
    /// Number of coefficients of a term.
    std::size_t numbers_of(const TransferTerm& term) const {
        return static_cast<std::size_t>(term.channels) * columns_of(term);
    }
    /// Number of coefficients of a transfer vector, over all outputs.
    std::size_t dimension() const;
    /// Returns the layout of the vector of one output.
    TransferLayout of_one_output() const { return {order, terms}; }
    /// Number of light colors that one output of a transfer vector is multiplied with.
    std::size_t columns() const;
    /// Returns the terms of distant light, which are the first.
    std::span<const TransferTerm> distant_terms() const;
    /// Returns the terms of lamps, which are the last.
    std::span<const TransferTerm> lamp_terms() const;
    std::size_t lamps() const { return lamp_terms().size(); }
    /// Number of coefficients of the terms of distant light in one output; they are its first ones.
    std::size_t distant_numbers() const;

    friend bool operator==(const TransferLayout&, const TransferLayout&) = default;
};

/// Returns the layout of a single term.
TransferLayout layout_of_one(int order, int channels, TermKind kind = TermKind::combined);

/// Throws `Error` unless the order is valid and the terms satisfy the conditions documented in `TransferTerm`
/// and `TransferLayout`.
void check_layout(const TransferLayout& layout);

/// The lighting of a frame. The `direct` term is lit by `sky` only; all other terms of distant light are lit
/// by `sky` and `suns`.
struct Lighting {
    Light sky;
    /// Suns that the renderer adds to direct light with sharp shadows, as the sum of their `as_light`.
    /// Without a value all light is in `sky`.
    std::optional<Light> suns = {};
    /// Strength or color of each lamp of the layout; empty: 1, as in the scene.
    std::vector<glm::vec3> lamps = {};
    std::string name = {}; ///< for reports, one or two words or the name of a file; may be empty
};

/// Non-owning view of the coefficients of a lighting: a sky alone, or a sky with suns and lamps.
struct LightingView {
    std::span<const glm::vec3> sky;   ///< [order² or more]
    std::span<const glm::vec3> suns;  ///< [order² or more]; empty: all light is in `sky`
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

/// Maximum number of coefficients of one output of a transfer vector that `check_layout` accepts.
inline constexpr std::size_t kMaxTransferNumbers = // per output
    6 * static_cast<std::size_t>(coefficient_count(kMaxOrder)) + 3 * kMaxLamps;
/// Maximum number of light colors that one output of a transfer vector is multiplied with.
inline constexpr std::size_t kMaxLightColumns =
    2 * static_cast<std::size_t>(coefficient_count(kMaxOrder)) + kMaxLamps;

/// Returns the colors that each term is multiplied with, term after term: [layout.columns()]. Throws `Error`
/// if `lighting` has fewer bands than the layout, or another number of lamps.
std::vector<glm::vec3> light_columns(const TransferLayout& layout, const LightingView& lighting);
/// Writes the colors of `light_columns` to `columns` [layout.columns()]; allocates nothing.
void write_light_columns(const TransferLayout& layout, const LightingView& lighting,
                         std::span<glm::vec3> columns);

} // namespace prt
