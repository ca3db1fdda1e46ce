#!/usr/bin/env python3
"""Checks that includes point as the table of folders says.

include_arrows.py REPOSITORY
Every source belongs to the part with the longest folder that holds it. It may include headers of its own part and of
those that stand in its row, and of packages that stand there. Standard headers need no mention.
"""
import pathlib
import re
import sys

# part: (its folder, parts that it may include, packages that it may include)
PARTS = {
    "runtime": ("runtime", "", "glm"),
    "shader": ("runtime/shader", "runtime shaders", "glm"),
    "fit": ("runtime/fit", "runtime", "glm ceres"),
    "image": ("runtime/image", "runtime", "glm OpenEXR stb zlib libwebp libavif"),
    "scene": ("runtime/scene", "runtime", "glm tinygltf nlohmann meshoptimizer draco"),
    "c": ("runtime/c", "runtime shader image scene", "glm"),
    "render": ("runtime/render", "runtime image scene", "glm"),
    "gl": ("runtime/render/gl", "runtime scene render shader shaders", "glm epoxy glfw"),
    "bake": ("bake", "runtime scene render shaders", "glm fmt embree Eigen stb"),
    "vulkan": ("bake/vulkan", "runtime bake", "glm fmt vulkan"),
    "bake_gpu": ("bake/trace/gpu", "runtime scene gl bake vulkan shaders", "glm embree epoxy"),
    "compress": ("compress", "runtime scene", "glm Eigen"),
    "compress_study": ("compress/study", "runtime scene compress", "glm Eigen"),
    "shaders": ("shaders", "", ""),
    "cli": ("cli", "runtime shader fit image scene render gl bake bake_gpu compress", "glm fmt CLI nlohmann"),
    "example_scenes": ("examples/scenes", "runtime image", "glm tinygltf"),
    "game": ("examples/game", "runtime shader fit image scene gl", "glm epoxy"),
    "viewer": ("examples/viewer", "runtime fit image scene render gl shader bake compress",
               "glm fmt CLI nlohmann imgui glfw epoxy meshoptimizer"),
    # It measures the viewer's own pictures.
    "comparison": ("examples/comparison", "viewer runtime image scene render gl shader bake compress fit",
                   "glm fmt CLI nlohmann epoxy"),
}
# Includes that are allowed although the table forbids them.
EXCEPTIONS = {
    # The viewer's and the GL renderer's buffers have the layout of the shaders, which is installed for games, too.
    ("examples/viewer", "shared_layout.h"), ("examples/viewer", "shared_viewer.h"),
    ("examples/game", "shared_layout.h"),
    # One file decides which tracer is created.
    ("bake/trace/make_tracer.cpp", "bake_gpu"),
}
PACKAGES = {  # how their headers begin
    "glm/": "glm", "ceres/": "ceres", "Eigen/": "Eigen", "OpenEXR/": "OpenEXR", "Imath": "OpenEXR", "Imf": "OpenEXR",
    "stb/": "stb", "zlib": "zlib", "tiny_gltf": "tinygltf", "nlohmann/": "nlohmann", "meshoptimizer": "meshoptimizer",
    "draco/": "draco",
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
    """Finds which file of the repository an include means."""

    def __init__(self, root, files):
        self.files = set(files)
        self.roots = sorted({str(path.parent.relative_to(root)) for path in root.glob("**/include/prt") if "build" not in path.parts}
                            | {"runtime", "bake", "compress", "cli", "shaders", "examples/viewer", "examples/comparison"}
                            | {folder for folder, _, _ in PARTS.values()})

    def find(self, source, header):
        for folder in [str(pathlib.PurePosixPath(source).parent), *self.roots]:
            path = str(pathlib.PurePosixPath(folder, header))
            if path in self.files:
                return path
        return None


def is_exception(source, header, target):
    return any(source.startswith(place) and what in (header.split("/")[-1], target) for place, what in EXCEPTIONS)


def violation(headers, source, quoted, header):
    part = part_of(source)
    _, parts, packages = PARTS[part]
    if not quoted:
        if SYSTEM.match(header):
            return None
        package = package_of(header)
        if package is None:
            return f"<{header}> is of no package that the table knows"
        return None if package in packages.split() else f"{part} may not include {package} (<{header}>)"
    path = headers.find(source, header)
    if path is None:
        return None  # made by the build
    target = part_of(path)
    if target == part or is_exception(source, header, target):
        return None
    if target not in parts.split():
        return f"{part} may not include {target} ({path})"
    if part.startswith(("example", "game", "viewer")) and "/include/prt/" not in path:
        return f"examples include public headers only, not {path}"
    return None


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    tops = sorted({folder.split("/")[0] for folder, _, _ in PARTS.values()})
    files = [str(path.relative_to(root)) for top in tops for path in sorted((root / top).rglob("*"))
             if path.suffix in (".h", ".cpp", ".c") and "node_modules" not in path.parts]
    headers = Headers(root, files)
    wrong = []
    for source in files:
        if part_of(source) is None:
            wrong.append(f"{source}: in no folder of the table")
            continue
        for quote, header in INCLUDE.findall((root / source).read_text(encoding="utf-8")):
            said = violation(headers, source, quote == '"', header)
            if said:
                wrong.append(f"{source}: {said}")
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main())
