// Fits a moving basis within a table size: with the finest grid that fits.

#include "moving_basis_baseline.h"

#include "compress/metric/significance.h"
#include "moving_basis_code.h"
#include "rounded_frame.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

using Index = Eigen::Index;

using Axes = Eigen::Map<const Eigen::MatrixXd>;

RowMatrix values_in(const Frame& frame, const Transfer& transfer, int threads) {
    const auto full = static_cast<Index>(frame.full()), kept = static_cast<Index>(frame.dimension);
    const Axes analysis(frame.analysis.data(), full, kept);
    const Eigen::Map<const Eigen::VectorXd> origin(frame.origin.data(), full);
    RowMatrix values(static_cast<Index>(transfer.receivers()), kept);
    parallel_for(transfer.receivers(), 256, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const Eigen::Map<const Eigen::VectorXf> vector(transfer.vector(p).data(), full);
            values.row(static_cast<Index>(p)) =
                (analysis.transpose() * (vector.cast<double>() - origin)).cast<float>().transpose();
        }
    });
    return values;
}

Transfer transfer_of(const RoundedFrame& frame, const RowMatrix& values, const TransferLayout& layout,
                     int threads) {
    Transfer transfer = zero_transfer(layout, static_cast<std::size_t>(values.rows()));
    const auto full = static_cast<Index>(frame.origin.size());
    const Axes synthesis(frame.synthesis.data(), full, values.cols());
    const Eigen::Map<const Eigen::VectorXd> origin(frame.origin.data(), full);
    parallel_for(transfer.receivers(), 256, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            Eigen::Map<Eigen::VectorXf>(transfer.vector(p).data(), full) =
                (origin + synthesis * values.row(static_cast<Index>(p)).transpose().cast<double>())
                    .cast<float>();
    });
    return transfer;
}

/// Returns the smallest cells that need at most this number of nodes; empty if one cell needs more.
std::optional<double> smallest_cells(std::span<const glm::vec3> positions, double nodes) {
    const auto needed = [&](double size) {
        return static_cast<double>(sparse_grid(positions, size).nodes.size());
    };
    double large = longest_edge(positions);
    if (!(large > 0))
        large = 1; // metre: all at one point
    if (needed(large) > nodes)
        return std::nullopt;
    const double least = large / 256; // Finer grids have more nodes than receivers.
    double small = large;
    while (needed(small) <= nodes && small > least) {
        large = small;
        small /= 2;
    }
    for (int step = 0; step < 8; ++step) {
        const double middle = std::sqrt(small * large);
        (needed(middle) <= nodes ? large : small) = middle;
    }
    return large;
}

/// Looks for the finest grid that keeps to the bytes.
class GridSearch {
public:
    GridSearch(const Transfer& transfer, const ReceiverSurface& surface, const MovingBasisOptions& options)
        : transfer_(transfer), surface_(surface), options_(options),
          significance_(significance_of(surface.areas)),
          whole_(fit_frame(transfer, significance_, options.metric, 0, options.threads)) {}

    std::optional<MovingBasisResult> run(const Progress& progress) {
        std::optional<MovingBasisResult> best;
        const double words =
            std::max(1.0, bound_bytes(static_cast<std::size_t>(options_.weight_bits) / 8) / 4);
        double dropped = tuning::kDroppedOfWord / (words * words), bits = tuning::kBitsOfNumber, least = 0;
        for (int round = 0; round < tuning::kGridTries; ++round) {
            progress.update(static_cast<double>(round) / tuning::kGridTries);
            const std::optional<Try> found =
                attempt(dropped, bits, round == 0 ? tuning::kRoundsOfTry : tuning::kRoundsOfGrid);
            if (!found)
                break;
            const bool fits = found->result.result.table_bytes <= options_.table_bytes;
            if (fits && (!best || found->error < least)) {
                best = found->result;
                least = found->error;
            }
            if (round > 0 && fits &&
                (!std::isfinite(options_.table_bytes) ||
                 found->result.result.table_bytes >= tuning::kGridFilled * options_.table_bytes))
                break;
            dropped = tuning::kShareOfAxes * found->error;
            bits = (fits ? 1 : tuning::kAfterTooMuch) * found->bits_of_number;
        }
        return best;
    }

private:
    struct Try {
        MovingBasisResult result;
        double error = 0;          ///< squared
        double bits_of_number = 0; ///< bits per number of the rows, including all tables
    };

    /// Fits with the minimum number of axes whose error is at most `dropped`, and with the maximum number of
    /// nodes at this number of bits per number; empty if not even one cell fits.
    std::optional<Try> attempt(double dropped, double bits, int rounds) {
        Frame frame = whole_;
        truncate(frame, axes_needed(whole_, dropped));
        const std::size_t components =
            std::min(static_cast<std::size_t>(options_.components), frame.dimension);
        const double numbers = static_cast<double>((1 + components) * frame.dimension),
                     room = numbers > 0 ? 8 * options_.table_bytes / (bits * numbers) : options_.table_bytes;
        const std::optional<double> size =
            smallest_cells(surface_.positions, std::min(room, static_cast<double>(options_.nodes)));
        if (!size)
            return std::nullopt;
        Try found;
        MovingBasisCode code;
        if (frame.dimension > 0) { // otherwise all receivers are equal, and the origin is sufficient
            const GridPoints points{values_in(frame, transfer_, options_.threads), significance_,
                                    surface_.positions, options_.threads};
            MovingBasisFit fit = fit_moving_basis(points, *size, components, {.rounds = rounds});
            found.result.nodes = fit.grid.nodes.size();
            code = code_moving_basis(points, std::move(fit), options_.weight_bits,
                                     std::isfinite(options_.table_bytes) ? tuning::kRowShare
                                                                         : tuning::kRowShareOfNodes);
        } else
            code.values.resize(eigen_index(transfer_.receivers()), 0);
        found.error = code.error + frame.dropped;
        const RoundedFrame axes = rounded(frame, options_.metric, tuning::kShareOfRoundedAxes * found.error);
        found.result.result = decoded(code, axes);
        found.bits_of_number = 8 * found.result.result.table_bytes /
                               std::max(1.0, numbers * static_cast<double>(found.result.nodes));
        return found;
    }

    BaselineResult decoded(const MovingBasisCode& code, const RoundedFrame& axes) const {
        BaselineResult result;
        result.decoded = transfer_of(axes, code.values, transfer_.layout, options_.threads);
        result.payload_bytes =
            code.components > 0 ? bound_bytes((static_cast<std::size_t>(options_.weight_bits) + 7) / 8) : 0;
        result.table_bytes = code.table_bytes + axes.bytes;
        result.mean_components = static_cast<double>(kCorners * (1 + code.components));
        return result;
    }

    const Transfer& transfer_;
    const ReceiverSurface& surface_;
    const MovingBasisOptions& options_;
    std::vector<float> significance_;
    Frame whole_;
};

} // namespace

std::optional<MovingBasisResult> moving_basis(const Transfer& transfer, const ReceiverSurface& surface,
                                              const MovingBasisOptions& options, const Progress& progress) {
    return GridSearch(transfer, surface, options).run(progress);
}

} // namespace prt
