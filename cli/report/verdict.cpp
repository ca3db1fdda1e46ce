// Summarises the errors of a compressed file in one line.

#include "cli/report/verdict.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::pipeline {
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
                            {v.jumps / 2, "jumps between neighbouring vertices, " + v.jumps_under},
                            {v.seam_99 / 2, "seams between clusters, largest at " + v.seam_at}};
    return *std::ranges::max_element(causes, {}, &Cause::error);
}

std::string judgement(const Verdict& v) {
    const Cause cause = greatest(v);
    if (cause.error > 5 * kVisible)
        return "clearly visible difference from the bake: " + cause.words;
    if (cause.error > kVisible)
        return "visible difference when switching between bake and file: " + cause.words;
    return std::string("no visible difference from the bake") +
           (v.seam.value_or(0) > kVisible ? ", except at single edges between clusters" : "");
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
        line = fmt::format("{} bytes per vertex, ", *v.bytes_per_vertex);
    line += fmt::format("lit_rms {} under {}", short_percent(v.lit_rms), v.under);
    line += fmt::format("; contrast error up to {} on 95 % of the area", short_percent(v.visible));
    if (v.seam)
        line += fmt::format("; largest seam {}", short_percent(*v.seam));
    return line + ": " + judgement(v);
}

} // namespace prt::pipeline
