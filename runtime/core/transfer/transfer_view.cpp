// Reads transfer vectors block by block from floats, float16 or clusters.

#include "prt/core/transfer_view.h"

#include "runtime/core/transfer/clustered_vectors.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

namespace prt {
namespace {

/// Converts a finite float16. Its bits, shifted to the float's position, represent 2^-112 times its value;
/// this also holds for subnormal numbers.
float float_of_half(std::uint16_t half) {
    const float magnitude = std::bit_cast<float>(static_cast<std::uint32_t>(half & 0x7FFF) << 13) * 0x1p112f;
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude) |
                                static_cast<std::uint32_t>(half & 0x8000) << 16);
}

std::size_t receivers_of(std::size_t numbers, std::size_t dimension) {
    return dimension == 0 ? 0 : numbers / dimension;
}

} // namespace

std::size_t StoredTransfer::receivers() const {
    return receivers_of(floats.size() + halves.size(), layout.dimension());
}

TransferView::TransferView(TransferLayout layout, std::size_t receivers, Read read)
    : layout_(std::move(layout)), dimension_(layout_.dimension()), receivers_(receivers),
      read_(std::move(read)) {}

TransferView::TransferView(const Transfer& transfer)
    : TransferView(transfer.layout, transfer.receivers(),
                   [&from = transfer.vectors, dimension = transfer.dimension()](std::size_t first,
                                                                                std::span<float> to) {
                       std::ranges::copy(std::span(from).subspan(first * dimension, to.size()), to.begin());
                   }) {}

TransferView::TransferView(const StoredTransfer& transfer)
    : TransferView(
          transfer.layout, transfer.receivers(),
          [&transfer, dimension = transfer.layout.dimension()](std::size_t first, std::span<float> to) {
              if (transfer.halves.empty())
                  std::ranges::copy(std::span(transfer.floats).subspan(first * dimension, to.size()),
                                    to.begin());
              else
                  std::ranges::transform(std::span(transfer.halves).subspan(first * dimension, to.size()),
                                         to.begin(), float_of_half);
          }) {}

TransferView::TransferView(const ClusteredTransfer& transfer)
    : TransferView(transfer.bases.layout, transfer.receivers.size(),
                   [vectors = std::make_shared<const ClusteredVectors>(transfer)](
                       std::size_t first, std::span<float> to) { vectors->read(first, to); }) {}

TransferView in_order(TransferView transfer, std::vector<std::uint32_t> order) {
    TransferLayout layout = transfer.layout();
    const std::size_t receivers = order.size();
    return {std::move(layout), receivers,
            [from = std::move(transfer), order = std::make_shared<const std::vector<std::uint32_t>>(
                                             std::move(order))](std::size_t first, std::span<float> to) {
                for (; !to.empty(); to = to.subspan(from.dimension()))
                    from.read((*order)[first++], to.first(from.dimension()));
            }};
}

} // namespace prt
