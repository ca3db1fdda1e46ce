#pragma once

// Instances that share the transfer of their mesh: what the place of each does to light, in a few factors
// (docs/math.md, section 22; docs/format.md, PRTKIT_instances).
//
// A mesh is baked alone in the open. Where one of its instances stands, light is blocked above the horizon
// and below it, and the neighbourhood throws light back: fourteen modes of lighting, the same for all
// instances, each with a factor that is linear in the place within the mesh's box, or a color. Each frame:
//     modes.lightings(lighting)                      // once for all instances
// then per vertex:
//     R = sum over modes of factor(instance, place) R_mode
// with R_mode the vertex's exit radiance under that mode's lighting, turned into the frame of the instance.
// prt/instance_former.h works the factors into constants for shaders. Experimental.

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

/// The scene's light from above the horizon times sqrt(4 pi) Y_i of so many bands; then that from below.
inline constexpr int kPassingOrder = 3;
inline constexpr std::size_t kPassingModes = std::size_t{kPassingOrder} * kPassingOrder + 1;
/// What the light on level ground throws back, times sqrt(4 pi) Y_i of so many bands.
inline constexpr int kAddedOrder = 2;
inline constexpr std::size_t kAddedModes = std::size_t{kAddedOrder} * kAddedOrder;
inline constexpr std::size_t kInstanceModes = kPassingModes + kAddedModes;
/// Numbers of `InstanceFactors`.
inline constexpr std::size_t kInstanceNumbers = 4 * kPassingModes + 3 * kAddedModes;
/// Largest magnitude of a factor that files hold.
inline constexpr float kLargestFactor = 6e4f;

/// What stands round an instance, in axes of the world.
struct InstanceFactors {
    /// Factor of a mode at place u of the box: dot(passing, (u, 1)).
    std::array<glm::vec4, kPassingModes> passing{};
    std::array<glm::vec3, kAddedModes> added{}; ///< red, green and blue, everywhere in the box

    friend bool operator==(const InstanceFactors&, const InstanceFactors&) = default;
};

/// Of an instance that nothing stands round: its light is that of its mesh, exactly.
InstanceFactors open_factors();

/// Passing, then added. [kInstanceNumbers]
std::array<float, kInstanceNumbers> numbers_of(const InstanceFactors& factors);
InstanceFactors factors_of(std::span<const float> numbers);

/// Factors in bytes, as files hold them: number j is that of `open_factors` plus scales[j] times its byte.
struct CodedFactors {
    std::array<float, kInstanceNumbers> scales{}; ///< none is negative
    std::vector<std::int8_t> bytes;               ///< [instances][kInstanceNumbers]
};
/// Rounds to the nearest. Throws `Error` for factors that are not finite or beyond `kLargestFactor`.
CodedFactors coded(std::span<const InstanceFactors> factors);
std::vector<InstanceFactors> decoded(const CodedFactors& coded);

/// The box of a mesh in its own frame.
struct InstanceBox {
    glm::vec3 middle{0}, half{1}; ///< none of `half` is zero

    /// Where `position` lies in it, -1 to 1.
    glm::vec3 place_of(const glm::vec3& position) const { return (position - middle) / half; }
    friend bool operator==(const InstanceBox&, const InstanceBox&) = default;
};
/// Round positions, of which there are some.
InstanceBox box_round(std::span<const glm::vec3> positions);

/// The factor of each mode at a place of the box.
std::array<glm::vec3, kInstanceModes> mode_factors(const InstanceFactors& factors, const glm::vec3& place);

/// The modes of lighting, as linear operators on its coefficients. Immutable, thread-safe.
class InstanceModes {
public:
    /// `up`: unit, away from the ground, in the frame of the coefficients; axes of the modes are those of
    /// that frame. Throws `Error` for an order that is none.
    explicit InstanceModes(int order, const glm::dvec3& up = glm::dvec3(0, 1, 0));

