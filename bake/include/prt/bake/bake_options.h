#pragma once

// Options of a bake: tracer, distance fall-off, lamps, media, memory. Subsurface scattering is computed by
// the multiple-scattering dipole (H. W. Jensen, S. Marschner, M. Levoy and P. Hanrahan, "A Practical Model
// for Subsurface Light Transport", SIGGRAPH 2001).

#include "prt/core/baked_transfer.h"
#include "prt/load/scene.h"
#include "prt/render/texture.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace prt {

/// A homogeneous medium that scatters light. Vectors have the components red, green and blue, linear Rec.
/// 709.
struct Medium {
    glm::dvec3 scattering{0}; ///< reduced scattering coefficient sigma_s', 1/m
    glm::dvec3 absorption{0}; ///< absorption coefficient sigma_a, 1/m
    double ior = 1.3;         ///< index of refraction relative to air
};

/// Limits that a bake checks, in 1 / unit of the scene. The densest measured medium has sigma_s' = 2e4 / m.
inline constexpr double kMinScattering = 1e-9, ///< minimum of sigma_s'; the minimum of sigma_a is 0
    kMaxCoefficient = 1e9;                     ///< maximum of sigma_s' and of sigma_a

/// A measured medium of Jensen et al. 2001, figure 5.
struct NamedMedium {
    std::string_view name; ///< lower case: "marble", "skin1", "whole-milk" and others
    Medium medium;         ///< coefficients in 1/m
};
/// Returns the 12 measured media, sorted by name. The span is valid until the program ends.
std::span<const NamedMedium> measured_media();

/// Returns the medium of a glTF material. The material must have KHR_materials_volume with a thickness and a
/// finite attenuation distance, and a factor of KHR_materials_diffuse_transmission greater than 0; otherwise
/// returns no value. The attenuation defines sigma_s' + sigma_a. The base color factor (without texture) is
/// the diffuse reflectance of a thick slab and defines sigma_s' / (sigma_s' + sigma_a). The index of
/// refraction is 1.5.
std::optional<Medium> medium_of(const Material& material);

/// Diffuse reflection of a half space that is filled with a medium, for one color channel. Light that enters
/// at one point of the plane surface leaves at other points.
class Dipole {
public:
    /// `scattering`: sigma_s' in 1/m, greater than 0. `absorption`: sigma_a in 1/m, at least 0. `ior`: index
    /// of refraction relative to air, at least 1. The constructor does not check these ranges.
    Dipole(double scattering, double absorption, double ior);

    /// Returns Rd, the fraction of the entering power that leaves per area at `distance` metres from the
    /// point of entry, in 1/m² (eq. 4 of the paper).
    double reflectance(double distance) const;
    /// Returns the fraction of the entering power that leaves within `radius` metres of the point of entry,
    /// 0..1: the integral of `reflectance` over this disc. For an infinite radius it equals `total`.
    double inside(double radius) const;
    /// Returns the diffuse albedo, 0..1: the fraction of the entering power that leaves anywhere.
    double total() const { return total_; }
    /// Returns the effective transport coefficient sigma_tr in 1/m; 0 without absorption. At a large distance
    /// r, `reflectance` decreases like exp(-sigma_tr r).
    double falloff() const { return falloff_; }
    /// Returns the mean free path 1 / (sigma_s' + sigma_a) in metres: the depth below the surface at which
    /// the model puts its light source. `reflectance` varies little over shorter distances.
    double depth() const { return real_depth_; }

private:
    double albedo_, falloff_, real_depth_, virtual_depth_, total_;
};

/// Returns the reduced albedo sigma_s' / (sigma_s' + sigma_a), 0..1, of the medium that reflects the fraction
/// `reflectance` (0..1) of uniform light diffusely. `ior`: index of refraction of the medium.
double reduced_albedo(double reflectance, double ior);

/// Share of light that passes a surface hit by a ray, as a function of the distance: obscurance (S. Zhukov,
/// A. Iones and G. Kronin, "An Ambient Light Illumination Model", 1998). At distance x the share is the
/// weighted mean over `terms` of 1 - exp(log(1/2) x / d), with the half distance d of the term. With a
/// fall-off, distant surfaces darken less, and the inside of closed rooms is not black. The default blocks
/// all light at every distance.
struct Falloff {
    /// One exponential function of the distance.
    struct Term {
        double half_distance; ///< distance in metres at which half of the light passes; finite and greater
                              ///< than 0
        double share = 1;     ///< weight of this term relative to the sum of all weights; finite and at least
                              ///< 0, greater than 0 for at least one term
    };
    std::vector<Term> terms; ///< empty: no light passes up to distance `farthest`
    /// Distance in metres beyond which all light passes; greater than 0, may be infinite.
    double farthest = std::numeric_limits<double>::infinity();

