#include "report/verdict.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

/// Errors spread about as Gaussians do: below half of what is visible in the root mean square, 95 % of the
/// surface is within it.
const char* judgement(const Verdict& v) {
    const double seam = v.seam.value_or(0);
    if (v.lit_rms <= kVisible / 2 && seam <= kVisible)
        return "looks the same as the bake";
    if (v.lit_rms <= kVisible / 2 && v.seam_99 <= kVisible)
        return "looks the same as the bake, but for single edges between clusters";
    if (v.lit_rms <= kVisible / 2)
        return "looks the same as the bake, but for edges between clusters";
    if (v.lit_rms <= 2 * kVisible)
        return "differs from the bake, as flicking between both shows";
    if (v.lit_rms <= 5 * kVisible)
        return "differs from the bake where both are seen side by side";
    return "differs from the bake in plain sight";
}

/// Two digits: 0.94 %, 2.1 %, 15 %.
std::string short_percent(double share) {
    const double percent = 100 * share;
    return fmt::format("{:.{}f} %", percent, percent < 0.995 ? 2 : percent < 9.95 ? 1 : 0);
}

} // namespace

std::string in_one_line(const Verdict& v) {
    std::string line;
    if (v.bytes_per_vertex)
        line = fmt::format("{} bytes a vertex, ", *v.bytes_per_vertex);
    line += fmt::format("{} under {}", short_percent(v.lit_rms), v.under);
    if (v.seam)
        line += fmt::format("; worst seam {} of the mean radiance", short_percent(*v.seam));
    return line + ": " + judgement(v);
}

} // namespace prt::cli
