#pragma once

// Layout of transfer vectors, and the lighting that their terms respond to. A term is the part of a transfer
// vector for one kind of light. Stable.

#include "prt/core/light.h"
#include "prt/core/sh_basis.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Kind of light to which a term of a transfer vector responds.
enum class TermKind {
    direct,   ///< distant light without a bounce and without a medium; `Lighting::suns` does not light it
    indirect, ///< distant light, including suns, after one bounce or more or through a medium
    combined, ///< all distant light, including suns: the sum of direct and indirect light
    lamp,     ///< light, with bounces, of one lamp: a group of lights and emissive materials of the scene
};

/// Returns the identifier used in files and reports: "direct", "indirect", "combined" or "lamp".
const char* to_string(TermKind kind);

/// Description of one term of a transfer vector, without its coefficients.
struct TransferTerm {
    TermKind kind = TermKind::combined;
    int channels = 1;      ///< 1: the same coefficients for red, green and blue; 3: one set for each
    std::string name = {}; ///< lamp: its name, unique in the layout, not empty; other kinds: empty
    /// Lamp: names of the lights and materials of the scene that form it; empty: only the one named `name`.
    /// Always empty for other kinds.
    std::vector<std::string> members = {};

    /// Returns whether the light or material of the scene named `member` belongs to this lamp: whether
    /// `members` contains the name or, if `members` is empty, whether `name` equals it.
    bool has_member(const std::string& member) const;
    friend bool operator==(const TransferTerm&, const TransferTerm&) = default;
};

/// Maximum number of lamp terms of a layout. A lamp with several lights and materials counts once.
inline constexpr std::size_t kMaxLamps = 64;

/// Layout of a transfer vector: [outputs][terms][channels of the term][columns_of(term)], without gaps.
/// `check_layout` checks the conditions on its members.
struct TransferLayout {
    int order = 0; ///< order of the terms of distant light, 1..kMaxOrder; 0: not set, which is invalid
    /// At least one term. First the terms of distant light: nothing, `direct`, `indirect`, both in this
    /// sequence, or `combined`. Then 0 to kMaxLamps lamp terms.
    std::vector<TransferTerm> terms = {};
    /// Number of RGB colors that a receiver computes from a lighting: 1 for exit radiance; 4, 9 or 16 for the
    /// SH coefficients of incident light at a probe.
    std::size_t outputs = 1;

    /// Returns 3 if a term has three channels, else 1.
    int channels() const;
    /// Returns whether the layout has a term of the given kind. With `direct`, a renderer can add the
    /// direct light of suns itself.
    bool has(TermKind kind) const;
    /// Number of coefficients per channel of `term`, which is the number of RGB colors that light it: order²
    /// SH coefficients for distant light, or 1 (the strength) for a lamp.
    std::size_t columns_of(const TransferTerm& term) const {
        return term.kind == TermKind::lamp ? 1 : static_cast<std::size_t>(coefficient_count(order));
    }
    /// Number of transfer coefficients of `term` in one output: its channels times `columns_of(term)`.
    std::size_t numbers_of(const TransferTerm& term) const {
        return static_cast<std::size_t>(term.channels) * columns_of(term);
    }
    /// Number of transfer coefficients of one receiver: all terms of all outputs.
    std::size_t dimension() const;
    /// Returns this layout with outputs = 1: that of the part of a transfer vector for one output.
    TransferLayout of_one_output() const { return {order, terms}; }
    /// Number of RGB colors that light one output: the sum of `columns_of` over all terms. The result of
    /// `light_columns` has this length.
    std::size_t columns() const;
    /// Returns the terms of distant light (`direct`, `indirect`, `combined`), which are the first of `terms`,
    /// as a view of `terms`. May be empty.
    std::span<const TransferTerm> distant_terms() const;
    /// Returns the lamp terms, which are the last of `terms`, as a view of `terms`. May be empty.
    std::span<const TransferTerm> lamp_terms() const;
    /// Number of lamp terms.
    std::size_t lamps() const { return lamp_terms().size(); }
    /// Number of transfer coefficients of all terms of distant light in one output. They precede the
    /// coefficients of the lamps.
    std::size_t distant_numbers() const;

    friend bool operator==(const TransferLayout&, const TransferLayout&) = default;
};

