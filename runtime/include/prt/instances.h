#pragma once

// Instances that share the transfer of their mesh: a few factors per instance describe how its surroundings
// change the light (docs/math.md, section 22; docs/format.md, PRTKIT_instances).
//
// A mesh is baked alone in the open. The surroundings of an instance block light from above and below the
// horizon, and reflect light onto it. Fourteen modes of lighting describe this. They are the same for all
// instances. The factor of each mode is linear in the position within the mesh's box, or is a constant color.
// Each frame:
//     modes.lightings(lighting)                      // once for all instances
// Then per vertex:
//     R = sum over modes of factor(instance, position) R_mode
// R_mode is the vertex's exit radiance under the lighting of that mode, rotated into the frame of the
// instance. prt/instance_relighter.h folds the factors into constants for shaders. Experimental.

#include "prt/sh_rotation.h"
#include "prt/support/glm_layout.h"
#include "prt/transfer.h"

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Passing (transmitted) modes: lighting above the horizon times √(4π)·Y_i for the first bands, plus one mode
/// for all light from below the horizon.
inline constexpr int kPassingOrder = 3;
inline constexpr std::size_t kPassingModes = std::size_t{kPassingOrder} * kPassingOrder + 1;
/// Added (reflected) modes: the light on horizontal ground, times √(4π)·Y_i for the first bands.
inline constexpr int kAddedOrder = 2;
inline constexpr std::size_t kAddedModes = std::size_t{kAddedOrder} * kAddedOrder;
inline constexpr std::size_t kInstanceModes = kPassingModes + kAddedModes;
/// Number of floats in `InstanceFactors`.
inline constexpr std::size_t kInstanceNumbers = 4 * kPassingModes + 3 * kAddedModes;
/// Maximum magnitude of a factor in files.
inline constexpr float kMaxInstanceFactor = 6e4f;

/// Effect of an instance's surroundings on the light, in axes of the world.
struct InstanceFactors {
    /// Factor of a mode at position u in the box, u in [-1, 1]³: dot(passing, (u, 1)).
    std::array<glm::vec4, kPassingModes> passing{};
    std::array<glm::vec3, kAddedModes> added{}; ///< red, green and blue, constant in the box

    friend bool operator==(const InstanceFactors&, const InstanceFactors&) = default;
};

/// Returns the factors of an unoccluded instance: it is lit exactly as its mesh was baked.
InstanceFactors open_factors();

/// Returns the factors as one array of numbers: first `passing`, then `added`.
std::array<float, kInstanceNumbers> numbers_of(const InstanceFactors& factors);
/// Returns the factors from an array of `numbers_of`, [kInstanceNumbers].
InstanceFactors factors_of(std::span<const float> numbers);

/// Factors in bytes, as stored in files: number j is that of `open_factors` plus scales[j] times its byte.
struct CodedFactors {
    std::array<float, kInstanceNumbers> scales{}; ///< not negative
    std::vector<std::int8_t> bytes;               ///< [instances][kInstanceNumbers]
};
/// Codes the factors of all instances, each rounded to the nearest step. Throws `Error` for factors that are
/// not finite or exceed `kMaxInstanceFactor`.
CodedFactors coded(std::span<const InstanceFactors> factors);
/// Returns the factors of all instances.
std::vector<InstanceFactors> decoded(const CodedFactors& coded);

/// Bounding box of a mesh in the frame of the mesh.
struct InstanceBox {
    glm::vec3 middle{0}, half{1}; ///< no component of `half` is zero

    /// Returns the relative position of `position` in the box, -1 to 1 per axis.
    glm::vec3 position_of(const glm::vec3& position) const { return (position - middle) / half; }
    friend bool operator==(const InstanceBox&, const InstanceBox&) = default;
};
/// Returns the bounding box of `positions`, which must not be empty.
InstanceBox bounding_box(std::span<const glm::vec3> positions);

/// Returns the factor of each mode at a relative position in the box.
std::array<glm::vec3, kInstanceModes> mode_factors(const InstanceFactors& factors, const glm::vec3& position);

/// The modes of lighting as linear operators on its coefficients. Immutable, thread-safe.
class InstanceModes {
public:
    /// `up`: unit vector away from the ground, in the frame of the coefficients; the modes use the axes of
    /// that frame. Throws `Error` for an invalid order.
    explicit InstanceModes(int order, const glm::dvec3& up = glm::dvec3(0, 1, 0));

