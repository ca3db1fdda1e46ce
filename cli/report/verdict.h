#pragma once

#include <optional>
#include <string>

namespace prt::pipeline {

/// Visible difference in radiance, relative to the mean: the upper end of Weber's fraction, 1 to 2 %, and
/// slightly more than one step of an 8-bit sRGB display at its middle, 1.7 % (docs/math.md, section 6).
inline constexpr double kVisible = 0.02;

/// Measures that a verdict is based on, each the worst over the named lights.
struct Verdict {
    std::optional<std::size_t> bytes_per_vertex; ///< bytes of vertex attributes; unset: not compressed
    std::string under;                           ///< "these 3 lights"
    double lit_rms = 0;
    double visible = 0;        ///< contrast error that 95 % of the area stays below
    std::string visible_under; ///< light of `visible`
    double jumps = 0;          ///< jump of contrast that 99 % of the edges stay below
    std::string jumps_under;
    std::optional<double> seam; ///< maximum jump of contrast between clusters
    double seam_99 = 0;         ///< jump that 99 % of edges between clusters stay below
    std::string seam_at;        ///< position of the maximum
};

/// Returns one line: "4 bytes per vertex, lit_rms 0.9 % under these 3 lights; contrast error up to 1.1 % on
/// 95 % of the area; largest seam 2 %: no visible difference from the bake". Above `kVisible` it ends in
/// "visible difference when switching between bake and file: ", above five times `kVisible` in "clearly
/// visible difference from the bake: ", followed by the cause: "lamp LampTable".
std::string in_one_line(const Verdict& verdict);

} // namespace prt::pipeline