/// Returns a layout with a single term, of `order` bands and `channels` (1 or 3) channels, and one output. A
/// term of kind `lamp` still needs a name.
TransferLayout layout_of_one(int order, int channels, TermKind kind = TermKind::combined);

/// Throws `Error` unless the order is in 1..kMaxOrder, outputs is 1, 4, 9 or 16, and the terms satisfy the
/// conditions documented in `TransferTerm` and `TransferLayout`. Does not check the names in the `members` of
/// lamps.
void check_layout(const TransferLayout& layout);

/// The lighting of a frame. A `direct` term is lit by `sky` only; `indirect` and `combined` terms are lit by
/// the sum of `sky` and `suns`; each lamp term is lit by its strength in `lamps`.
struct Lighting {
    Light sky; ///< radiance of the sky; includes all suns if `suns` has no value
    /// Suns that the renderer shades itself, with sharp shadows, and adds to the direct light of the sky: the
    /// sum of their `as_light` (prt/core/light.h). No value: all light is in `sky`.
    std::optional<Light> suns = {};
    /// [layout.lamps()] strength of each lamp as linear RGB factors, in the sequence of
    /// `TransferLayout::lamp_terms`; 1 is the strength in the scene, 0 is off. Empty: 1 for every lamp.
    std::vector<glm::vec3> lamps = {};
    std::string name = {}; ///< label in reports, for example the name of a file; may be empty
};

/// View of the coefficients of a lighting, with the meaning of `Lighting`: a sky alone, or a sky with suns
/// and lamps. Owns nothing; the viewed arrays must outlive it. Lights may have more bands than the layout;
/// the additional bands are ignored.
struct LightingView {
    std::span<const glm::vec3> sky;   ///< [at least order² of the layout] SH coefficients of the sky
    std::span<const glm::vec3> suns;  ///< [at least order² of the layout]; empty: all light is in `sky`
    std::span<const glm::vec3> lamps; ///< [layout.lamps()] strengths; empty: 1 for every lamp

    /// Views the coefficients of a sky, of suns (default: all light is in the sky), and strengths of lamps
    /// (default: 1 for every lamp).
    LightingView(std::span<const glm::vec3> of_sky, std::span<const glm::vec3> of_suns = {},
                 std::span<const glm::vec3> of_lamps = {})
        : sky(of_sky), suns(of_suns), lamps(of_lamps) {}
    /// Views the coefficients of a sky that includes all suns. Every lamp has the strength 1.
    LightingView(const std::vector<glm::vec3>& of_sky) : sky(of_sky) {}
    /// Views `light` as a sky that includes all suns. Every lamp has the strength 1.
    LightingView(const Light& light) : sky(light.coefficients) {}
    /// Views sky, suns and lamps of `lighting`. Suns without coefficients count as no suns.
    LightingView(const Lighting& lighting) : sky(lighting.sky.coefficients), lamps(lighting.lamps) {
        if (lighting.suns)
            suns = lighting.suns->coefficients;
    }
};

/// Maximum number of transfer coefficients of one output of a layout that `check_layout` accepts: `direct`
/// and `indirect` terms and kMaxLamps lamps, each with three channels, at order kMaxOrder.
inline constexpr std::size_t kMaxTransferNumbers = // per output
    6 * static_cast<std::size_t>(coefficient_count(kMaxOrder)) + 3 * kMaxLamps;
/// Maximum of `TransferLayout::columns()` for layouts that `check_layout` accepts.
inline constexpr std::size_t kMaxLightColumns =
    2 * static_cast<std::size_t>(coefficient_count(kMaxOrder)) + kMaxLamps;

/// Returns the RGB colors that light the terms of one output, term after term, [layout.columns()]: for a term
/// of distant light the first order² coefficients of its light (see `Lighting`), for a lamp its strength.
/// Throws `Error` if the sky has fewer than order² coefficients (also if all terms are lamps), if the suns
/// are not empty and have fewer than order², or if `lighting.lamps` has neither 0 nor layout.lamps()
/// elements.
std::vector<glm::vec3> light_columns(const TransferLayout& layout, const LightingView& lighting);
/// Writes the result of `light_columns(layout, lighting)` to `columns`, which has at least layout.columns()
/// elements. Throws the same errors. Allocates no memory unless it throws.
void write_light_columns(const TransferLayout& layout, const LightingView& lighting,
                         std::span<glm::vec3> columns);

} // namespace prt
