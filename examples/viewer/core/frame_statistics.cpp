// Measures the time from frame to frame and the time to open a model.

#include "core/frame_statistics.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace viewer {

void FrameStatistics::begin_frame() {
    const double passed = 1e3 * since_frame_.seconds();
    figures.milliseconds.frame += 0.1 * (passed - figures.milliseconds.frame);
    figures.milliseconds.longest = std::max(figures.milliseconds.longest, passed);
    since_frame_ = {};
}

void FrameStatistics::end_opening() {
    if (!opening_)
        return;
    glFinish();
    figures.milliseconds.open = 1e3 * opening_->seconds();
    opening_.reset();
}

} // namespace viewer
