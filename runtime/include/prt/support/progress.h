#pragma once

// How far long work is, and how it is stopped. Experimental.

#include "prt/support/error.h"

#include <functional>
#include <stop_token>

namespace prt {

/// How long work tells its caller how far it is, and how the caller stops it. Both are optional.
struct Progress {
    /// Called with the finished share in [0, 1], from the thread that started the work.
    std::function<void(double)> report;
    /// When a stop is requested, the work throws `Cancelled` within a fraction of a second.
    std::stop_token stop;

    /// Throws `Cancelled` when a stop is requested.
    void check() const {
        if (stop.stop_requested())
            throw Cancelled();
    }
    void update(double fraction) const {
        check();
        if (report)
            report(fraction);
    }
    /// The progress of a part of the work that takes the share `from` .. `to` of the whole.
    Progress part(double from, double to) const {
        Progress part{{}, stop};
        if (report)
            part.report = [whole = report, from, to](double share) { whole(from + (to - from) * share); };
        return part;
    }
};

} // namespace prt
