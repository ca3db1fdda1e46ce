#pragma once

// Progress and cancellation of long work. Experimental.

#include "prt/support/error.h"

#include <functional>
#include <stop_token>

namespace prt {

/// Callback for progress, and a token to cancel the work. Both are optional.
struct Progress {
    /// Called with the finished fraction in [0, 1], from the thread that started the work.
    std::function<void(double)> report;
    /// After a stop request, the work throws `Cancelled` within a fraction of a second.
    std::stop_token stop;

    /// Throws `Cancelled` after a stop request.
    void check() const {
        if (stop.stop_requested())
            throw Cancelled();
    }
    /// Throws `Cancelled` after a stop request; otherwise reports `fraction`.
    void update(double fraction) const {
        check();
        if (report)
            report(fraction);
    }
    /// Returns a `Progress` for one step of the work: its fractions 0..1 are reported as `from` .. `to` of
    /// the total.
    Progress range(double from, double to) const {
        Progress range{{}, stop};
        if (report)
            range.report = [whole = report, from, to](double share) { whole(from + (to - from) * share); };
        return range;
    }
};

} // namespace prt
