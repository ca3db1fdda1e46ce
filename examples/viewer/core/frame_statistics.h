#pragma once

// Measures frame times and collects the figures shown.

#include "core/document.h"
#include "pictures/frame_renderer.h"

#include "runtime/core/support/stopwatch.h"

#include <optional>

namespace viewer {

struct Milliseconds {
    double frame = 0;     ///< mean over the last frames
    double longest = 0;   ///< longest time between two frames since it was reset
    double gpu = 0;       ///< GPU time of a frame
    double vertices = 0;  ///< GPU time of the vertex stage of the right picture
    double constants = 0; ///< time to compute and upload the constants when the light changes
    double open = 0;      ///< time from the request to open a model to its first frame
};

/// Figures shown by the panel and reported by scripts.
struct Figures {
    Milliseconds milliseconds;
    std::size_t receivers = 0, triangles = 0, triangles_drawn = 0;
    TransferFigures transfer; ///< transfer of vertices
    std::optional<LightmapFigures> lightmap;
    std::optional<InstanceFigures> instances; ///< figures of instances that share transfer
    int reference_passes = 0;
    Difference difference; ///< difference of the two pictures; valid only while it is shown
};

class FrameStatistics {
public:
    Figures figures;

    void begin_frame();
    /// Returns true for every 16th frame of a model; such a frame measures its vertex stage.
    bool times_vertices() { return frames_++ % 16 == 0; }

    void begin_opening() { opening_.emplace(); }
    void fail_opening() { opening_.reset(); }
    /// Reports that a frame of a model was drawn. Waits for the GPU after the first frame.
    void end_opening();

private:
    std::optional<prt::Stopwatch> opening_;
    prt::Stopwatch since_frame_;
    std::uint64_t frames_ = 0;
};

} // namespace viewer
