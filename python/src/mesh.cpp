// Transfer of the vertices of a mesh in memory, as digitisation projects compute it.

#include "bake/gltf/mesh_file.h"
#include "bake/scene/ray_scene.h"
#include "prt/bake/bake.h"
#include "prt/core/sh.h"
#include "python/src/arrays.h"
#include "python/src/call.h"
#include "python/src/options.h"
#include "python/src/work.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt::python {
namespace {

/// Returns normals weighted by the angles of the triangles at each vertex, [vertices]; unit, or 0.
std::vector<glm::dvec3> angle_normals(std::span<const glm::dvec3> positions,
                                      std::span<const glm::uvec3> faces) {
    std::vector<glm::dvec3> normals(positions.size(), glm::dvec3(0));
    for (const glm::uvec3& f : faces) {
        const glm::dvec3 corner[3] = {positions[f.x], positions[f.y], positions[f.z]};
        const glm::dvec3 across = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        const double size = glm::length(across);
        if (!(size > 0))
            continue;
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 a = corner[(c + 1) % 3] - corner[c], b = corner[(c + 2) % 3] - corner[c];
            normals[f[c]] += across / size * std::atan2(size, glm::dot(a, b));
        }
    }
    for (glm::dvec3& n : normals)
        n = glm::length(n) > 0 ? glm::normalize(n) : glm::dvec3(0);
    return normals;
}

/// Arrays of Python, checked.
struct Mesh {
    std::vector<glm::dvec3> positions, normals;
    std::vector<glm::uvec3> faces;
    std::vector<glm::vec3> albedo;
};

Mesh mesh_of(const Doubles& vertices, const py::array& faces, const std::optional<Doubles>& normals,
             const std::optional<Floats>& albedo) {
    Mesh mesh;
    mesh.positions = double_rows(vertices, "vertices");
    mesh.faces = triangles_of(faces, mesh.positions.size());
    if (mesh.positions.empty() || mesh.faces.empty())
        throw Error(mesh.positions.empty() ? "there are no vertices" : "there are no faces");
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(mesh.positions[v][axis]) <= kFarthestVertex))
                throw Error("vertex " + std::to_string(v) + " is not finite or exceeds 1e9");
    if (normals) {
        mesh.normals = double_rows(*normals, "normals");
        if (mesh.normals.size() != mesh.positions.size())
            throw Error("there are " + std::to_string(mesh.normals.size()) + " normals, but " +
                        std::to_string(mesh.positions.size()) + " vertices");
        for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
            const double size = glm::length(mesh.normals[v]);
            if (!std::isfinite(size))
                throw Error("normal " + std::to_string(v) + " is not finite");
            if (size > 0)
                mesh.normals[v] /= size;
        }
    } else {
        mesh.normals = angle_normals(mesh.positions, mesh.faces);
    }
    if (albedo) {
        mesh.albedo = float_rows(*albedo, "albedo");
        if (mesh.albedo.size() != mesh.positions.size())
            throw Error("there are " + std::to_string(mesh.albedo.size()) + " albedos, but " +
                        std::to_string(mesh.positions.size()) + " vertices");
        for (std::size_t v = 0; v < mesh.albedo.size(); ++v)
            for (int c = 0; c < 3; ++c)
                if (!(mesh.albedo[v][c] >= 0 && mesh.albedo[v][c] <= 1))
                    throw Error("albedo " + std::to_string(v) + " is not in 0..1");
    }
    return mesh;
}

/// Returns the scene of a mesh: one primitive, whose vertices are those of the mesh.
Scene scene_of(const Mesh& mesh) {
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const glm::dvec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    Scene scene;
    scene.origin = low + (high - low) / 2.0;
    VertexArray& vertices = scene.vertex_arrays.emplace_back();
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        vertices.positions.emplace_back(mesh.positions[v] - scene.origin);
        vertices.normals.emplace_back(mesh.normals[v]);
    }
    for (const glm::vec3& color : mesh.albedo)
        vertices.colors.emplace_back(glm::clamp(color, 0.0f, 1.0f), 1.0f);
    Material material;
    material.double_sided = true;
    scene.materials.push_back(material);
    scene.primitives.push_back({.triangles = mesh.faces});
    return scene;
}

