// The class Model.

#include "python/src/model.h"

#include "bake/gltf/encode_glb.h"
#include "bake/gltf/mesh_file.h"
#include "prt/core/error.h"
#include "prt/render/lightmap_file.h"
#include "python/src/arrays.h"
#include "python/src/options.h"
#include "runtime/core/support/file.h"

#include <utility>

namespace prt::python {
namespace {

using pipeline::Path;
using pipeline::ReadingOptions;

std::shared_ptr<Model> loaded(const Path& path, py::dict options) {
    ReadingOptions reading = reading_options(options);
    check_empty(options);
    const py::gil_scoped_release release;
    if (pipeline::suffix_of(path) == ".glb")
        return read_model(path, read_file(path), std::move(reading));
    // The document embeds external files, and reading has changed it.
    std::vector<std::byte> bytes = encode_glb(load_gltf(path, reading));
    return read_model(path, std::move(bytes),
                      {{.scene_limit = reading.scene_limit}, reading.shared, reading.bad_textures, {}});
}

std::shared_ptr<Model> parsed(const py::bytes& bytes, const std::string& name, py::dict options) {
    ReadingOptions reading = reading_options(options);
    check_empty(options);
    const std::string_view view = bytes;
    const std::span data = std::as_bytes(std::span(view));
    return read_model(name, {data.begin(), data.end()}, std::move(reading));
}

std::shared_ptr<Model> from_arrays(const Doubles& vertices, const py::array& faces,
                                   const std::optional<Floats>& normals, const std::optional<Floats>& colors,
                                   const std::optional<Floats>& texcoords, bool double_sided,
                                   const std::string& name) {
    MeshArrays mesh;
    mesh.positions = double_rows(vertices, "vertices");
    mesh.double_sided = double_sided;
    mesh.triangles = triangles_of(faces, mesh.positions.size());
    if (normals)
        mesh.normals = float_rows(*normals, "normals");
    if (colors)
        mesh.colors = float_rows(*colors, "colors");
    if (texcoords) {
        if (texcoords->ndim() != 2 || texcoords->shape(1) != 2)
            throw Error("texcoords must have the shape (V, 2), not " + shape_in_words(*texcoords));
        for (py::ssize_t v = 0; v < texcoords->shape(0); ++v)
            mesh.texcoords.emplace_back(texcoords->at(v, 0), texcoords->at(v, 1));
    }
    for (std::size_t v = 0; v < mesh.colors.size(); ++v)
        for (int c = 0; c < 3; ++c)
            if (!(mesh.colors[v][c] >= 0 && mesh.colors[v][c] <= 1))
                throw Error("color " + std::to_string(v) + " is not in 0..1");
    const py::gil_scoped_release release;
    return pipeline::about(name, [&] { return read_model(name + ".glb", mesh_glb(mesh, name), {}); });
}

/// Returns positions in the world, [vertices][3].
py::array_t<double> positions(const Model& model) {
    const Scene& scene = model.file.scene;
    py::array_t<double> array({static_cast<py::ssize_t>(scene.receivers()), py::ssize_t{3}});
    double* to = array.mutable_data();
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& p : vertices.positions) {
            const glm::dvec3 world = scene.world(p);
            for (int axis = 0; axis < 3; ++axis)
                *to++ = world[axis];
        }
    return array;
}

py::array_t<float> normals(const Model& model) {
    std::vector<glm::vec3> all;
    for (const VertexArray& vertices : model.file.scene.vertex_arrays)
        all.insert(all.end(), vertices.normals.begin(), vertices.normals.end());
    return copied(all);
}

py::array_t<std::uint32_t> faces(const Model& model) {
    const Scene& scene = model.file.scene;
    py::array_t<std::uint32_t> array({static_cast<py::ssize_t>(scene.triangles()), py::ssize_t{3}});
    std::uint32_t* to = array.mutable_data();
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner)
                *to++ = first + t[corner];
    }
    return array;
}

