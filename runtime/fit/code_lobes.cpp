// Codes lobes as words: axis, profile and factor of each lobe of a vertex are chosen in turn against the
// residual of the other lobes; then the profiles are refitted to the words.

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/parallel.h"
#include "runtime/fit/lobe_profiles.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

constexpr std::size_t kCoefficients = kMaxLobeOrder * kMaxLobeOrder;
constexpr int kSweeps = 3;            ///< passes over the lobes of a vertex in each round
constexpr int kAxisCodes = 255;       ///< per byte: 255 would be another code for 254
constexpr double kSteps = 255;        ///< steps of a factor
constexpr double kFurnace = 1 + 1e-6; ///< maximum sum of the gains of band 0, with tolerance for float
                                      ///< rounding of profiles

using Basis = std::array<float, kCoefficients>;
/// Residual of a vertex's target.
using Left = std::array<double, kCoefficients>;
constexpr std::array<std::size_t, kCoefficients> kBandOf = {0, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3};

/// SH basis for every axis that two bytes can represent.
class AxisTable {
public:
    AxisTable() : basis_(kAxisCodes * kAxisCodes) {
        for (int y = 0; y < kAxisCodes; ++y)
            for (int x = 0; x < kAxisCodes; ++x)
                evaluate_sh(kMaxLobeOrder,
                            decoded_axis(static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y)),
                            std::span(basis_[static_cast<std::size_t>(y * kAxisCodes + x)]));
    }
    const Basis& of(const LobeWord& word) const {
        return basis_[static_cast<std::size_t>(word[1]) * kAxisCodes + word[0]];
    }

private:
    std::vector<Basis> basis_;
};

/// Candidate word of a lobe, and the squared error that it removes.
struct Choice {
    LobeWord word{};
    double gain = -1;
};

class Coder {
public:
    Coder(const LobeTargets& targets, const LobeFitOptions& options, LobeModel& model)
        : targets_(targets), costs_(profile_costs(targets.order, options)), band_costs_(options.band_costs),
          model_(model) {}

    /// Computes the words of a vertex from the fitted lobes `near`; all lobes have factor 0 before.
    void encode(std::size_t vertex, std::span<const Lobe> near) {
        const std::span<LobeWord> words = words_of(vertex);
        for (std::size_t k = 0; k < words.size(); ++k) {
            const auto axis = coded_axis(near[k].axis);
            words[k] = {axis[0], axis[1], 0, 0};
        }
        improve(vertex);
    }

    /// Optimises each lobe against the others.
    void improve(std::size_t vertex) {
        const std::span<LobeWord> words = words_of(vertex);
        make_room(words);
        for (int sweep = 0; sweep < kSweeps; ++sweep)
            for (LobeWord& word : words)
                word = best(word, rest_of(vertex, word));
    }

    /// Refits each profile in turn by least squares over all vertices that use it; the first profile is
    /// fixed.
    void refit_profiles();
    void measure_profiles() {
        squares_.clear();
        for (const LobeProfile& profile : model_.profiles) {
            double sum = 0;
            for (std::size_t l = 0; l < profile.size(); ++l)
                sum += costs_[l] * static_cast<double>(profile[l] * profile[l]);
            squares_.push_back(sum);
        }
    }

private:
    /// Returns for each profile the vertices with a lobe that uses it.
    std::vector<std::vector<std::uint32_t>> users_of_profiles();
    /// Refits one profile against the residuals `left` [vertices] of all lobes, and updates them.
    void refit(std::size_t p, std::span<const std::uint32_t> users, std::span<Left> left);

    /// Residual of a vertex's target without one of its lobes.
    struct Rest {
        Left left{};
        double first_gains = 0; ///< sum of the band-0 gains of the other lobes
    };