    int order() const { return order_; }
    /// Of a passing mode: [order²][order²], symmetric.
    std::span<const float> matrix(std::size_t mode) const;
    /// What level ground gets of a lighting, [order²]: added modes are lit by as much.
    std::span<const float> level() const { return level_; }
    /// What each mode is lit with, by a lighting without lamps. Throws `Error` where it has fewer bands.
    std::array<Lighting, kInstanceModes> lightings(const Lighting& lighting) const;

private:
    int order_;
    std::vector<float> matrices_, level_;
};

/// Transfer of a mesh under each of the modes.
class SharedTransfer {
public:
    /// `transfer`: of the mesh's receivers, in its own frame; `up` in that frame. Throws `Error` for lamps
    /// and for several outputs.
    SharedTransfer(const Transfer& transfer, const glm::dvec3& up, int threads = 0);

    const TransferLayout& layout() const { return layout_; }
    std::size_t receivers() const { return responses_.size(); }
    /// The vector of a receiver under a passing mode, [layout().dimension()].
    std::span<const float> passing(std::size_t receiver, std::size_t mode) const {
        const std::size_t dimension = layout_.dimension();
        return std::span(passing_).subspan((receiver * kPassingModes + mode) * dimension, dimension);
    }
    /// What a receiver makes of light of sqrt(4 pi) Y_i.
    const std::array<glm::vec3, kAddedModes>& responses(std::size_t receiver) const {
        return responses_[receiver];
    }
    std::span<const float> level() const { return modes_.level(); }
    /// The vector of a receiver where the modes have these factors, in axes of the mesh. What is added goes
    /// into the last part, which direct light is not.
    void sum(std::size_t receiver, std::span<const glm::vec3> factors, std::span<float> vector) const;

private:
    TransferLayout layout_;
    InstanceModes modes_;
    std::vector<float> passing_; ///< [receivers][modes][dimension]
    std::vector<std::array<glm::vec3, kAddedModes>> responses_;
};

/// Factors in axes that `rotation` turns into those of `factors`: of the mesh, from those of the world.
InstanceFactors in_axes_of_mesh(const InstanceFactors& factors, const glm::dmat3& rotation);
InstanceFactors in_axes_of_world(const InstanceFactors& factors, const glm::dmat3& rotation);

/// One instance of a mesh.
struct PlacedInstance {
    InstanceFactors factors; ///< in axes of the world
    glm::dmat3 rotation{1};  ///< from the mesh's frame into the world's
    InstanceBox box;
};

/// Transfer of an instance in the world's frame, `vectors` [receivers][dimension]; `positions` [receivers] in
/// the mesh's frame. `shared` was made for inverse(rotation) of the world's up.
void expand_instance(const SharedTransfer& shared, const PlacedInstance& instance,
                     std::span<const glm::vec3> positions, std::span<float> vectors);

/// Which turn each instance is lit in, so that constants are formed for few turns.
struct InstanceTurns {
    std::vector<glm::dmat3> rotations; ///< of the mesh's frame into the world's
    std::vector<std::uint32_t> of;     ///< [instances]
    double most_degrees = 0;           ///< that an instance is turned against its turn
};
/// Turns about +Y fall into `bins` of even yaw; others, and all where `bins` is 0, have one for each that is
/// different by more than `degrees`.
InstanceTurns instance_turns(std::span<const glm::dmat3> rotations, int bins, double degrees = 0.01);

/// The lightings of all modes in the frame of a turn: what constants of instances are formed with.
std::array<Lighting, kInstanceModes> turned_into(const glm::dmat3& rotation,
                                                 std::array<Lighting, kInstanceModes> lightings);

/// Exit radiance for albedo 1 of a vertex: `of_modes`, its radiance under each of them.
glm::vec3 exit_radiance(const InstanceFactors& factors, const glm::vec3& place,
                        std::span<const glm::vec3, kInstanceModes> of_modes);

} // namespace prt
