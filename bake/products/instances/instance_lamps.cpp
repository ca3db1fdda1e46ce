// Fits the incident light of lamps at instances to the light of their vertices.

#include "bake/products/instances/instance_lamps.h"

#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <utility>

namespace prt {
namespace {

constexpr std::size_t kUnknowns = 4 * kInstanceLampFunctions; ///< of one color
/// Weight of zero light, relative to the mean diagonal of the normal matrix, so that functions that no vertex
/// sees stay small in bytes. Errors of spheres, knots and trees differ by less than 2 % with 1e-5 and 1e-3;
/// with 1e-2 they are 3 to 8 % larger.
constexpr double kLampRidge = 1e-4;

using LampMatrix = Eigen::MatrixXd;
using LampVector = Eigen::Matrix<double, kUnknowns, 1>;

/// The linear map from the light of a lamp to the exit radiance of the vertices of a mesh.
class MeshResponse {
public:
    MeshResponse(const SharedMeshBake& mesh, int direct_channels)
        : shared_(stored_transfer(mesh, direct_channels), glm::dvec3(0, 1, 0)) {
        for (std::size_t r = 0; r < shared_.receivers(); ++r) {
            areas_.push_back(static_cast<double>(mesh.receivers().areas[r]));
            positions_.push_back(mesh.position_of(r));
        }
        for (int c = 0; c < 3; ++c) {
            LampMatrix normal = LampMatrix::Zero(kUnknowns, kUnknowns);
            for (std::size_t r = 0; r < vertices(); ++r) {
                const LampVector row = row_of(r, c);
                normal.selfadjointView<Eigen::Lower>().rankUpdate(row, areas_[r]);
            }
            const double mean = normal.trace() / kUnknowns;
            normal.diagonal().array() += kLampRidge * mean + 1e-30;
            solvers_[static_cast<std::size_t>(c)].compute(normal);
        }
    }

    std::size_t vertices() const { return areas_.size(); }
    double area(std::size_t vertex) const { return areas_[vertex]; }

    /// Returns the light that gives `radiance(vertex)`, a color.
    template <class Radiance>
    InstanceLampLight fit(const Radiance& radiance) const {
        std::array<LampVector, 3> right;
        right.fill(LampVector::Zero());
        for (std::size_t r = 0; r < vertices(); ++r) {
            const glm::vec3 color = radiance(r);
            if (color == glm::vec3(0))
                continue;
            for (int c = 0; c < 3; ++c)
                right[static_cast<std::size_t>(c)] +=
                    areas_[r] * static_cast<double>(color[c]) * row_of(r, c);
        }
        InstanceLampLight light;
        for (std::size_t c = 0; c < 3; ++c) {
            const LampVector found = solvers_[c].solve(right[c]);
            for (std::size_t i = 0; i < kInstanceLampFunctions; ++i)
                for (int a = 0; a < 4; ++a)
                    light.functions[i][c][a] =
                        static_cast<float>(found[static_cast<Eigen::Index>(4 * i) + a]);
        }
        return decoded(coded(light)); // as in files
    }
    glm::vec3 radiance(std::size_t vertex, const InstanceLampLight& light) const {
        return shared_.lamp_radiance(vertex, light, positions_[vertex]);
    }

private:
    LampVector row_of(std::size_t vertex, int color) const {
        const glm::vec4 position(positions_[vertex], 1);
        LampVector row;
        for (std::size_t i = 0; i < kInstanceLampFunctions; ++i)
            for (int a = 0; a < 4; ++a)
                row[static_cast<Eigen::Index>(4 * i) + a] =
                    static_cast<double>(shared_.responses(vertex)[i][color] * position[a]);
        return row;
    }

    SharedTransfer shared_;
    std::vector<double> areas_;
    std::vector<glm::vec3> positions_;
    std::array<Eigen::LDLT<LampMatrix>, 3> solvers_; ///< by color
};

/// Returns the color of lamp `lamp` in the numbers of all lamps of a receiver.
glm::vec3 color_of(std::span<const TransferTerm> terms, std::span<const float> numbers, std::size_t lamp) {
    std::size_t first = 0;
    for (std::size_t l = 0; l < lamp; ++l)
        first += static_cast<std::size_t>(terms[l].channels);
    return terms[lamp].channels == 1 ? glm::vec3(numbers[first])
                                     : glm::vec3(numbers[first], numbers[first + 1], numbers[first + 2]);
}

/// Fits all lamps at one instance, and measures the error of all of them together.
void fit_instance(InstanceLamps& lamps, const MeshResponse& mesh, const InstanceReceivers::Instance& instance,
                  std::size_t index) {
    const auto baked = [&](std::size_t vertex, std::size_t lamp) {
        return color_of(lamps.terms(), lamps.numbers(instance.receivers[vertex]), lamp);
    };
    std::vector<InstanceLampLight>& lights = lamps.lights[index];
    for (std::size_t l = 0; l < lamps.terms().size(); ++l)
        lights.push_back(mesh.fit([&](std::size_t vertex) { return baked(vertex, l); }));
    double wrong = 0, all = 0;
    for (std::size_t r = 0; r < mesh.vertices(); ++r) {
        glm::vec3 sum(0), difference(0);
        for (std::size_t l = 0; l < lights.size(); ++l) {
            const glm::vec3 color = baked(r, l);
            sum += color;
            difference += color - mesh.radiance(r, lights[l]);
        }
        wrong += mesh.area(r) * static_cast<double>(glm::dot(difference, difference));
        all += mesh.area(r) * static_cast<double>(glm::dot(sum, sum));
    }
    lamps.errors[index] = all > 0 ? std::sqrt(wrong / all) : 0;
}

} // namespace

std::shared_ptr<const BakeResult> bake_lamps(const Scene& scene, BakeOptions options,
                                             const Progress& progress) {
    options.order = 1; // the light of lamps has no bands
    return std::make_shared<const BakeResult>(bake(scene, options, progress));
}

InstanceLamps fit_instance_lamps(std::shared_ptr<const BakeResult> flat,
                                 const std::vector<SharedMeshBake>& meshes,
                                 const InstanceReceivers& receivers, int threads) {
    InstanceLamps lamps{std::move(flat), {}, {}};
    lamps.lights.resize(receivers.instances.size());
    lamps.errors.resize(receivers.instances.size());
    std::vector<MeshResponse> responses;
    for (const SharedMeshBake& mesh : meshes)
        responses.emplace_back(mesh, mesh.plan->direct_channels());
    parallel_for(receivers.instances.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            fit_instance(lamps, responses[receivers.instances[i].mesh], receivers.instances[i], i);
    });
    return lamps;
}

} // namespace prt
