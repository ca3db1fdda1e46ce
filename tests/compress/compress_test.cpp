// Tests the compressor: errors, sizes, edge cases and limits.

#include "prt/compress/compress.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace prt {
namespace {

Transfer random_transfer(std::size_t receivers, int order, int channels, unsigned seed) {
    Transfer t{layout_of_one(order, channels), {}};
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    t.vectors.resize(receivers * t.dimension());
    for (float& v : t.vectors)
        v = normal(random);
    return t;
}

/// Points on `clusters` affine subspaces of `rank` dimensions, far from each other.
Transfer synthetic(std::size_t receivers, std::size_t clusters, std::size_t rank,
                   std::vector<std::size_t>& truth) {
    const Transfer bases = random_transfer(clusters * (rank + 1), 4, 1, 11);
    Transfer t = zero_transfer(4, 1, receivers);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-0.3f, 0.3f);
    for (std::size_t p = 0; p < receivers; ++p) {
        const std::size_t k = p % clusters;
        truth.push_back(k);
        for (std::size_t i = 0; i < t.dimension(); ++i)
            t.vector(p)[i] = 10 * bases.vector(k * (rank + 1))[i];
        for (std::size_t j = 0; j < rank; ++j) {
            const float weight = uniform(random);
            for (std::size_t i = 0; i < t.dimension(); ++i)
                t.vector(p)[i] += weight * bases.vector(k * (rank + 1) + 1 + j)[i];
        }
    }
    return t;
}

CompressResult run(const Transfer& t, int clusters, int components,
                   WeightFormat format = WeightFormat::float32, int threads = 0) {
    CompressOptions options;
    options.clusters = clusters;
    options.coding.components = components;
    options.coding.format = format;
    options.threads = threads;
    options.metric = plain_metric(t.layout);
    return compress(t, {std::vector<float>(t.receivers(), 1.0f)}, options);
}

double error_of(const Transfer& t, const CompressResult& result) {
    return relative_l2(t, decode(result.transfer), std::vector<float>(t.receivers(), 1.0f));
}

TEST(Compress, ErrorNeverIncreasesOverIterations) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        const auto errors =
            run(random_transfer(600, 4, seed == 3 ? 3 : 1, seed), 8, 4).statistics.lit_rms_by_iteration;
        ASSERT_GT(errors.size(), 1u);
        for (std::size_t i = 1; i < errors.size(); ++i)
            EXPECT_LE(errors[i], errors[i - 1]);
    }
}

TEST(Compress, ReportsTheErrorOfTheDecodedResult) {
    const Transfer t = random_transfer(500, 4, 1, 4);
    const CompressResult result = run(t, 8, 4);
    EXPECT_NEAR(result.statistics.lit_rms, error_of(t, result), 1e-6); // the plain metric is relative L2
    EXPECT_GE(result.statistics.lit_rms_by_iteration.back() + 1e-6, error_of(t, result)); // moves may follow
}

TEST(Compress, RecoversKnownClustersAndTheirRank) {
    std::vector<std::size_t> truth;
    const Transfer t = synthetic(900, 6, 3, truth);
    const CompressResult result = run(t, 6, 3);
    EXPECT_LT(error_of(t, result), 1e-6);
    std::set<std::pair<std::size_t, std::uint16_t>> pairs;
    for (std::size_t p = 0; p < truth.size(); ++p)
        pairs.insert({truth[p], static_cast<std::uint16_t>(result.transfer.receivers.cluster(p))});
    EXPECT_EQ(pairs.size(), 6u); // a bijection
}

TEST(Compress, ErrorIsZeroWhenComponentsReachTheRank) {
    const Transfer t = random_transfer(300, 3, 1, 8);
    EXPECT_LT(error_of(t, run(t, 1, 9)), 1e-6); // one component per dimension
    std::vector<std::size_t> truth;
    const Transfer low_rank = synthetic(400, 1, 5, truth);
    const CompressResult result = run(low_rank, 1, 16);
    EXPECT_LT(error_of(low_rank, result), 1e-6);
    EXPECT_EQ(result.transfer.bases.max_components(), 5); // and it keeps no more than there are
}

