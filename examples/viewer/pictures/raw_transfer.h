#pragma once

#include "prt/gl_objects.h"
#include "prt/transfer.h"

namespace viewer {

/// Transfer as it was baked, on the GPU: a compute shader forms exit radiance when the light changes.
class RawTransfer {
public:
    /// `most_receivers`: that one dispatch takes, a multiple of 256.
    RawTransfer(const prt::Transfer& transfer, std::size_t most_receivers);

    const prt::TransferLayout& layout() const { return layout_; }
    /// Forms the radiance. `lighting` has as many bands as the transfer at least.
    void set_light(const prt::Lighting& lighting);
    /// Three floats for each receiver.
    const prt::GlObject& radiance() const { return radiance_; }

private:
    prt::TransferLayout layout_;
    std::size_t receivers_, stride_; ///< bytes of a receiver
    std::size_t most_receivers_;
    prt::GlObject vectors_, light_, radiance_, program_;
};

} // namespace viewer
