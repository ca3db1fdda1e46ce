#pragma once

// The product of a gather with exit transfer, by a device that keeps the gather.

#include "prt/support/progress.h"
#include "prt/transfer.h"

#include <cstddef>
#include <optional>
#include <span>

namespace prt {

struct SumRows;

/// What the last bounce began with and what it leaves: the largest norm of a receiver's vector of one
/// channel.
struct BounceEnergy {
    double before_last = 0, last = 0;
};

class GatherProduct {
public:
    virtual ~GatherProduct() = default;
    /// Takes exit transfer [receivers][channels][order²], from which `apply` gathers.
    virtual void load(int order, std::span<const float> exit) = 0;
    /// Writes F exit for the rows from `first` on, as many as `to` [rows][channels][order²] has.
    virtual void apply(std::size_t first, std::span<float> to) = 0;
    /// Adds F exit of all rows to sums of them, [sums][channels][order²]. `to` stays the same as long as this
    /// is there. False: the device has no room for it.
    virtual bool apply_to_sums(const SumRows& to, std::span<float> sums) = 0;
    /// Adds `bounces` bounces to `transfer`, where rows are receivers and nothing happens between bounces;
    /// nothing moves but it, there and back. Nothing: the device has no room for it, and `transfer` is what
    /// it was.
    virtual std::optional<BounceEnergy> bounce(Transfer& transfer, int bounces, const Progress& progress) = 0;
    virtual std::size_t bytes_moved() const = 0; ///< to and from the device, of transfer and rows, until now
};

} // namespace prt
