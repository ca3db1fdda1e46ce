#pragma once

// Instances that share the transfer of their mesh: a few factors per instance describe how its surroundings
// change the light (docs/math.md, section 22; docs/format.md, PRTKIT_instances).
//
// A mesh is baked alone in the open. The surroundings of an instance block light from above and below the
// horizon, and reflect light onto the instance. Fourteen modes, lightings derived from the scene's lighting,
// describe both effects; all instances share the modes. Each instance has a factor per mode: ten passing
// (transmitted) modes have factors that are linear in the position within the mesh's box, four added
// (reflected) modes have constant colors. Arrays of modes contain the passing modes first.
// Y_i is the SH basis function number i.
//
// Lamps of the scene have their own light at each instance: incident light that is linear in the position
// within the box.
//
// Each frame:
//     modes.lightings(lighting)                      // once for all instances
// Then per vertex:
//     R = sum over modes of factor(instance, position) R_mode + sum over lamps of strength R_lamp
// R_mode is the vertex's exit radiance under the lighting of that mode, rotated into the frame of the
// instance, R_lamp that under the light of a lamp. `InstanceRelighter` folds the factors into constants for
// shaders. Experimental.

#include "prt/core/cluster_lighting.h"
#include "prt/core/glm_layout.h"
#include "prt/core/sh_rotation.h"
#include "prt/core/transfer.h"

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of SH bands whose functions Y_i define the first nine passing modes: mode i is the lighting from
/// above the horizon, multiplied in each direction by √(4π)·Y_i.
inline constexpr int kPassingOrder = 3;
/// Number of passing modes: one for each function Y_i, then one for all lighting from below the horizon.
inline constexpr std::size_t kPassingModes = std::size_t{kPassingOrder} * kPassingOrder + 1;
/// Number of SH bands whose functions Y_i define the added modes: mode i has the radiance √(4π)·Y_i in each
/// direction, multiplied by the exit radiance of unoccluded horizontal ground of albedo 1.
inline constexpr int kAddedOrder = 2;
/// Number of added modes: one for each function Y_i.
inline constexpr std::size_t kAddedModes = std::size_t{kAddedOrder} * kAddedOrder;
/// Number of modes. Arrays of all modes contain the passing modes first, then the added modes.
inline constexpr std::size_t kInstanceModes = kPassingModes + kAddedModes;
/// Number of floats in `InstanceFactors`.
inline constexpr std::size_t kInstanceNumbers = 4 * kPassingModes + 3 * kAddedModes;
/// Maximum magnitude of each number of `InstanceFactors` that `coded` accepts.
inline constexpr float kMaxInstanceFactor = 6e4f;

/// Effect of an instance's surroundings on its light: a factor for each mode. The functions Y_i of the modes
/// are in the axes of the world, unless a function states the axes of the mesh. By default all factors are 0:
/// no light.
struct InstanceFactors {
    /// Linear function for each passing mode. At the relative position u in the box of the mesh
    /// (`InstanceBox::position_of`), the factor of mode m is dot(passing[m], (u, 1)) for all colors.
    std::array<glm::vec4, kPassingModes> passing{};
    /// Red, green and blue factor of each added mode, equal at all positions.
    std::array<glm::vec3, kAddedModes> added{};

    friend bool operator==(const InstanceFactors&, const InstanceFactors&) = default;
};

/// Number of SH functions of the light of a lamp at an instance: those of five bands, which contain 99.8 % of
/// the energy of the clamped cosine; its sixth band is zero (Ramamoorthi and Hanrahan 2001, eq. 8).
inline constexpr std::size_t kInstanceLampFunctions = 25;
/// Number of floats in `InstanceLampLight`.
inline constexpr std::size_t kInstanceLampNumbers = kInstanceLampFunctions * 3 * 4;

/// Size of the light of a lamp at an instance in files, in bytes: a float32 scale, then one byte per number.
inline constexpr std::size_t kLampLightBytes = sizeof(float) + kInstanceLampNumbers;