    /// Returns whether surfaces block all light at every distance.
    bool blocks_everywhere() const;
    /// Returns the share of light that passes a surface at `distance` metres, 0..1.
    double passes(double distance) const;
};

/// Throws `Error` unless half distances are finite and greater than 0, shares are finite and at least 0, at
/// least one share is greater than 0 (if there are terms), and `farthest` is greater than 0.
void check_falloff(const Falloff& falloff);

/// Method by which a GPU finds the surfaces that rays hit.
enum class Traversal {
    automatic, ///< `device` if the GPU supports ray queries, otherwise `compute`
    device,    ///< ray queries of Vulkan: the driver builds and searches the hierarchy of triangles; an error
               ///< with Backend::gpu if the GPU does not support ray queries
    compute,   ///< compute shaders of prtkit search a hierarchy of triangles that prtkit builds
};

/// Settings that select a tracer.
struct TracerChoice {
    Backend backend = Backend::automatic; ///< hardware that traces rays or draws depth maps
    /// Ray tracing or depth maps. Depth maps need OpenGL 4.5, on a hardware GPU for Backend::automatic or on
    /// any device for Backend::gpu; with Backend::cpu `bake` throws `Error` for them.
    BakeMethod method = BakeMethod::trace;
    int raster_resolution = 1024; ///< texels along each side of a depth map, 16..16384; ignored by
                                  ///< BakeMethod::trace
    /// GPU that traces rays with Backend::gpu: its index in gpu_devices(), or a part of its name, as in
    /// `named_device`; empty: the best device. Other backends and depth maps ignore this member.
    std::string gpu = {};
    /// Method by which a GPU traces rays. The CPU and depth maps ignore this member.
    Traversal traversal = Traversal::automatic;
    /// Distance fall-off of occlusion; the default blocks all light at every distance. `bake` throws `Error`
    /// for any other fall-off if the method is BakeMethod::raster or if light bounces.
    Falloff falloff = {};
};

/// Wall-clock time of the stages of tracing, in seconds. If a tracer cannot measure stages separately, their
/// time is included in `trace`.
struct TraceSeconds {
    double trace = 0;      ///< tracing of rays, or drawing of depth maps
    double accumulate = 0; ///< summation of spherical harmonics, and calls of the sink
    double transfer = 0;   ///< copies of data to and from a GPU
};

/// Treatment of sealed receivers: receivers that no light can reach because they are inside solid geometry.
enum class Inside {
    refill, ///< replace the transfer of sealed receivers by the mean of their neighbours in the mesh, ring by
            ///< ring, which avoids dark seams where solids meet; a receiver that is connected only to sealed
            ///< receivers stays dark
    keep,   ///< leave sealed receivers dark
};

/// Points of a surface where a bake measures light.
enum class FitMode {
    automatic, ///< `surface` if test points between the vertices show that it has a lower error, otherwise
               ///< `vertex`; always `vertex` for BakeMethod::raster and with a target error
    vertex,    ///< measure light at the vertices
    surface,   ///< measure light at samples between the vertices; vertex values are then a least-squares fit
               ///< of their interpolation to the samples (Kavan, Bargteil and Sloan 2011)
};

/// Value for a number of bounces: bounce light until the remaining light is negligible.
inline constexpr int kEndlessBounces = -1;
/// Maximum of a finite number of bounces. Endless bounces through media also stop at this number.
inline constexpr int kMaxBounces = 10000;
inline constexpr int kMaxRays = 1 << 24; ///< maximum number of rays per receiver

/// Assigns a medium to materials of the scene.
struct MediumChoice {
    std::string material; ///< name of the materials that get the medium; empty: all materials
    Medium medium;        ///< medium inside the surfaces with these materials, coefficients in 1/m
};

/// Settings of subsurface scattering.
struct SubsurfaceOptions {
    /// Media that replace the media of the scene's materials. If several entries match a material, the last
    /// one applies. A bake throws `Error` if no material matches an entry.
    std::vector<MediumChoice> media;
    /// Length of the scene's unit in metres, finite and greater than 0. It scales the coefficients of all
    /// media, which are in 1/m.
    double metres_per_unit = 1;
};

/// Selects the light of lamps that is baked. Lamps are lights of KHR_lights_punctual and emissive materials.
enum class LampMode {
    all,      ///< direct light of lamps, and their light after bounces
    indirect, ///< light of lamps after at least one bounce or through a medium, for renderers that add the
              ///< direct light of lamps themselves
    none,     ///< no light of lamps: the transfer has no lamp terms
};

