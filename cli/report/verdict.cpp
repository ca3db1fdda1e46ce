// Summarises the errors of a compressed file in one line.

#include "report/verdict.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

/// An error as a viewer sees it, and its cause in words.
struct Cause {
    double error = 0;
    std::string words;
};

/// The greatest of the errors. Half of a jump counts: it is the difference of two errors. Errors are about
/// normally distributed: 95 % of the area have less than twice the root mean square.
Cause greatest(const Verdict& v) {
    const Cause causes[] = {{v.visible, v.visible_under},
                            {2 * v.lit_rms, "under " + v.under},
                            {v.jumps / 2, "jumps between neighbours, " + v.jumps_under},
                            {v.seam_99 / 2, "seams between clusters, the largest at " + v.seam_at}};
    return *std::ranges::max_element(causes, {}, &Cause::error);
}

std::string judgement(const Verdict& v) {
    const Cause cause = greatest(v);
    if (cause.error > 5 * kVisible)
        return "visibly wrong: " + cause.words;
    if (cause.error > kVisible)
        return "visible on close comparison: " + cause.words;
    return std::string("looks the same as the bake") +
           (v.seam.value_or(0) > kVisible ? ", but for single edges between clusters" : "");
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
        line += fmt::format("; worst seam {}", short_percent(*v.seam));
    return line + ": " + judgement(v);
}

} // namespace prt::cli
