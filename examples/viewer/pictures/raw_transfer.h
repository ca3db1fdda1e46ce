#pragma once

#include "prt/core/transfer.h"
#include "runtime/render/gl/gl_objects.h"

namespace viewer {

/// Raw transfer on the GPU: a compute shader computes exit radiance when the light changes.
class RawTransfer {
public:
    /// `max_receivers`: maximum number of receivers per dispatch, a multiple of 256.
    RawTransfer(const prt::Transfer& transfer, std::size_t max_receivers);

    const prt::TransferLayout& layout() const { return layout_; }
    /// Computes the radiance. `lighting` must have at least the order of the transfer.
    void set_light(const prt::Lighting& lighting);
    /// Three floats per receiver.
    const prt::GlObject& radiance() const { return radiance_; }

private:
    prt::TransferLayout layout_;
    std::size_t receivers_, stride_; ///< number of receivers; bytes per receiver
    std::size_t max_receivers_;
    prt::GlObject vectors_, light_, radiance_, program_;
};

} // namespace viewer