/// Group of lamps that are dimmed together and share one term of the transfer. A bake throws `Error` if no
/// lamp belongs to the group, except with LampMode::none.
struct LampGroup {
    /// `name`: name of the term, which must differ from the names of lamps outside the group. `pattern`:
    /// matches whole names of lamps, with regard to case; * matches any number of characters, ? matches one.
    std::string name, pattern;
};

/// Settings for lamps.
struct LampOptions {
    LampMode mode = LampMode::all;
    /// Groups of lamps. A lamp belongs to the first group whose pattern matches its name. Each other lamp
    /// name gets its own term. A bake throws `Error` for more than kMaxLamps terms.
    std::vector<LampGroup> groups;
    /// Radius of point lights and spot lights in metres, finite and at least 0. A larger radius makes their
    /// shadows softer; 0: hard shadows.
    double radius = 0;
    /// Approximate number of rays, 1..kMaxRays, from a receiver to all emissive surfaces of a lamp term, and
    /// the same number to all its point and spot lights together if `radius` is greater than 0. A light
    /// without extent gets one ray.
    int rays = 64;
};

/// Treatment of faults in a scene, and of noise.
struct Repairs {
    BadTextures bad_textures = BadTextures::error; ///< treatment of missing and damaged textures
    Inside inside = Inside::refill;                ///< treatment of receivers inside solid geometry
    /// True: filter the light of receivers over the surface, as strongly as its noise requires. Depth maps
    /// (BakeMethod::raster) and surface fits do not use this filter.
    bool denoise = true;
};

/// Memory limit of a bake, and number format of its result.
struct BakeMemory {
    /// Limit of the estimated memory in bytes, above which a bake throws `Error`. 0: the memory of the
    /// machine, or of its container if that is smaller; no limit if the system does not report it.
    double limit = 0;
    /// Number format in which files store the transfer. No value: the bake selects float16 if its rounding
    /// error is below a tenth of the sampling error, otherwise float32.
    std::optional<TransferStorage> storage = {};
};

/// Settings of a bake.
struct BakeOptions {
    int order = 6; ///< order of the transfer, 1..kMaxOrder
    /// Number of rays per receiver, 1..kMaxRays; for BakeMethod::raster the number of directions.
    int rays = 1024;
    /// Target relative L2 error of the sky's direct light at the receivers, finite and greater than 0. The
    /// bake then chooses the number of rays instead of `rays`, at most kMaxRays: of each vertex separately,
    /// but of all together for BakeMethod::raster, FitMode::surface and texels. No value: each receiver gets
    /// `rays` rays.
    std::optional<double> target_error;
    FitMode fit = FitMode::vertex; ///< points where light is measured
    /// Number of bounces, 0..kMaxBounces, or kEndlessBounces; 0: light without bounces. Must be 0 with a
    /// distance fall-off. With BakeMethod::raster, rays follow the bounces.
    int bounces = 0;
    TracerChoice tracer; ///< hardware and method that trace the rays, and the distance fall-off of occlusion
    SubsurfaceOptions subsurface; ///< media inside materials
    LampOptions lamps;            ///< light of lamps
    Repairs repairs;              ///< treatment of faults and of noise
    BakeMemory memory;            ///< memory limit, and number format of the result
    int threads = 0;              ///< number of threads; 0: all
    std::uint64_t seed = 0;       ///< seed of the random directions of rays
};

/// An optional high-poly model of the same object. Its surfaces block, reflect and emit light instead of
/// those of the scene, and its lights are baked. A receiver of the scene (a vertex, a texel, or a point
/// between vertices) is measured on the outermost surface of the model that is within `reach` along the
/// receiver's normal, on both sides, and faces the same way, with the normal there. Without such a surface,
/// it is measured at its own position.
struct FinerModel {
    const Scene* scene = nullptr; ///< the model, which the caller keeps; null: the scene itself blocks light
    double reach = 0;             ///< metres; if `scene` is set, greater than 0 and at most kFarthestVertex
};

/// Throws `Error` if `finer` has a scene and its `reach` is not greater than 0 or exceeds kFarthestVertex.
void check_finer(const FinerModel& finer);

/// Estimates the peak memory of a bake in bytes, from the order, the number of bounces and the presence of a
/// target error in `options`. The estimate excludes the operator of the bounces, whose size is known only
/// after some receivers are traced. `receivers`: number of receivers, including back sides; `triangles`:
/// number of triangles of the scene; `numbers`: number of coefficients of a transfer vector, over all its
/// terms and channels.
double estimate_memory(const BakeOptions& options, std::size_t receivers, std::size_t triangles,
                       std::size_t numbers);

} // namespace prt
