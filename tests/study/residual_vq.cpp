// Residual vector quantisation: every codebook codes the residual of the previous ones (Chen, Guan and Wang
// 2010, "Approximate Nearest Neighbor Search by Residual Vector Quantization"), by faiss.

#include "residual_vq.h"

#include <faiss/impl/ResidualQuantizer.h>

#include <set>
#include <string>

namespace prt {
namespace {

constexpr std::size_t kRows = 256;
constexpr std::size_t kBytesOfValue = 2; // rows as float16, as for classic CPCA

BaselineResult residual_vq(const Transfer& transfer, std::size_t codebooks, std::uint64_t seed) {
    const std::size_t dimension = transfer.dimension(), receivers = transfer.receivers();
    faiss::ResidualQuantizer quantizer(dimension, codebooks, 8);
    quantizer.cp.seed = static_cast<int>(seed);
    quantizer.train_type = faiss::ResidualQuantizer::Train_default; // minutes less than by growing dimensions
    quantizer.cp.min_points_per_centroid = 1;                       // avoids a warning for small meshes
    quantizer.train(receivers, transfer.vectors.data());
    std::vector<std::uint8_t> codes(receivers * quantizer.code_size);
    quantizer.compute_codes(transfer.vectors.data(), codes.data(), receivers);

    BaselineResult result;
    result.decoded = transfer;
    quantizer.decode(codes.data(), result.decoded.vectors.data(), receivers);
    result.payload_bytes = bound_bytes(codebooks);
    result.table_bytes = static_cast<double>(codebooks * kRows * dimension * kBytesOfValue);
    result.mean_components = static_cast<double>(codebooks);
    return result;
}

} // namespace

std::vector<SweepCandidate> residual_vq_candidates(const Transfer& transfer, std::uint64_t seed) {
    std::vector<SweepCandidate> candidates;
    if (transfer.receivers() < kRows)
        return candidates;
    const double bytes_of_rows = static_cast<double>(kRows * transfer.dimension() * kBytesOfValue) /
                                 static_cast<double>(transfer.receivers());
    std::set<std::size_t> sizes;
    for (const double bytes : kSweepBytes) {
        std::size_t codebooks = 1;
        while (bound_bytes(codebooks + 1) + static_cast<double>(codebooks + 1) * bytes_of_rows <= bytes)
            ++codebooks;
        sizes.insert(codebooks);
    }
    for (const std::size_t codebooks : sizes)
        candidates.push_back({"residual VQ", [&transfer, codebooks, seed](const Progress&) {
                                  return CandidateResult{std::to_string(codebooks) + " x 256",
                                                         residual_vq(transfer, codebooks, seed)};
                              }});
    return candidates;
}

} // namespace prt