TEST(Compress, DirectionsAreOrthogonalInTheMetric) {
    const Transfer t = random_transfer(400, 4, 3, 9);
    CompressOptions options;
    options.clusters = 4;
    options.coding.components = 6;
    options.coding.format = WeightFormat::float32;
    const LightMetric metric = natural_metric(layout_of_one(4, 3));
    options.metric = metric;
    const CompressResult result = compress(t, {std::vector<float>(400, 1.0f)}, options);
    const ClusteredBases& b = result.transfer.bases;
    const auto product = [&](std::size_t row, std::size_t other) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 16; ++i)
                sum += metric.moments[(c * 16 + i) * (48 + 1)] *
                       static_cast<double>(b.rows[row * 48 + c * 16 + i]) *
                       static_cast<double>(b.rows[other * 48 + c * 16 + i]);
        return sum;
    };
    const auto first = b.first_rows();
    const double length = product(first[0] + 1, first[0] + 1);
    for (std::size_t k = 0; k < b.clusters(); ++k)
        for (std::size_t i = 1; i <= static_cast<std::size_t>(b.components[k]); ++i)
            for (std::size_t j = 1; j <= i; ++j)
                EXPECT_NEAR(product(first[k] + i, first[k] + j) / length, i == j ? 1 : 0, 1e-5);
}

TEST(Compress, MoreClustersOrComponentsDoNotHurtAndQuantizationCostsLittle) {
    std::vector<std::size_t> truth;
    Transfer t = synthetic(1500, 20, 6, truth);
    const Transfer noise = random_transfer(1500, 4, 1, 77);
    for (std::size_t i = 0; i < t.vectors.size(); ++i)
        t.vectors[i] += 0.02f * noise.vectors[i];
    double before = 1;
    for (const int components : {0, 1, 2, 4, 8, 16}) {
        const double error = error_of(t, run(t, 16, components));
        EXPECT_LT(error, before);
        before = error;
    }
    const auto error_in_bits = [&](int bits) {
        CompressOptions options;
        options.clusters = 16;
        options.coding.components = 4;
        options.coding.bits = bits;
        options.basis_share = 0;
        options.metric = plain_metric(t.layout);
        return error_of(t, compress(t, {std::vector<float>(t.receivers(), 1.0f)}, options));
    };
    const double exact = error_of(t, run(t, 16, 4));
    EXPECT_NEAR(error_in_bits(4 * 16), exact, 1e-4 * exact);
    EXPECT_LT(error_in_bits(4 * 8), 1.05 * exact);
}

TEST(Compress, QuantisationErrorIsHalfAStepAtMost) {
    std::vector<std::size_t> truth;
    const Transfer t = synthetic(500, 3, 2, truth); // exact except for the rounding of weights
    CompressOptions options;
    options.clusters = 3;
    options.coding.fixed_bits = {8, 8};
    options.basis_share = 0;
    options.metric = plain_metric(layout_of_one(4, 1));
    const CompressResult result = compress(t, {std::vector<float>(500, 1.0f)}, options);
    const Transfer decoded = decode(result.transfer);
    const ClusteredBases& b = result.transfer.bases;
    double largest = 0; // a row is a weight of 1
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 1; j <= static_cast<std::size_t>(b.components[k]); ++j) {
            double squared = 0;
            for (std::size_t i = 0; i < 16; ++i)
                squared += std::pow(static_cast<double>(b.rows[(b.first_rows()[k] + j) * 16 + i]), 2);
            largest = std::max(largest, std::sqrt(squared));
        }
    for (std::size_t p = 0; p < t.receivers(); ++p) {
        double squared = 0;
        for (std::size_t i = 0; i < t.dimension(); ++i)
            squared += std::pow(static_cast<double>(t.vector(p)[i] - decoded.vector(p)[i]), 2);
        // Two weights, half a step each; refitted rows are not quite orthogonal, which 1.2 allows for.
        EXPECT_LT(std::sqrt(squared), 1.2 * std::sqrt(2.0) / 255 * largest + 1e-4);
    }
}

TEST(Compress, EveryFormatIsIndependentOfThreads) {
    const Transfer t = random_transfer(700, 4, 1, 22);
    std::vector<Edge> edges;
    for (std::uint32_t p = 1; p < 700; ++p)
        edges.push_back({p - 1, p});
    for (const WeightFormat format : {WeightFormat::packed, WeightFormat::float32}) {
        std::vector<ClusteredTransfer> results;
        for (const int threads : {1, 2, 5}) {
            CompressOptions options;
            options.clusters = 20;
            options.mean_components = format == WeightFormat::packed ? 0 : 3;
            options.coding.format = format;
            options.seam_weight = 1;
            options.threads = threads;
            results.push_back(compress(t, {std::vector<float>(700, 1.0f), edges}, options).transfer);
            EXPECT_EQ(results.back().bases.rows, results.front().bases.rows);
            EXPECT_EQ(results.back().bases.coded.values.bits, results.front().bases.coded.values.bits);
            EXPECT_EQ(results.back().receivers.weights, results.front().receivers.weights);
        }
    }
}