    int order() const { return order_; }
    /// Returns the operator of a passing mode: [order²][order²], symmetric.
    std::span<const float> matrix(std::size_t mode) const;
    /// Clamped-cosine lobe of horizontal ground, [order²]. Its product with a lighting is the light that the
    /// added modes reflect.
    std::span<const float> level() const { return level_; }
    /// Returns the lighting of each mode for `lighting`. Throws `Error` if `lighting` has lamps or too few
    /// bands.
    std::array<Lighting, kInstanceModes> lightings(const Lighting& lighting) const;

private:
    int order_;
    std::vector<float> matrices_, level_;
};

/// Transfer of a mesh under each mode.
class SharedTransfer {
public:
    /// Precomputes the modes. `transfer`: transfer of the mesh's receivers. `transfer` and `up` are in the
    /// frame of the mesh. Throws `Error` for lamps and for several outputs.
    SharedTransfer(const Transfer& transfer, const glm::dvec3& up, int threads = 0);

    const TransferLayout& layout() const { return layout_; }
    std::size_t receivers() const { return responses_.size(); }
    /// Returns the transfer vector of a receiver under a passing mode, [layout().dimension()].
    std::span<const float> passing(std::size_t receiver, std::size_t mode) const {
        const std::size_t dimension = layout_.dimension();
        return std::span(passing_).subspan((receiver * kPassingModes + mode) * dimension, dimension);
    }
    /// Returns the radiance of a receiver under the light √(4π)·Y_i of each added mode.
    const std::array<glm::vec3, kAddedModes>& responses(std::size_t receiver) const {
        return responses_[receiver];
    }
    std::span<const float> level() const { return modes_.level(); }
    /// Computes the transfer vector of a receiver for given mode factors in axes of the mesh. The added modes
    /// go into the last term, because reflected light is not direct; they are left out if that is `direct`.
    void sum(std::size_t receiver, std::span<const glm::vec3> factors, std::span<float> vector) const;

private:
    TransferLayout layout_;
    InstanceModes modes_;
    std::vector<float> passing_; ///< [receivers][modes][dimension]
    std::vector<std::array<glm::vec3, kAddedModes>> responses_;
};

/// Converts factors from axes of the world to axes of the mesh. `rotation` maps the mesh's frame to the
/// world's.
InstanceFactors in_axes_of_mesh(const InstanceFactors& factors, const glm::dmat3& rotation);
/// Converts factors from axes of the mesh to axes of the world. `rotation` maps the mesh's frame to the
/// world's.
InstanceFactors in_axes_of_world(const InstanceFactors& factors, const glm::dmat3& rotation);

/// Position and factors of one instance of a mesh.
struct PlacedInstance {
    InstanceFactors factors; ///< in axes of the world
    glm::dmat3 rotation{1};  ///< from the mesh's frame to the world's
    InstanceBox box;
};

/// Computes the transfer of an instance in the world's frame, `vectors` [receivers][dimension]. `positions`
/// [receivers] are in the mesh's frame. `shared` must have been built with inverse(rotation) of the world's
/// up.
void expand_instance(const SharedTransfer& shared, const PlacedInstance& instance,
                     std::span<const glm::vec3> positions, std::span<float> vectors);

/// Assigns each instance a rotation in which its lighting is evaluated, so that few rotated lightings are
/// needed.
struct InstanceRotations {
    std::vector<glm::dmat3> rotations; ///< from the mesh's frame to the world's
    std::vector<std::uint32_t> of;     ///< [instances] index into `rotations`
    double max_degrees = 0;            ///< maximum angle between an instance's rotation and its assigned
                                       ///< rotation
};
/// Groups rotations. Rotations about +Y are rounded to `bins` equally spaced ones. Other rotations share an
/// entry only if they differ by at most `degrees`; so do all rotations if `bins` is 0.
InstanceRotations instance_rotations(std::span<const glm::dmat3> rotations, int bins, double degrees = 0.01);

/// Rotates the lightings of all modes into the mesh frame of a rotation, for the constants of instances.
std::array<Lighting, kInstanceModes> rotated_into(const glm::dmat3& rotation,
                                                  std::array<Lighting, kInstanceModes> lightings);

/// Computes the exit radiance of a vertex for albedo 1. `position`: relative position in the box; `of_modes`:
/// exit radiance of the vertex under each mode.
glm::vec3 exit_radiance(const InstanceFactors& factors, const glm::vec3& position,
                        std::span<const glm::vec3, kInstanceModes> of_modes);

} // namespace prt
