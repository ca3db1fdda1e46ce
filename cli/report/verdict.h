#pragma once

#include <optional>
#include <string>

namespace prt::cli {

/// What a difference in radiance must pass, relative to the mean, to be seen: the upper end of Weber's
/// fraction, 1 to 2 %, and little more than one step of an 8-bit sRGB display at its middle, 1.7 %
/// (docs/math.md, section 6).
inline constexpr double kVisible = 0.02;

/// Measures that a verdict is based on, each the worst of the lights that were named.
struct Verdict {
    std::optional<std::size_t> bytes_per_vertex; ///< to bind; unset: not compressed
    std::string under;                           ///< "these 3 lights"
    double lit_rms = 0;
    double visible = 0;        ///< contrast error of 95 % of the area
    std::string visible_under; ///< that light
    double jumps = 0;          ///< of contrast, of 99 % of the edges
    std::string jumps_under;
    std::optional<double> seam; ///< the largest jump of contrast between clusters
    double seam_99 = 0;         ///< 99 % of such edges stay below
    std::string seam_at;        ///< position of the largest
};

/// One line: "4 bytes a vertex, 0.9 % under these 3 lights; 95 % of the area within 1.1 % of what is seen;
/// worst seam 2 %: looks the same as the bake". Otherwise it ends in "visible on close
/// comparison: " (beyond `kVisible`) or "visibly wrong: " (beyond five times that) and the cause: "lamp
/// LampTable".
std::string in_one_line(const Verdict& verdict);

} // namespace prt::cli