/// Incident light of a lamp at an instance, with all bounces in the surroundings, for the lamp's strength in
/// the scene. At the relative position u in the box of the mesh (`InstanceBox::position_of`), the radiance of
/// color c is the sum over i of dot(functions[i][c], (u, 1)) times √(4π)·Y_i, in the axes of the mesh.
struct InstanceLampLight {
    std::array<std::array<glm::vec4, 3>, kInstanceLampFunctions> functions{}; ///< [functions][colors]

    friend bool operator==(const InstanceLampLight&, const InstanceLampLight&) = default;
};

/// Light of a lamp in bytes, as stored in files: number j of `functions` is `scale` times byte j.
struct CodedLampLight {
    float scale = 0;                                       ///< step of all numbers, not negative
    std::array<std::int8_t, kInstanceLampNumbers> bytes{}; ///< -127..127
};
/// Returns the coded light, with `scale` the largest magnitude divided by 127. Rounds each number to the
/// nearest step. Throws `Error` for numbers that are not finite.
CodedLampLight coded(const InstanceLampLight& light);
/// Returns the light as rounded by `coded`.
InstanceLampLight decoded(const CodedLampLight& coded);

/// Returns the factors of an instance without surroundings. Its light is exactly that of its baked mesh.
InstanceFactors open_factors();

/// Returns the factors as one array of numbers: the four components of each entry of `passing`, then the
/// three of each entry of `added`.
std::array<float, kInstanceNumbers> numbers_of(const InstanceFactors& factors);
/// Returns the factors from `numbers` [kInstanceNumbers] in the order of `numbers_of`.
InstanceFactors factors_of(std::span<const float> numbers);

/// Factors of instances in bytes, as stored in files. Number j of an instance, in the order of `numbers_of`,
/// is number j of `open_factors` plus scales[j] times byte j of the instance.
struct CodedFactors {
    std::array<float, kInstanceNumbers> scales{}; ///< step of each number, not negative
    std::vector<std::int8_t> bytes;               ///< [instances][kInstanceNumbers] -127..127
};
/// Returns the coded factors of all instances, with scales[j] the largest magnitude of the difference of
/// number j from `open_factors`, divided by 127. Rounds each number to the nearest step. Throws `Error` for
/// numbers that are not finite or exceed kMaxInstanceFactor in magnitude.
CodedFactors coded(std::span<const InstanceFactors> factors);
/// Returns the factors of all instances, [instances], as rounded by `coded`.
std::vector<InstanceFactors> decoded(const CodedFactors& coded);

/// Axis-aligned box around a mesh, in the mesh's frame and its unit of length.
struct InstanceBox {
    glm::vec3 middle{0}, ///< center of the box
        half{1};         ///< half of the size along each axis; all components must be greater than 0

    /// Returns the relative position of `position`, which is in the mesh's frame: -1 to 1 per axis inside the
    /// box, 0 at its center.
    glm::vec3 position_of(const glm::vec3& position) const { return (position - middle) / half; }
    friend bool operator==(const InstanceBox&, const InstanceBox&) = default;
};
/// Returns the bounding box of `positions`, which must not be empty. Each side is at least a thousandth of
/// the longest side, so that `half` is not 0 for flat meshes.
InstanceBox bounding_box(std::span<const glm::vec3> positions);

/// Returns the red, green and blue factor of each mode at `position`, a relative position in the box
/// (`InstanceBox::position_of`).
std::array<glm::vec3, kInstanceModes> mode_factors(const InstanceFactors& factors, const glm::vec3& position);

/// Linear operators that map the SH coefficients of a lighting to the lightings of the modes. Immutable,
/// thread-safe.
class InstanceModes {
public:
    /// Computes the operators for lighting of `order` bands. `up` is the unit vector away from the ground, in
    /// the frame of the SH coefficients; the functions Y_i of the modes use the axes of this frame. Throws
    /// `Error` unless `order` is in 1..kMaxOrder.
    explicit InstanceModes(int order, const glm::dvec3& up = glm::dvec3(0, 1, 0));