    std::span<LobeWord> words_of(std::size_t vertex) {
        return std::span(model_.words).subspan(vertex * model_.lobes, model_.lobes);
    }
    double factor(const LobeWord& word) const { return static_cast<double>(word[3]) / kSteps; }
    double first_gain(const LobeWord& word) const {
        return factor(word) * static_cast<double>(model_.profiles[word[2]][0]);
    }
    void subtract(const LobeWord& word, std::span<double> from) const {
        const Basis& basis = axes_.of(word);
        const LobeProfile& profile = model_.profiles[word[2]];
        for (int l = 0, i = 0; l < targets_.order; ++l)
            for (int m = -l; m <= l; ++m, ++i)
                from[static_cast<std::size_t>(i)] -=
                    factor(word) * static_cast<double>(profile[static_cast<std::size_t>(l)] *
                                                       basis[static_cast<std::size_t>(i)]);
    }
    Rest rest_of(std::size_t vertex, const LobeWord& without) {
        Rest rest;
        std::ranges::copy(targets_.vector(vertex), rest.left.begin());
        for (const LobeWord& word : words_of(vertex))
            if (&word != &without) {
                subtract(word, rest.left);
                rest.first_gains += first_gain(word);
            }
        return rest;
    }

    /// Reduces the factors until the response to uniform light is at most 1.
    void make_room(std::span<LobeWord> words) const {
        double sum = 0;
        for (const LobeWord& word : words)
            sum += first_gain(word);
        for (LobeWord& word : words) {
            const double gain = first_gain(word);
            if (sum <= kFurnace || gain <= 0)
                continue;
            const double share = std::max(1 - (sum - 1) / gain, 0.0);
            word[3] = static_cast<std::uint8_t>(std::floor(word[3] * share));
            sum += first_gain(word) - gain;
        }
    }

    /// Tries profile `p` about `axis`. `found` is the residual along the axis per band, times the cost of the
    /// band.
    void ask(const LobeWord& axis, std::size_t p, std::span<const double> found, const Rest& rest,
             Choice& best) const {
        const LobeProfile& profile = model_.profiles[p];
        double along = 0;
        for (std::size_t l = 0; l < profile.size(); ++l)
            along += found[l] * static_cast<double>(profile[l]);
        const double square = squares_[p];
        if (!(along > 0) || along * along <= best.gain * square)
            return; // cannot be better with any factor
        double low = 0, high = kSteps;
        const double first = static_cast<double>(profile[0]), room = kFurnace - rest.first_gains;
        if (first > 0)
            high = std::min(high, std::floor(kSteps * room / first));
        else if (first < 0)
            low = std::max(low, std::ceil(kSteps * room / first));
        if (low > high || (first == 0 && room < 0))
            return;
        const double level = std::clamp(std::round(kSteps * along / square), low, high), s = level / kSteps;
        if (const double gain = s * (2 * along - s * square); gain > best.gain) {
            best.gain = gain;
            best.word = {axis[0], axis[1], static_cast<std::uint8_t>(p), static_cast<std::uint8_t>(level)};
        }
    }

    /// Returns the best word with an axis code equal or adjacent to the current one.
    LobeWord best(const LobeWord& now, const Rest& rest) const {
        Choice choice;
        for (int y = now[1] - 1; y <= now[1] + 1; ++y)
            for (int x = now[0] - 1; x <= now[0] + 1; ++x) {
                if (std::min(x, y) < 0 || std::max(x, y) >= kAxisCodes)
                    continue;
                const LobeWord axis = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0, 0};
                const Basis& basis = axes_.of(axis);
                std::array<double, kMaxLobeOrder> found{};
                for (int l = 0, i = 0; l < targets_.order; ++l) {
                    const auto band = static_cast<std::size_t>(l);
                    for (int m = -l; m <= l; ++m, ++i)
                        found[band] += rest.left[static_cast<std::size_t>(i)] *
                                       static_cast<double>(basis[static_cast<std::size_t>(i)]);
                    found[band] *= band_costs_[band];
                }
                for (std::size_t p = 0; p < model_.profiles.size(); ++p)
                    ask(axis, p, found, rest, choice);
            }
        // A lobe of factor 0 is the best if nothing improves on it, unless the others are too bright without
        // this lobe.
        return choice.gain > 0 || rest.first_gains > kFurnace ? kept(choice, now)
                                                              : LobeWord{now[0], now[1], 0, 0};
    }
    static LobeWord kept(const Choice& choice, const LobeWord& now) {
        return choice.gain > 0 ? choice.word : now;
    }

    const LobeTargets& targets_;
    const AxisTable axes_;
    std::array<double, kMaxLobeOrder> costs_, band_costs_;
    std::vector<double> squares_; ///< squared norm of each profile, weighted by the band costs
    LobeModel& model_;
};

