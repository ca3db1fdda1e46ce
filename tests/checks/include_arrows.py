#!/usr/bin/env python3
"""Checks that includes follow the table of allowed dependencies between folders.

include_arrows.py REPOSITORY
Every source belongs to the part with the longest folder that contains it. It may include headers of its own part, and of
the parts and packages in its row. Standard headers are always allowed. In a library with layers, a source may include
headers of its own layer and of lower ones. No folders include each other in a circle. A public header belongs to the folder
of the source with its name, in its part; HOMES lists the folders of public headers without such a source. Stable
public headers include stable ones only.
"""
import pathlib
import re
import sys

# part: (its folder, allowed parts, allowed packages)
PARTS = {
    "runtime": ("runtime", "", "glm"),
    "shader": ("runtime/shader", "runtime shaders", "glm"),
    "fit": ("runtime/fit", "runtime", "glm ceres"),
    "image": ("runtime/image", "runtime", "glm OpenEXR stb zlib libwebp libavif"),
    "load": ("runtime/load", "runtime", "glm nlohmann meshoptimizer"),
    "c": ("runtime/c", "runtime shader image load", "glm"),
    "render": ("runtime/render", "runtime image load", "glm"),
    "gl": ("runtime/render/gl", "runtime load render shader shaders", "glm epoxy glfw"),
    "gltf": ("bake/gltf", "runtime load", "glm tinygltf nlohmann meshoptimizer draco"),
    "bake": ("bake", "runtime load gltf render device tracers shaders", "glm fmt embree Eigen stb"),
    "device": ("bake/device", "runtime bake", "glm fmt vulkan"),
    "trace_gpu": ("bake/trace_gpu", "runtime load gltf bake device shaders", "glm embree"),
    "raster": ("bake/raster", "runtime load gltf gl bake trace_gpu shaders", "glm epoxy"),
    "tracers": ("bake/tracers", "runtime load gltf bake device trace_gpu raster", "glm fmt"),
    "compress": ("compress", "runtime load", "glm Eigen"),
    "compress_study": ("compress/study", "runtime load compress", "glm Eigen"),
    "shaders": ("shaders", "", "glm"),
    "report": ("cli/report", "runtime load gltf bake compress compress_study", "glm fmt nlohmann"),
    "pipeline": ("cli/pipeline", "runtime shader fit image load gltf render gl bake tracers compress compress_study report",
                 "glm fmt nlohmann"),
    "cli": ("cli", "runtime shader fit image load gltf render gl bake device compress compress_study report pipeline", "glm fmt CLI nlohmann"),
    # The Python module, over prt::pipeline.
    "python": ("python", "runtime fit load gltf render bake compress compress_study report pipeline", "glm nlohmann pybind11"),
    "example_scenes": ("examples/scenes", "runtime image", "glm tinygltf"),
    "game": ("examples/game", "runtime shader fit image load gl", "glm epoxy"),
    # Applications of this repository, which may include private headers.
    "viewer": ("examples/viewer", "runtime fit image load gltf render gl shader bake compress compress_study report pipeline",
               "glm fmt CLI nlohmann imgui glfw epoxy meshoptimizer"),
    # It measures pictures of the viewer.
    "comparison": ("examples/comparison", "viewer runtime image load gltf render gl shader bake compress compress_study fit",
                   "glm fmt CLI nlohmann epoxy"),
}
# Folders of libraries with layers, from the lowest to the highest.
LAYERS = {
    "runtime": ("core/support", "core/sh", "core/light", "core/transfer", "domains"),
    "bake": ("gltf", "scene", "device", "trace", "trace_gpu", "raster", "tracers", "transport", "plan", "surface_fit", "reference",
             "pipeline", "refine", "products/volumes", "products/occlusion", "products/lightmaps", "products/instances",
             "products/levels", "products/lobes", "studies"),
    "compress": ("tuning", "metric", "clusters", "coding", "pipeline", "search", "study"),
    "cli": ("report", "pipeline", "program", "arguments", "commands"),
}
# Folders of public headers without a source of their name: their names, by folder.
HOMES = {
    "bake/scene": "bake_options texels",
    "bake/products/levels": "level_bake",
    "compress/clusters": "compress_trace",
    "runtime/core/sh": "sh_basis",
    "runtime/core/support": "glm_layout progress version",
    "runtime/c": "prt",
    "runtime/fit": "lobe_fit suns",
    "runtime/load": "model",
    "bake/gltf": "animation gltf refinement transfer_gltf",
}
# Includes that are allowed although the table forbids them.
EXCEPTIONS = {
    # Buffers of the viewer and of the GL renderer have the layout of the shaders, which is also installed for games.
    ("examples/viewer", "shared_layout.h"), ("examples/viewer", "shared_viewer.h"),
    ("examples/game", "shared_layout.h"),
}
PACKAGES = {  # prefixes of their headers
    "glm/": "glm", "ceres/": "ceres", "Eigen/": "Eigen", "OpenEXR/": "OpenEXR", "Imath": "OpenEXR", "Imf": "OpenEXR",
    "stb/": "stb", "zlib": "zlib", "tiny_gltf": "tinygltf", "nlohmann/": "nlohmann", "meshoptimizer": "meshoptimizer",
    "draco/": "draco", "pybind11/": "pybind11",
    "epoxy/": "epoxy", "webp/": "libwebp", "avif/": "libavif", "GLFW/": "glfw", "embree3/": "embree", "fmt/": "fmt", "CLI/": "CLI",
    "imgui": "imgui", "backends/imgui": "imgui", "vulkan/vulkan_raii": "vulkan",
}
SYSTEM = re.compile(r"^[a-z_]+$|^(std[a-z]+|string|math|time|signal|errno|limits|unistd|dirent|fcntl|poll|dlfcn|windows)\.h$|^sys/|^linux/")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)