    /// Returns the number of bands, as passed to the constructor.
    int order() const { return order_; }
    /// Returns the operator of passing mode `mode`, 0..kPassingModes - 1: a symmetric matrix [order²][order²]
    /// that maps the coefficients of one channel of a lighting to those of the mode.
    std::span<const float> matrix(std::size_t mode) const;
    /// Returns the transfer vector of unoccluded horizontal ground, [order²]. Its dot product with the
    /// coefficients of a lighting is the exit radiance of the ground for albedo 1, which multiplies the
    /// functions Y_i of added modes.
    std::span<const float> level() const { return level_; }
    /// Returns the lighting of each mode under `lighting`, in `order()` bands; ignores further bands of
    /// `lighting`. A passing mode has suns if `lighting` has suns. An added mode has all its light in `sky`.
    /// Ignores `lighting.lamps`; the results have no lamps. Throws `Error` if sky or suns have fewer bands
    /// than `order()`.
    std::array<Lighting, kInstanceModes> lightings(const Lighting& lighting) const;

private:
    int order_;
    std::vector<float> matrices_, ///< [kPassingModes][order²][order²]
        level_;                   ///< [order²]
};

/// Transfer vectors of the receivers of one mesh under each mode. Immutable, thread-safe.
class SharedTransfer {
public:
    /// Computes the transfer vectors; keeps no reference to `transfer`. `transfer` contains the receivers of
    /// the mesh alone, without surroundings. `up` is the unit vector away from the ground. Both are in the
    /// frame of the mesh. `transfer` must have at least one term of distant light. Ignores its lamps. Throws
    /// `Error` if its order is not in 1..kMaxOrder, or if it has no term of distant light or several outputs.
    /// Uses `threads` threads; 0: all hardware threads.
    SharedTransfer(const Transfer& transfer, const glm::dvec3& up, int threads = 0);

    /// Returns the layout of the transfer passed to the constructor, without its lamps.
    const TransferLayout& layout() const { return layout_; }
    /// Returns the number of receivers of the mesh.
    std::size_t receivers() const { return responses_.size(); }
    /// Returns the transfer vector of `receiver` under passing mode `mode`, 0..kPassingModes - 1, for factor
    /// 1: [layout().dimension()], in the frame of the mesh. If the scene's lighting, rotated into this frame,
    /// is applied to it, the result is the exit radiance for albedo 1 under the lighting of the mode.
    std::span<const float> passing(std::size_t receiver, std::size_t mode) const {
        const std::size_t dimension = layout_.dimension();
        return std::span(passing_).subspan((receiver * kPassingModes + mode) * dimension, dimension);
    }
    /// Returns the exit radiance of `receiver` for albedo 1 under the radiance √(4π)·Y_i for each function i,
    /// summed over all terms of the transfer. The first kAddedModes are those of added modes, without the
    /// factor for the radiance of the ground.
    const std::array<glm::vec3, kInstanceLampFunctions>& responses(std::size_t receiver) const {
        return responses_[receiver];
    }
    /// Returns the exit radiance of `receiver` for albedo 1 under the light of a lamp with strength 1, at the
    /// relative position `position` in the box.
    glm::vec3 lamp_radiance(std::size_t receiver, const InstanceLampLight& light,
                            const glm::vec3& position) const;
    /// Returns `InstanceModes::level` in the frame of the mesh: [order²].
    std::span<const float> level() const { return modes_.level(); }
    /// Writes the transfer vector of `receiver` in an instance to `vector` [layout().dimension()], in the
    /// frame of the mesh. `factors` [kInstanceModes] is the result of `mode_factors` for factors in the axes
    /// of the mesh. Passing modes contribute to all terms. Added modes are not direct light and contribute to
    /// the last term only; they are ignored if that term has the kind `direct`. If that term is grey, it uses
    /// the red factors.
    void sum(std::size_t receiver, std::span<const glm::vec3> factors, std::span<float> vector) const;

private:
    TransferLayout layout_;
    InstanceModes modes_;
    std::vector<float> passing_; ///< [receivers][kPassingModes][dimension]
    std::vector<std::array<glm::vec3, kInstanceLampFunctions>> responses_; ///< [receivers]
};