TEST(Compress, DoesNotDependOnThreads) {
    const Transfer t = random_transfer(1000, 5, 1, 21);
    const CompressResult one = run(t, 12, 5, WeightFormat::packed, 1);
    for (const int threads : {2, 5}) {
        const CompressResult other = run(t, 12, 5, WeightFormat::packed, threads);
        EXPECT_EQ(one.transfer.bases.rows, other.transfer.bases.rows);
        EXPECT_EQ(one.transfer.receivers.weights, other.transfer.receivers.weights);
    }
}

TEST(HardCase, OneReceiver) {
    const Transfer t = random_transfer(1, 3, 1, 1);
    const CompressResult result = run(t, 8, 4, WeightFormat::packed);
    EXPECT_EQ(result.transfer.bases.clusters(), 1u);
    EXPECT_LT(error_of(t, result), 1e-6);
}

TEST(HardCase, IdenticalReceiversNeedOneClusterAndNoComponents) {
    Transfer t = random_transfer(1, 3, 1, 1);
    const std::vector<float> one = t.vectors;
    for (int i = 0; i < 99; ++i)
        t.vectors.insert(t.vectors.end(), one.begin(), one.end());
    const CompressResult result = run(t, 8, 4);
    EXPECT_EQ(result.transfer.bases.clusters(), 1u);
    EXPECT_EQ(result.transfer.bases.max_components(), 0);
    EXPECT_LT(error_of(t, result), 1e-6);
}

TEST(HardCase, MoreClustersThanReceivers) {
    const Transfer t = random_transfer(5, 3, 1, 1);
    const CompressResult result = run(t, 64, 3);
    EXPECT_LE(result.transfer.bases.clusters(), 5u);
    EXPECT_LT(error_of(t, result), 1e-6);
}

TEST(HardCase, FewerMembersThanComponents) {
    const Transfer t = random_transfer(40, 4, 1, 6);
    const CompressResult result = run(t, 20, 16);
    EXPECT_LT(error_of(t, result), 1e-6);
}

TEST(HardCase, ZeroTransferStaysZero) {
    const Transfer t = zero_transfer(4, 1, 100);
    const CompressResult result = run(t, 4, 4, WeightFormat::packed);
    EXPECT_EQ(error_of(t, result), 0);
    for (const float v : decode(result.transfer).vectors)
        EXPECT_EQ(v, 0);
}

TEST(HardCase, HugeOutliersAreKeptWithoutHarm) {
    std::vector<std::size_t> truth;
    Transfer t = synthetic(300, 3, 2, truth);
    for (float& v : t.vector(17))
        v *= 1e6f;
    const CompressResult result = run(t, 4, 2);
    EXPECT_LT(error_of(t, result), 1e-5);
    const Transfer decoded = decode(result.transfer);
    for (const std::size_t p : {0u, 1u, 2u, 100u})
        for (std::size_t i = 0; i < t.dimension(); ++i)
            EXPECT_NEAR(decoded.vector(p)[i], t.vector(p)[i], 1e-3f);
}

TEST(HardCase, NegligibleAxesAreOmitted) {
    Transfer t = zero_transfer(3, 1, 3);
    t.vector(0)[1] = -256;
    t.vector(1)[3] = 1.4e-5f;
    t.vector(2)[5] = 8.5e-4f;
    CompressOptions options;
    options.seam_weight = 1;
    const std::vector<Edge> edges = {{0, 1}, {1, 2}};
    const CompressResult result = compress(t, {std::vector<float>(3, 1.0f), edges}, options);
    EXPECT_LT(error_of(t, result), 1e-3);
    EXPECT_LE(result.transfer.bases.coded.scales.size(), 2u);
}

TEST(HardCase, NearZeroCovarianceIsRoundingAndNotADirection) {
    Transfer t = random_transfer(1, 3, 1, 2);
    const std::vector<float> one = t.vectors;
    for (int i = 0; i < 50; ++i)
        for (const float v : one)
            t.vectors.push_back(i % 2 ? v : std::nextafter(v, 2 * v));
    const CompressResult result = run(t, 1, 4, WeightFormat::packed);
    EXPECT_LT(error_of(t, result), 2e-7);
}

