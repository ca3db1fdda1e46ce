#pragma once

// Product of a gather operator with exit transfer on a device that stores the operator.

#include "prt/core/progress.h"
#include "prt/core/transfer.h"

#include <cstddef>
#include <optional>
#include <span>

namespace prt {

struct SumRows;

/// Energy before and after the last bounce: the maximum norm of a receiver's vector in one channel.
struct BounceEnergy {
    double before_last = 0, last = 0;
};

/// Applies a gather operator on a device.
class GatherProduct {
public:
    virtual ~GatherProduct() = default;
    /// Loads exit transfer [receivers][channels][order²], from which `apply` gathers.
    virtual void load(int order, std::span<const float> exit) = 0;
    /// Writes F exit for the rows from `first` on; `to` is [rows][channels][order²].
    virtual void apply(std::size_t first, std::span<float> to) = 0;
    /// Adds F exit of all rows to sums of rows, [sums][channels][order²]. `to` must be the same for all
    /// calls. Returns false if the device has too little memory.
    virtual bool apply_to_sums(const SumRows& to, std::span<float> sums) = 0;
    /// Adds `bounces` bounces to `transfer`, if rows are receivers and light does not change between bounces.
    /// Only the transfer is copied to and from the device. Returns nothing, and leaves `transfer` unchanged,
    /// if the device has too little memory.
    virtual std::optional<BounceEnergy> bounce(Transfer& transfer, int bounces, const Progress& progress) = 0;
    virtual std::size_t bytes_moved() const = 0; ///< transferred bytes of transfer and rows so far
};

} // namespace prt