/// Returns factors in the axes of the mesh from `factors` in the axes of the world. `rotation` maps vectors
/// of the mesh's frame to the world's. Throws `Error` if `rotation` is not a rotation.
InstanceFactors in_axes_of_mesh(const InstanceFactors& factors, const glm::dmat3& rotation);
/// Returns factors in the axes of the world from `factors` in the axes of the mesh. `rotation` maps vectors
/// of the mesh's frame to the world's. Throws `Error` if `rotation` is not a rotation.
InstanceFactors in_axes_of_world(const InstanceFactors& factors, const glm::dmat3& rotation);

/// Factors and rotation of one instance of a mesh. Translation and uniform scale are not stored: they do not
/// change how the mesh shadows itself.
struct PlacedInstance {
    InstanceFactors factors; ///< in the axes of the world
    glm::dmat3 rotation{1};  ///< maps vectors of the mesh's frame to the world's; without scale
    InstanceBox box;         ///< box of the mesh, in the mesh's frame
    /// [lamps of the transfer] light of each lamp. Empty for a mesh that is drawn once, at the position of
    /// its bake: InstanceRelighter then lights it by the lamp terms of its transfer.
    std::vector<InstanceLampLight> lamps = {};
};

/// Writes the transfer vectors of an instance, in the frame of the world, to `vectors`
/// [shared.receivers()][layout.dimension()]. `layout` is that of the transfer from which `shared` was made,
/// with its lamps. `positions` [shared.receivers()] are in the frame of the mesh. The `up` of `shared` must
/// be transpose(instance.rotation) · (0, 1, 0): the up direction of the world in the frame of the mesh. A
/// lamp term with one channel gets the mean of the colors. Throws `Error` if instance.rotation is not a
/// rotation, or if `instance.lamps` has not one light for each lamp of `layout`.
void expand_instance(const SharedTransfer& shared, const TransferLayout& layout,
                     const PlacedInstance& instance, std::span<const glm::vec3> positions,
                     std::span<float> vectors);

/// Rotations that replace the rotations of instances. Instances with the same replacement share one rotated
/// lighting.
struct InstanceRotations {
    std::vector<glm::dmat3> rotations; ///< distinct replacements; map the mesh's frame to the world's
    std::vector<std::uint32_t> of;     ///< [instances] index in `rotations` of the replacement
    double max_degrees =
        0; ///< maximum angle in degrees between the rotation of an instance and its replacement
};
/// Groups `rotations` [instances], which map the mesh's frame to the world's. If `bins` is greater than 0,
/// rotations about +Y are rounded to the nearest multiple of 360 / bins degrees. Every other rotation, and
/// every rotation if `bins` is 0 or less, is replaced by the first entry of the result that differs by at
/// most `degrees` degrees. If no entry does, the rotation itself becomes an entry. Does not check that the
/// matrices are rotations.
InstanceRotations instance_rotations(std::span<const glm::dmat3> rotations, int bins, double degrees = 0.01);

/// Returns `lightings`, the result of `InstanceModes::lightings` in the frame of the world, rotated into the
/// frame of the mesh. `rotation` maps vectors of the mesh's frame to the world's. Throws `Error` if
/// `rotation` is not a rotation.
std::array<Lighting, kInstanceModes> rotated_into(const glm::dmat3& rotation,
                                                  std::array<Lighting, kInstanceModes> lightings);

/// Returns the exit radiance of a vertex of an instance for albedo 1: the sum over all modes of factor times
/// exit radiance. `position` is the relative position of the vertex in the box (`InstanceBox::position_of`).
/// `of_modes` is the exit radiance of the vertex for albedo 1 under the lighting of each mode, rotated into
/// the frame of the mesh.
glm::vec3 exit_radiance(const InstanceFactors& factors, const glm::vec3& position,
                        std::span<const glm::vec3, kInstanceModes> of_modes);

