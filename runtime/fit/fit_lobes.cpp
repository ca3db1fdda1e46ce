// Fits zonal lobes to one vertex by nonlinear least squares (Ceres): axes on the sphere, and a gain for each
// band of each lobe. Sloan, Luna and Snyder 2005 minimise the same function with equal band weights.

#include "prt/fit/lobe_fit.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/parallel.h"
#include "runtime/fit/lobe_profiles.h"
#include "runtime/fit/lobe_start.h"
#include "runtime/fit/sh_gradient.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace prt {
namespace {

/// Regularisation of gains relative to the band weight. Superfluous lobes get zero gain, instead of gains
/// that cancel. At a ten-thousandth of a cosine lobe's amplitude it costs 1e-7 of the lobe.
constexpr double kMinCost = 1e-8;

/// Residuals: first the coefficients, then the gains. Parameters: an axis and the gains of each lobe in turn.
class LobeCost : public ceres::CostFunction {
public:
    LobeCost(int order, std::span<const double> target, const LobeFitOptions& options)
        : order_(order), lobes_(static_cast<int>(options.lobes)), target_(target) {
        for (std::size_t l = 0; l < weights_.size(); ++l)
            weights_[l] = std::sqrt(options.band_costs[l]);
        set_num_residuals(order * order + lobes_ * order);
        for (int k = 0; k < lobes_; ++k) {
            mutable_parameter_block_sizes()->push_back(3);
            mutable_parameter_block_sizes()->push_back(order);
        }
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const int coefficients = order_ * order_;
        for (int i = 0; i < coefficients; ++i)
            residuals[i] = -weight_of(i) * target_[static_cast<std::size_t>(i)];
        for (int k = 0; k < lobes_; ++k) {
            const double* axis = parameters[2 * k];
            const double* gains = parameters[2 * k + 1];
            std::array<double, kMaxLobeOrder * kMaxLobeOrder> basis{};
            const glm::dvec3 towards(axis[0], axis[1], axis[2]);
            evaluate_sh(order_, towards, std::span(basis).first(static_cast<std::size_t>(coefficients)));
            for (int i = 0; i < coefficients; ++i)
                residuals[i] += weight_of(i) * gains[band_of(i)] * basis[static_cast<std::size_t>(i)];
            for (int l = 0; l < order_; ++l)
                residuals[coefficients + k * order_ + l] = cost_of_gain(l) * gains[l];
            if (jacobians && jacobians[2 * k])
                write_axis(towards, gains, jacobians[2 * k]);
            if (jacobians && jacobians[2 * k + 1])
                write_gains(k, basis, jacobians[2 * k + 1]);
        }
        return true;
    }

private:
    static int band_of(int i) { return i < 1 ? 0 : i < 4 ? 1 : i < 9 ? 2 : 3; }
    double weight_of(int i) const { return weights_[static_cast<std::size_t>(band_of(i))]; }
    double cost_of_gain(int l) const { return std::sqrt(kMinCost) * weights_[static_cast<std::size_t>(l)]; }
    void write_axis(const glm::dvec3& towards, const double* gains, double* jacobian) const {
        std::fill_n(jacobian, 3 * num_residuals(), 0.0);
        const auto gradients = sh_gradients(towards);
        for (int i = 0; i < order_ * order_; ++i)
            for (int a = 0; a < 3; ++a)
                jacobian[3 * i + a] =
                    weight_of(i) * gains[band_of(i)] * gradients[static_cast<std::size_t>(i)][a];
    }
    void write_gains(int k, std::span<const double> basis, double* jacobian) const {
        std::fill_n(jacobian, order_ * num_residuals(), 0.0);
        const int coefficients = order_ * order_;
        for (int i = 0; i < coefficients; ++i)
            jacobian[order_ * i + band_of(i)] = weight_of(i) * basis[static_cast<std::size_t>(i)];
        for (int l = 0; l < order_; ++l)
            jacobian[order_ * (coefficients + k * order_ + l) + l] = cost_of_gain(l);
    }

