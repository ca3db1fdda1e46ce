#include "report/verdict.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

/// How two pictures must be viewed for a difference to be seen.
enum class Seen { same, flicking, side_by_side, plainly };

/// Errors spread about as Gaussians do: below half of what is visible in the root mean square, 95 % of the
/// surface is within it.
Seen seen(const Verdict& v) {
    const double error = std::max(2 * v.lit_rms, v.visible);
    return error <= kVisible        ? Seen::same
           : error <= 4 * kVisible  ? Seen::flicking
           : error <= 10 * kVisible ? Seen::side_by_side
                                    : Seen::plainly;
}

std::string judgement(const Verdict& v) {
    const double seam = v.seam.value_or(0);
    switch (seen(v)) {
    case Seen::same:
        return std::string("looks the same as the bake") + (seam <= kVisible ? ""
                                                            : v.seam_99 <= kVisible
                                                                ? ", but for single edges between clusters"
                                                                : ", but for edges between clusters");
    case Seen::flicking:
        return "differs from the bake, as flicking between both shows";
    case Seen::side_by_side:
        return "differs from the bake where both are seen side by side";
    case Seen::plainly:
        break;
    }
    return "differs from the bake in plain sight" +
           (v.visible > 10 * kVisible ? ": under " + v.visible_under : std::string());
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
    line += fmt::format("; 95 % of the area within {} of what is seen", short_percent(v.visible));
    if (v.seam)
        line += fmt::format("; worst seam {} of the mean radiance", short_percent(*v.seam));
    return line + ": " + judgement(v);
}

} // namespace prt::cli