/// Range of consecutive rows in the constants of compressed transfer, such as the rows that a mesh reads.
struct ConstantRows {
    std::uint32_t first = 0, ///< index of the first row
        count = 0;           ///< number of rows; 0: empty range
};
/// Returns the smallest range that contains all rows of the clusters of receivers [first, first + count). It
/// also contains the rows of all clusters with indices between these. Returns an empty range if `count` is 0.
ConstantRows rows_of(const ClusteredTransfer& transfer, std::size_t first, std::size_t count);
/// Returns the smallest range that contains `a` and `b`. If one of them is empty, returns the other.
ConstantRows joined(const ConstantRows& a, const ConstantRows& b);

/// An instance, and the rows that its mesh reads.
struct RelitInstance {
    PlacedInstance placed; ///< factors, rotation and box
    ConstantRows rows;     ///< the union by `joined` of `rows_of` over the vertices of the mesh
};

/// Computes constants for instances. Immutable, thread-safe.
class InstanceRelighter {
public:
    /// Copies the required data; keeps no references. `transfer` contains all meshes of the instances. For an
    /// instance that is rotated only about +Y, the lighting is rotated by the nearest multiple of 360 / yaws
    /// degrees: all these instances together need at most `yaws` rotated lightings. For all other instances,
    /// and for all instances if `yaws` is 0, the error of the rotation is at most 0.01 degrees
    /// (`instance_rotations`). Throws `Error` if the layout of `transfer` is invalid (`check_layout`), if
    /// `transfer` has several outputs, if an instance has lamps, but not one light for each lamp of
    /// `transfer`, or if the constants exceed 4 GB.
    InstanceRelighter(const ClusteredTransfer& transfer, std::span<const RelitInstance> instances,
                      int yaws = 64);

    /// Returns the number of vectors in the constants of all instances together: three per row.
    std::size_t size() const { return size_; }
    /// Returns the maximum angle, over all instances, between the rotation of an instance and the rounded
    /// rotation of its lighting, in degrees.
    double max_degrees() const { return rotations_.max_degrees; }
    /// Returns two vectors per instance, [instances][2], for the attributes of the shader. xyz of the first
    /// is the center of the mesh's box, xyz of the second 1 / `InstanceBox::half` along each axis. The w
    /// components are integers in floats, 0..65535: the low 16 bits (first) and the high 16 bits (second) of
    /// a 32-bit offset. The red vector of row r of the model is at index 3 ((r + offset) mod 2^32) of the
    /// constants; green and blue follow.
    std::vector<glm::vec4> table() const;
    /// Computes the constants of all instances for `lighting`, which is in the frame of the world, and writes
    /// them to `constants` [size()]: instance by instance, row by row, then red, green, blue. The color of a
    /// row at the relative position u in the box is dot(vector, (u, 1)) for each of the three vectors. Throws
    /// `Error` if sky or suns have fewer bands than the transfer, or if `lighting.lamps` has neither 0
    /// elements nor one for each lamp. Throws the errors of `rotated_into` for instances whose rotation the
    /// constructor does not round. Uses `threads` threads; 0: all hardware threads.
    void update(const Lighting& lighting, std::span<glm::vec4> constants, int threads = 0) const;

private:
    ClusterLighting relighter_;
    InstanceModes modes_;
    InstanceRotations rotations_;
    std::vector<RelitInstance> instances_;
    /// [rows][kInstanceLampFunctions] constants under the radiance √(4π)·Y_i; empty without lamps
    std::vector<glm::vec3> responses_;
    std::vector<std::size_t> begins_; ///< [instances] index of the instance's first vector in the constants
    std::vector<std::vector<std::uint32_t>> of_; ///< [rotations] indices of the instances with each rotation
    std::size_t size_ = 0;
};

} // namespace prt