    int order_, lobes_;
    std::span<const double> target_;
    std::array<double, kMaxLobeOrder> weights_{};
};

/// A lobe equals the lobe about the opposite axis with negated odd bands. Selects the axis that points
/// towards the incoming light, so that profiles are comparable.
void face_forward(FreeLobe& lobe) {
    if (lobe.profile[1] >= 0)
        return;
    lobe.axis = -lobe.axis;
    lobe.profile[1] *= -1;
    lobe.profile[3] *= -1;
}

void fit_vertex(int order, std::span<const double> target, const LobeFitOptions& options,
                std::span<Lobe> to) {
    std::array<FreeLobe, kMaxLobes> room;
    const std::span<FreeLobe> lobes = std::span(room).first(options.lobes);
    start_lobes(order, target, options, lobes);
    ceres::Problem problem;
    std::vector<double*> blocks;
    for (FreeLobe& lobe : lobes) {
        blocks.push_back(&lobe.axis.x);
        blocks.push_back(lobe.profile.data());
    }
    problem.AddResidualBlock(std::make_unique<LobeCost>(order, target, options).release(), nullptr, blocks);
    for (FreeLobe& lobe : lobes)
        problem.SetManifold(&lobe.axis.x, std::make_unique<ceres::SphereManifold<3>>().release());
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.logging_type = ceres::SILENT;
    solver.max_num_iterations = 40;
    solver.function_tolerance = 1e-8;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary); // on failure the start values remain
    for (std::size_t k = 0; k < lobes.size(); ++k) {
        face_forward(lobes[k]);
        to[k] = {glm::vec3(lobes[k].axis), {}};
        for (std::size_t l = 0; l < static_cast<std::size_t>(order); ++l)
            to[k].profile[l] = static_cast<float>(lobes[k].profile[l]);
    }
}

} // namespace

void check_targets(const LobeTargets& targets, const LobeFitOptions& options) {
    if (targets.order < 2 || targets.order > kMaxLobeOrder || options.lobes < 1 ||
        options.lobes > kMaxLobes || options.profiles < 1 || options.profiles > kMaxProfiles)
        throw Error("lobes must have order 2..4, with 1..3 lobes per vertex and 1..256 profiles");
    if (targets.vectors.size() != targets.areas.size() * targets.coefficients())
        throw Error("the numbers of transfer vectors and areas differ");
    if (!std::ranges::all_of(targets.vectors, [](double v) { return std::isfinite(v); }))
        throw Error("lobes cannot be fitted: the transfer is not finite");
}

std::vector<Lobe> fit_lobes(const LobeTargets& targets, const LobeFitOptions& options,
                            const Progress& progress) {
    check_targets(targets, options);
    const std::size_t vertices = targets.areas.size();
    std::vector<Lobe> lobes(vertices * options.lobes);
    constexpr std::size_t kBlock = 2048; // vertices between two progress updates
    for (std::size_t first = 0; first < vertices; first += kBlock) {
        progress.update(static_cast<double>(first) / static_cast<double>(vertices));
        parallel_for(std::min(kBlock, vertices - first), 32, options.threads,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t v = first + begin; v < first + end; ++v)
                             fit_vertex(targets.order, targets.vector(v), options,
                                        std::span(lobes).subspan(v * options.lobes, options.lobes));
                     });
    }
    return lobes;
}

double lobe_error(const LobeTargets& targets, std::span<const Lobe> lobes, const LobeFitOptions& options) {
    check_targets(targets, options);
    double error = 0, norm = 0;
    std::vector<float> found(targets.coefficients());
    for (std::size_t v = 0; v < targets.areas.size(); ++v) {
        lobe_transfer(lobes.subspan(v * options.lobes, options.lobes), targets.order, found);
        const std::span<const double> target = targets.vector(v);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double cost = static_cast<double>(targets.areas[v]) * options.band_costs[i < 1   ? 0
                                                                                           : i < 4 ? 1
                                                                                           : i < 9 ? 2
                                                                                                   : 3];
            error += cost * (target[i] - static_cast<double>(found[i])) *
                     (target[i] - static_cast<double>(found[i]));
            norm += cost * target[i] * target[i];
        }
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

std::vector<Lobe> decoded(const LobeModel& model) {
    std::vector<Lobe> lobes(model.words.size());
    for (std::size_t v = 0; v < model.vertices(); ++v)
        model.decode(v, std::span(lobes).subspan(v * model.lobes, model.lobes));
    return lobes;
}

} // namespace prt