TEST(HardCase, ReceiversWithoutAreaDoNotCountButAreCoded) {
    std::vector<std::size_t> truth;
    Transfer t = synthetic(200, 2, 2, truth);
    const Transfer noise = random_transfer(200, 4, 1, 3);
    std::vector<float> areas(200, 1.0f);
    for (std::size_t p = 0; p < 200; p += 5) {
        areas[p] = 0;
        std::copy(noise.vector(p).begin(), noise.vector(p).end(), t.vector(p).begin());
    }
    CompressOptions options;
    options.clusters = 2;
    options.coding.components = 2;
    options.coding.format = WeightFormat::float32;
    const CompressResult result = compress(t, {areas}, options);
    EXPECT_LT(relative_l2(t, decode(result.transfer), areas), 1e-6);
    EXPECT_EQ(result.transfer.receivers.size(), 200u);
    const CompressResult nobody =
        compress(t, {std::vector<float>(200, 0.0f)}, options); // all receivers then have equal weight
    EXPECT_EQ(nobody.transfer.receivers.size(), 200u);
}

/// Tests the longest possible vectors, without an axis to omit.
TEST(Compress, AcceptsColoredTermsOfOrderTenWithAllLamps) {
    TransferLayout layout{10, {{TermKind::direct, 3}, {TermKind::indirect, 3}}};
    for (std::size_t k = 0; k < kMaxLamps; ++k)
        layout.terms.push_back({TermKind::lamp, 3, "lamp " + std::to_string(k)});
    Transfer t = zero_transfer(layout, 840);
    ASSERT_EQ(t.dimension(), kMaxTransferNumbers);
    std::mt19937 random(21);
    std::normal_distribution<float> normal;
    for (float& v : t.vectors)
        v = normal(random);
    CompressOptions options;
    options.clusters = 1;
    options.coding.components = 1;
    options.coding.format = WeightFormat::packed;
    options.coding.bits = 5;
    options.metric = plain_metric(t.layout);
    const CompressResult result = compress(t, {std::vector<float>(840, 1.0f)}, options);
    // Noise can hardly be compressed, and its error is counted once.
    EXPECT_GT(result.statistics.lit_rms, 0.9);
    EXPECT_LT(result.statistics.lit_rms, 1.01);
}

/// Returns a floor under three lamps, the first 0.1 m above it: light falls from 1 to 1e-5 of the maximum, as
/// (h / r)^3. The sky is nearly uniform.
Transfer lit_floor(std::size_t side) {
    TransferLayout layout{2, {{TermKind::combined, 1}}};
    for (const char* name : {"near", "far", "red"})
        layout.terms.push_back({TermKind::lamp, name == std::string("red") ? 3 : 1, name});
    Transfer t = zero_transfer(layout, side * side);
    for (std::size_t p = 0; p < t.receivers(); ++p) {
        const float x = 4 * static_cast<float>(p % side) / static_cast<float>(side),
                    z = 4 * static_cast<float>(p / side) / static_cast<float>(side);
        const auto from = [&](float h, float lamp_x, float lamp_z) {
            const float square = h * h + (x - lamp_x) * (x - lamp_x) + (z - lamp_z) * (z - lamp_z);
            return h / (square * std::sqrt(square));
        };
        const std::span<float> vector = t.vector(p);
        vector[0] = 0.8f + 0.1f * std::sin(x + z);
        vector[2] = 0.3f;
        vector[4] = from(0.06f, 0.5f, 0.5f);
        vector[5] = from(1.5f, 2, 3);
        for (std::size_t c = 0; c < 3; ++c)
            vector[6 + c] = (c == 0 ? 1.0f : 0.1f) * from(0.1f, 3.5f, 2);
    }
    return t;
}

TEST(Compress, KeepsFaintLightOfLampsFarBelowTheirBrightest) {
    const Transfer t = lit_floor(48);
    CompressOptions options;
    options.clusters = 96;
    options.coding = preset_u32();
    options.predictors = PredictorChoice::none;
    const std::vector<float> areas(t.receivers(), 1.0f);
    const CompressResult result = compress(t, {areas}, options);
    const Transfer decoded = decode(result.transfer);
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        Lighting lighting{constant_light(2, glm::vec3(0))};
        lighting.lamps.assign(3, glm::vec3(0));
        lighting.lamps[k] = glm::vec3(1);
        const LitError error =
            lit_error(exit_radiance(t, lighting), exit_radiance(decoded, lighting), areas, {}, std::nullopt);
        EXPECT_LT(error.visible.percentile_95, 0.12)
            << k; // 1.0 and 0.5 if errors have equal weight everywhere
        EXPECT_LT(error.rms, 0.05) << k;
        squares += error.visible.rms * error.visible.rms / 3;
    }
    EXPECT_NEAR(result.statistics.lamp_contrast, std::sqrt(squares), 1e-4);
    EXPECT_EQ(result.statistics.error(),
              std::max(result.statistics.lit_rms, result.statistics.lamp_contrast));
}