py::array_t<float> areas(const Model& model) {
    const pipeline::SceneFile& file = model.file;
    const std::vector<float> values =
        file.lightmap && file.baked ? file.lightmap->areas : receiver_areas(file.scene);
    return copied(values, values.size(), 0);
}

/// Returns the raw transfer vectors, [receivers][coefficients], without a copy.
py::object vectors(const py::object& self) {
    const auto& model = self.cast<const Model&>();
    if (!model.file.baked)
        return py::none();
    const Transfer& transfer = model.file.baked->transfer;
    return viewed(transfer.vectors, transfer.receivers(), transfer.dimension(), self);
}

py::list terms(const Model& model) {
    py::list list;
    if (!model.file.record())
        return list;
    const TransferLayout& layout = pipeline::layout_of(model.file);
    std::size_t first = 0;
    for (const TransferTerm& term : layout.terms) {
        const std::size_t count = layout.numbers_of(term);
        list.append(py::dict(py::arg("kind") = to_string(term.kind), py::arg("name") = term.name,
                             py::arg("channels") = term.channels,
                             py::arg("columns") = py::slice(static_cast<py::ssize_t>(first),
                                                            static_cast<py::ssize_t>(first + count), 1)));
        first += count;
    }
    return list;
}

const char* content(const Model& model) {
    return model.file.compressed || (model.file.instanced && model.file.instanced->compressed) ? "compressed"
           : model.file.baked                                                                  ? "baked"
                                                                                               : "scene";
}

py::object record(const Model& model) {
    const BakeRecord* record = model.file.record();
    if (!record)
        return py::none();
    return py::dict(py::arg("bounces") = record->endless ? py::object(py::float_(HUGE_VAL))
                                                         : py::object(py::int_(record->bounces)),
                    py::arg("rays") = record->rays, py::arg("seed") = record->seed,
                    py::arg("method") = to_string(record->method),
                    py::arg("backend") = to_string(record->backend),
                    py::arg("sampling_error") = record->sampling_error, py::arg("fitted") = record->fitted);
}

py::array_t<float> decoded(const Model& model, int threads) {
    Transfer transfer;
    {
        const py::gil_scoped_release release;
        if (model.file.compressed)
            transfer = decode(model.file.compressed->transfer, threads);
        else
            transfer.layout = model.transfer().layout();
    }
    if (!model.file.compressed)
        return copied(model.file.baked->transfer.vectors, model.file.baked->transfer.receivers(),
                      transfer.layout.dimension());
    return copied(transfer.vectors, transfer.receivers(), transfer.dimension());
}

void save(const Model& model, const Path& path) {
    const py::gil_scoped_release release;
    OutputFile file(path);
    file.write(model.bytes);
    file.commit();
}

py::object figures(const Model& model) {
    if (model.figures.is_null())
        return py::dict();
    return py::module_::import("json").attr("loads")(model.figures.dump());
}

std::string described(const Model& model) {
    const std::string name = model.name.filename().string(), what = content(model);
    std::string text = "<prtkit.Model '" + name + "', " + what + ", " +
                       std::to_string(model.file.scene.receivers()) + " vertices";
    if (model.file.order() > 0)
        text += ", order " + std::to_string(model.file.order());
    return text + (model.file.lightmap ? ", lightmap>" : ">");
}

} // namespace

TransferView Model::transfer() const {
    if (file.compressed)
        return file.compressed->transfer;
    if (file.baked)
        return file.baked->transfer;
    throw Error(name.string() + ": contains no transfer; bake it first");
}

std::shared_ptr<Model> read_model(Path name, std::vector<std::byte> bytes, ReadingOptions reading) {
    std::vector<std::string> notices;
    ReadingOptions noting = reading;
    noting.notify = [&](const std::string& file, const std::vector<std::string>& list) {
        for (const std::string& notice : list)
            notices.push_back(file + ": " + notice);
    };
    pipeline::SceneFile file = load_scene_file({name, bytes}, noting);
    return std::make_shared<Model>(Model{.name = std::move(name),
                                         .bytes = std::move(bytes),
                                         .reading = std::move(reading),
                                         .file = std::move(file),
                                         .figures = {},
                                         .notices = std::move(notices)});
}