std::vector<std::vector<std::uint32_t>> Coder::users_of_profiles() {
    std::vector<std::vector<std::uint32_t>> users(model_.profiles.size());
    for (std::size_t v = 0; v < model_.vertices(); ++v)
        for (const LobeWord& word : words_of(v))
            if (std::vector<std::uint32_t>& own = users[word[2]];
                word[3] > 0 && (own.empty() || own.back() != v))
                own.push_back(static_cast<std::uint32_t>(v));
    return users;
}

void Coder::refit(std::size_t p, std::span<const std::uint32_t> users, std::span<Left> left) {
    const std::size_t c = targets_.coefficients();
    std::vector<Left> unit(users.size()); // per vertex, the sum of its lobes with this profile for gain 1
    std::array<double, kMaxLobeOrder> along{}, square{}, change{};
    for (std::size_t u = 0; u < users.size(); ++u) {
        const std::size_t v = users[u];
        for (const LobeWord& word : words_of(v))
            if (word[2] == p)
                for (std::size_t i = 0; i < c; ++i)
                    unit[u][i] += factor(word) * static_cast<double>(axes_.of(word)[i]);
        const double area = static_cast<double>(targets_.areas[v]);
        for (std::size_t i = 0; i < c; ++i) {
            along[kBandOf[i]] += area * unit[u][i] * left[v][i];
            square[kBandOf[i]] += area * unit[u][i] * unit[u][i];
        }
    }
    LobeProfile& profile = model_.profiles[p];
    for (std::size_t l = 0; l < change.size(); ++l)
        if (square[l] > 1e-12) {
            const auto before = static_cast<double>(profile[l]);
            const auto most = static_cast<double>(kMaxGain);
            profile[l] = static_cast<float>(std::clamp(before + along[l] / square[l], -most, most));
            change[l] = static_cast<double>(profile[l]) - before;
        }
    for (std::size_t u = 0; u < users.size(); ++u)
        for (std::size_t i = 0; i < c; ++i)
            left[users[u]][i] -= change[kBandOf[i]] * unit[u][i];
}

void Coder::refit_profiles() {
    std::vector<Left> left(model_.vertices());
    for (std::size_t v = 0; v < left.size(); ++v)
        left[v] = rest_of(v, {}).left; // subtracts all lobes
    const std::vector<std::vector<std::uint32_t>> users = users_of_profiles();
    for (std::size_t p = 1; p < users.size(); ++p)
        refit(p, users[p], left);
}

} // namespace

LobeModel code_lobes(const LobeTargets& targets, std::span<const Lobe> fitted, const LobeFitOptions& options,
                     const Progress& progress) {
    check_targets(targets, options);
    if (fitted.size() != targets.areas.size() * static_cast<std::size_t>(options.lobes))
        throw Error("the number of fitted lobes is not the number of lobes of all vertices");
    LobeModel model{targets.order, options.lobes, {}, {}};
    std::vector<float> areas;
    for (const float area : targets.areas)
        areas.insert(areas.end(), options.lobes, area);
    model.profiles = shared_profiles(targets.order, fitted, areas, options);
    model.words.resize(fitted.size());
    Coder coder(targets, options, model);
    for (int round = 0; round <= options.rounds; ++round) {
        progress.update(static_cast<double>(round) / (options.rounds + 1));
        if (round > 0)
            coder.refit_profiles();
        coder.measure_profiles();
        parallel_for(model.vertices(), 64, options.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                progress.check();
                if (round == 0)
                    coder.encode(v, fitted.subspan(v * options.lobes, options.lobes));
                else
                    coder.improve(v);
            }
        });
    }
    return model;
}

} // namespace prt