TEST(Compress, RejectsUnsupportedOptions) {
    Transfer t = random_transfer(10, 3, 1, 1);
    EXPECT_THROW(run(t, 0, 4), Error);
    EXPECT_THROW(run(t, 70000, 4), Error);
    EXPECT_THROW(run(t, 4, -1), Error);
    t.vectors[7] = std::nanf("");
    EXPECT_THROW(run(t, 4, 4), Error);
    EXPECT_THROW(run(zero_transfer(3, 1, 0), 4, 4), Error);
    const Transfer fine = random_transfer(10, 3, 1, 1);
    const std::vector<float> areas(10, 1.0f);
    const auto refused = [&](auto&& change) {
        CompressOptions options;
        change(options);
        EXPECT_THROW(compress(fine, {areas}, options), Error);
    };
    refused([](CompressOptions& o) { o.coding.bits = 241; });
    refused([](CompressOptions& o) { o.coding.bits = -1; });
    refused([](CompressOptions& o) { o.coding.fixed_bits = {17}; });
    refused([](CompressOptions& o) { o.coding.fixed_bits = {0}; });
    refused([](CompressOptions& o) { o.coding.cluster_bits = 3; }); // 256 clusters
    refused([](CompressOptions& o) { o.seam_weight = -1; });
    refused([](CompressOptions& o) { o.seam_weight = std::nan(""); });
    refused([](CompressOptions& o) { o.mean_components = -2; });
    refused([](CompressOptions& o) { o.basis_share = 1; });
    refused([](CompressOptions& o) { o.metric = natural_metric(layout_of_one(4, 1)); });
    refused([](CompressOptions& o) { o.seam_weight = 2 * kMaxSeamWeight; });
    refused([](CompressOptions& o) { o.mean_components = std::numeric_limits<double>::infinity(); });
    const CompressOptions options;
    EXPECT_THROW(compress(fine, {std::vector<float>(9, 1.0f)}, options), Error);
}

TEST(Compress, RejectsInvalidAreasTransferAndEdges) {
    const Transfer fine = random_transfer(10, 3, 1, 1);
    const std::vector<float> ones(10, 1.0f);
    // for example of triangles whose corners overflow floats
    for (const float area : {std::nanf(""), INFINITY}) {
        std::vector<float> areas = ones;
        areas[4] = area;
        EXPECT_THROW(compress(fine, {areas}, {}), Error) << area;
    }
    for (const float value : {INFINITY, -3e38f}) {
        Transfer t = fine;
        t.vectors[7] = value;
        EXPECT_THROW(compress(t, {ones}, {}), Error) << value;
    }
    for (const Edge edge : {Edge{0, 10}, Edge{4000000000u, 1}})
        EXPECT_THROW(compress(fine, {ones, std::vector{edge}}, {}), Error) << edge.first;
}

TEST(Compress, IsFiniteForTheLargestTransferAndAreas) {
    Transfer t = random_transfer(40, 3, 1, 1);
    const auto expect_finite = [](const CompressResult& result) {
        EXPECT_TRUE(std::isfinite(result.statistics.lit_rms));
        for (const float v : decode(result.transfer).vectors)
            EXPECT_TRUE(std::isfinite(v));
    };
    expect_finite(compress(t, {std::vector<float>(40, 3e38f)}, {}));
    expect_finite(compress(t, {std::vector<float>(40, 1e-45f)}, {}));
    expect_finite(compress(t, {std::vector<float>(40, 0.0f), std::vector{Edge{0, 1}}}, {}));
    t.vectors[7] = kMaxInputTransfer;
    t.vectors[50] = -kMaxInputTransfer;
    expect_finite(compress(t, {std::vector<float>(40, 1.0f), std::vector{Edge{0, 1}}}, {}));
}

TEST(Compress, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    CompressOptions options;
    const Transfer t = random_transfer(100, 3, 1, 1);
    EXPECT_THROW(compress(t, {std::vector<float>(100, 1.0f)}, options, {{}, stop.get_token()}), Cancelled);
}

} // namespace
} // namespace prt