ReadingOptions reading_options(py::dict& options) {
    ReadingOptions reading;
    take(options, "allow_outside", reading.allow_outside);
    take(options, "lamp_scale", reading.lamp_scale);
    take(options, "smooth_normals", reading.smooth_normals_degrees);
    take(options, "memory_limit", reading.scene_limit);
    if (!(reading.lamp_scale > 0 && reading.lamp_scale <= 1e9))
        throw Error("lamp_scale must be above 0 and at most 1e9");
    if (reading.smooth_normals_degrees &&
        !(*reading.smooth_normals_degrees >= 0 && *reading.smooth_normals_degrees <= 180))
        throw Error("smooth_normals must be in 0..180 degrees");
    if (!(reading.scene_limit >= 0))
        throw Error("memory_limit must be 0 or more bytes");
    choose(options, "bad_textures", reading.bad_textures,
           {{"error", BadTextures::error}, {"ignore", BadTextures::ignore}});
    return reading;
}

void add_model(py::module_& module) {
    py::class_<Model, std::shared_ptr<Model>>(module, "Model",
                                              R"(A glTF file in memory: a scene, a bake or a compressed model.

prtkit.load and prtkit.from_arrays create models; prtkit.bake and prtkit.compress return new ones.)")
        .def_static("_load", loaded)
        .def_static("_parse", parsed)
        .def_static("_from_arrays", from_arrays)
        .def("save", save, py::arg("path"),
             "Write the model to a .glb file. Replaces an existing file only if writing succeeds.")
        .def(
            "to_bytes",
            [](const Model& m) {
                return py::bytes(reinterpret_cast<const char*>(m.bytes.data()), m.bytes.size());
            },
            "Return the bytes of the .glb file.")
        .def_property_readonly(
            "name", [](const Model& m) { return m.name.string(); }, "Name of the file, for messages.")
        .def_property_readonly("content", content, "'scene', 'baked' or 'compressed'.")
        .def_property_readonly(
            "receivers", [](const Model& m) { return m.file.lightmap ? "texels" : "vertices"; },
            "Kind of the receivers with transfer: 'vertices' or 'texels'.")
        .def_property_readonly(
            "order", [](const Model& m) { return m.file.order(); },
            "SH order of the transfer; 0: no transfer.")
        .def_property_readonly("terms", terms,
                               "Terms of the transfer: dicts with 'kind' (direct, indirect, combined, lamp), "
                               "'name', 'channels', and 'columns', the slice of the transfer vectors.")
        .def_property_readonly("record", record, "Settings of the bake, a dict; None without transfer.")
        .def_property_readonly("vertices", positions,
                               "Positions in the world, metres, [V, 3], float64; a copy.")
        .def_property_readonly("normals", normals, "Unit normals, [V, 3], float32; a copy.")
        .def_property_readonly("faces", faces, "Indices of vertices, [F, 3], uint32; a copy.")
        .def_property_readonly(
            "areas", areas,
            "Areas of the receivers, m², [receivers], float32; a copy. Errors are weighted "
            "by them. Vertices also for a compressed lightmap.")
        .def_property_readonly("transfer", vectors,
                               "Raw transfer vectors, [receivers, coefficients], float32: a read-only view "
                               "without a copy; None without a bake. Light times transfer is exit radiance.")
        .def_property_readonly(
            "figures", figures,
            "Report of the step that made the model, as --json of prt; empty if it was loaded.")
        .def_property_readonly(
            "notices", [](const Model& m) { return m.notices; },
            "Messages about reading and making the model.")
        .def("decode", decoded, py::arg("threads") = 0,
             "Return the transfer vectors, [receivers, coefficients], float32; a copy.")
        .def("__repr__", described);
}

} // namespace prt::python