/// Transfer vectors [vertices][coefficients] of prtkit's bake, in prtkit's convention, and the device.
py::tuple bake_mesh(const Doubles& vertices, const py::array& faces, const std::optional<Doubles>& normals,
                    const std::optional<Floats>& albedo, py::dict options, const py::object& progress) {
    BakeOptions how;
    how.repairs.inside = Inside::keep;
    take(options, "order", how.order);
    take(options, "rays", how.rays);
    take(options, "bounces", how.bounces);
    take(options, "seed", how.seed);
    take(options, "threads", how.threads);
    take(options, "denoise", how.repairs.denoise);
    choose(options, "backend", how.tracer.backend,
           {{"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"gpu", Backend::gpu}});
    check_empty(options);
    const Mesh mesh = mesh_of(vertices, faces, normals, albedo);
    Call call(progress);
    const BakeResult result =
        call.run([&] { return prt::bake(scene_of(mesh), how, call.progress("baking")); });
    Transfer transfer =
        how.bounces != 0 ? as_combined(result.baked.transfer, how.threads) : result.baked.transfer;
    return py::make_tuple(copied(transfer.vectors, transfer.receivers(), transfer.dimension()),
                          transfer.layout.channels(), result.statistics.device);
}

/// Returns 4 pi / D times the sum over directions d of max(n·d, 0) V(d) Y(d), [vertices][order²], by rays
/// from vertex + `offset` n in the given directions [D][3], the same for all vertices (PIFu, computePRT).
py::array_t<double> transfer_by_directions(const Doubles& vertices, const py::array& faces,
                                           const std::optional<Doubles>& normals, const Doubles& directions,
                                           int order, double offset, int threads,
                                           const py::object& progress) {
    if (order < 1 || order > kMaxOrder)
        throw Error("the highest band must be in 0..9, not " + std::to_string(order - 1));
    const Mesh mesh = mesh_of(vertices, faces, normals, std::nullopt);
    const std::vector<glm::dvec3> all = double_rows(directions, "directions");
    if (all.empty())
        throw Error("there are no directions");
    for (const glm::dvec3& d : all)
        if (!(glm::length(d) > 0 && std::isfinite(glm::length(d))))
            throw Error("a direction is 0 or not finite");
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    py::array_t<double> values(
        {static_cast<py::ssize_t>(mesh.positions.size()), static_cast<py::ssize_t>(count)});
    double* const to = values.mutable_data();
    Call call(progress);
    call.run([&] {
        const Scene scene = scene_of(mesh);
        const RayScene rays(scene, threads);
        std::vector<double> basis(all.size() * count);
        std::vector<glm::dvec3> unit;
        for (std::size_t d = 0; d < all.size(); ++d) {
            unit.push_back(glm::normalize(all[d]));
            evaluate_sh(order, unit[d], std::span(basis).subspan(d * count, count));
        }
        const double weight = 4 * std::numbers::pi / static_cast<double>(all.size());
        const Progress work = call.progress("tracing");
        constexpr std::size_t kRounds = 64; // reports of progress
        const std::size_t block = std::max<std::size_t>(1, mesh.positions.size() / kRounds);
        for (std::size_t first = 0; first < mesh.positions.size(); first += block) {
            const std::size_t end = std::min(first + block, mesh.positions.size());
            parallel_for(end - first, 64, threads, [&](std::size_t begin, std::size_t last) {
                for (std::size_t v = first + begin; v < first + last; ++v) {
                    double* const sum = to + v * count;
                    std::fill_n(sum, count, 0.0);
                    const glm::dvec3& n = mesh.normals[v];
                    const glm::vec3 start(mesh.positions[v] - scene.origin + offset * n);
                    for (std::size_t d = 0; d < all.size(); ++d) {
                        const double cosine = glm::dot(n, unit[d]);
                        if (!(cosine > 0) || rays.occluded({start, glm::vec3(unit[d])}))
                            continue;
                        for (std::size_t i = 0; i < count; ++i)
                            sum[i] += weight * cosine * basis[d * count + i];
                    }
                }
            });
            work.update(static_cast<double>(end) / static_cast<double>(mesh.positions.size()));
        }
    });
    return values;
}

/// Returns the vertices [V][3] and faces [F][3] of an OBJ or PLY file.
py::tuple load_mesh(const pipeline::Path& path) {
    MeshArrays mesh;
    std::vector<std::string> notices;
    {
        const py::gil_scoped_release release;
        const std::vector<std::byte> file = read_file(path);
        try {
            if (!is_mesh_file(path))
                throw Error("is neither .obj nor .ply; prtkit.load reads glTF");
            mesh = read_mesh_file(file, path, notices);
        } catch (const std::exception& error) {
            throw Error(path.string() + ": " + error.what());
        }
    }
    py::array_t<double> vertices({static_cast<py::ssize_t>(mesh.positions.size()), py::ssize_t{3}});
    py::array_t<std::int64_t> faces({static_cast<py::ssize_t>(mesh.triangles.size()), py::ssize_t{3}});
    std::copy_n(&mesh.positions.data()->x, vertices.size(), vertices.mutable_data());
    std::copy_n(&mesh.triangles.data()->x, faces.size(), faces.mutable_data());
    return py::make_tuple(vertices, faces);
}

} // namespace

void add_mesh(py::module_& module) {
    module.def("bake_mesh", bake_mesh);
    module.def("transfer_by_directions", transfer_by_directions);
    module.def("load_mesh", load_mesh);
    module.def("vertex_normals", [](const Doubles& vertices, const py::array& faces) {
        const Mesh mesh = mesh_of(vertices, faces, std::nullopt, std::nullopt);
        py::array_t<double> normals({static_cast<py::ssize_t>(mesh.normals.size()), py::ssize_t{3}});
        std::copy_n(&mesh.normals.data()->x, normals.size(), normals.mutable_data());
        return normals;
    });
}

} // namespace prt::python