def part_of(path):
    held = [(len(folder), part) for part, (folder, _, _) in PARTS.items() if path.startswith(folder + "/")]
    return max(held)[1] if held else None


def package_of(header):
    return next((package for begin, package in PACKAGES.items() if header.startswith(begin)), None)


class Headers:
    """Resolves includes to files of the repository."""

    def __init__(self, root, files):
        self.files = set(files)
        self.roots = sorted({str(path.parent.relative_to(root)) for path in root.glob("**/include/prt") if "build" not in path.parts}
                            | {"", "shaders", "examples/scenes", "examples/viewer", "examples/comparison"})

    def find(self, source, header):
        for folder in [str(pathlib.PurePosixPath(source).parent), *self.roots]:
            path = str(pathlib.PurePosixPath(folder, header))
            if path in self.files:
                return path
        return None


def include_folder(path, files):
    """Returns the folder that a file counts for in the rules of layers and circles; None for an unlisted public header."""
    library, public, name = path.partition("/include/prt/")
    if not public:
        return str(pathlib.PurePosixPath(path).parent)
    stem = pathlib.PurePosixPath(name).stem
    for folder, stems in HOMES.items():
        if folder.startswith(library) and stem in stems.split():
            return folder
    sources = [file for file in files if file.endswith(f"/{stem}.cpp") and part_of(file) == part_of(path)]
    return str(pathlib.PurePosixPath(min(sources, key=len)).parent) if sources else None


def layer_of(folder):
    """Returns library and index of the layer of a folder, or None."""
    library, _, rest = folder.partition("/")
    return (library, LAYERS[library].index(rest)) if rest in LAYERS.get(library, ()) else None


def climbs(folder, target):
    """Whether a header in `target` is in a higher layer of the library of `folder`."""
    own, other = layer_of(folder), layer_of(target)
    return bool(own and other and own[0] == other[0] and other[1] > own[1])


def circles(includes):
    """Returns sets of folders that include each other. `includes`: folder: included folders."""
    reached = {}

    def reach(start):
        found, rest = set(), [start]
        while rest:
            for folder in includes.get(rest.pop(), ()):
                if folder not in found:
                    found.add(folder)
                    rest.append(folder)
        return found

    for folder in includes:
        reached[folder] = reach(folder)
    return {frozenset({folder, *(other for other in found if folder in reached.get(other, ()))})
            for folder, found in reached.items() if folder in found}


def is_stable(root, path):
    """Whether the opening comment of a public header states that its interface is stable."""
    opening = (root / path).read_text(encoding="utf-8").partition("#include")[0]
    return re.search(r"\bStable\.", opening) is not None


def is_exception(source, header, target):
    return any(source.startswith(prefix) and allowed in (header.split("/")[-1], target) for prefix, allowed in EXCEPTIONS)


def violation(headers, source, quoted, header):
    part = part_of(source)
    _, parts, packages = PARTS[part]
    if not quoted:
        if SYSTEM.match(header):
            return None
        package = package_of(header)
        if package is None:
            return f"<{header}> belongs to no package of the table"
        return None if package in packages.split() else f"{part} may not include {package} (<{header}>)"
    path = headers.find(source, header)
    if path is None:
        return None  # generated by the build
    if "/include/prt/" in source and "/include/prt/" not in path:
        return f"public headers may include only public headers, not {path}"
    target = part_of(path)
    if target == part or is_exception(source, header, target):
        return None
    if target not in parts.split():
        return f"{part} may not include {target} ({path})"
    if part in ("example_scenes", "game") and "/include/prt/" not in path:
        return f"examples may include only public headers, not {path}"
    return None


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    tops = sorted({folder.split("/")[0] for folder, _, _ in PARTS.values()})
    files = [str(path.relative_to(root)) for top in tops for path in sorted((root / top).rglob("*"))
             if path.suffix in (".h", ".cpp", ".c") and "node_modules" not in path.parts]
    headers = Headers(root, files)
    wrong, includes = [], {}
    for source in files:
        if part_of(source) is None:
            wrong.append(f"{source}: is not in a folder of the table")
            continue
        for quote, header in INCLUDE.findall((root / source).read_text(encoding="utf-8")):
            error = violation(headers, source, quote == '"', header)
            if error:
                wrong.append(f"{source}: {error}")
            path = headers.find(source, header) if quote == '"' else None
            if path is None:
                continue
            if "/include/prt/" in source and is_stable(root, source) and not is_stable(root, path):
                wrong.append(f"{source}: is stable, but includes {path}, which is not")
            folder, target = include_folder(source, files), include_folder(path, files)
            if None in (folder, target):
                wrong.append(f"{source if folder is None else path}: HOMES does not list its folder")
            if None in (folder, target) or folder == target:
                continue
            includes.setdefault(folder, set()).add(target)
            if climbs(folder, target):
                wrong.append(f"{source}: {folder} may not include the higher layer {target} ({path})")
    wrong += [f"{', '.join(sorted(circle))}: include each other in a circle" for circle in circles(includes)]
    print(*dict.fromkeys(wrong), sep="\n", end="\n" if wrong else "")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main())
