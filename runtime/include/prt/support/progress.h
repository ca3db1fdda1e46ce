#pragma once

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

    void update(double fraction) const {
        if (stop.stop_requested())
            throw Cancelled();
        if (report)
            report(fraction);
    }
};

} // namespace prt
