#pragma once

// Progress reports and cancellation of long operations, such as a bake or a compression. Experimental.

#include "prt/core/error.h"

#include <functional>
#include <stop_token>

namespace prt {

/// Receives the progress of a long operation and can cancel it. A default-constructed `Progress` receives
/// nothing and never cancels.
struct Progress {
    /// The operation calls this with its finished fraction, 0..1, on the thread that started the operation.
    /// Empty: no reports.
    std::function<void(double)> report;
    /// If a stop is requested from the source of this token, the operation throws `Cancelled` within a
    /// fraction of a second. Default: a token without a source, which never stops the operation.
    std::stop_token stop;

    /// Throws `Cancelled` if a stop has been requested; the operation calls this regularly.
    void check() const {
        if (stop.stop_requested())
            throw Cancelled();
    }
    /// Throws `Cancelled` if a stop has been requested; otherwise calls `report` with `fraction` (0..1),
    /// unless `report` is empty.
    void update(double fraction) const {
        check();
        if (report)
            report(fraction);
    }
    /// Returns a `Progress` for one step of the operation. It maps the fraction of the step, 0..1, to the
    /// range `from` .. `to` of the whole operation, and passes the result to `report`. It has a copy of
    /// `report` and the same stop token.
    Progress range(double from, double to) const {
        Progress range{{}, stop};
        if (report)
            range.report = [whole = report, from, to](double share) { whole(from + (to - from) * share); };
        return range;
    }
};

} // namespace prt
