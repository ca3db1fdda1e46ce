"""Maps files to the tests that can detect their errors. Cheap tests come first; if they fail, the others are not built."""
from typing import NamedTuple

SUFFIXES = {".cpp", ".h", ".c", ".glsl", ".vert", ".frag", ".comp", ".js"}


class Suite(NamedTuple):
    program: str  # a target of the build, in its folder tests/; "node": the tests of the web loader
    filter: str = "*"

    def command(self, build, root):
        if self.program == "node":
            return ["node", "--test", *sorted(map(str, (root / "runtime/web/test").glob("*.test.js")))]
        return [str(build / "tests" / self.program), f"--gtest_filter={self.filter}", "--gtest_fail_fast", "--gtest_brief=1"]


# Tests that take seconds, then tests that take minutes.
RUNTIME = Suite("runtime_tests", "-*Suns*:*Skies*:Sky.AgreesWithAFiner*")
SMALL_ORDERS = Suite("runtime_tests", "*Sh*-All/ShOrder.*/6:All/ShOrder.*/7:All/ShOrder.*/8:All/ShOrder.*/9")
COMPRESS = Suite("compress_tests", "-Search*:Sweep*")
BAKE = Suite("bake_tests", "HitPoint*:Textures*:Glass*:Cut*:Blended*:Bad*:Leaf*:Metal*:Disc*:*Degrees*:*Orders*:Sobol*:Uniform*:Tangent*:"
             "AddBasis*:Direct*:InsideG*:Shell*:Ray*:BackFaces*:Channels*:Hard*:WallFoot*:Reduced*:Dipole*:MeasuredM*:SphereB*:White*:Bounces*:Memory*")
BOUNCES = Suite("bake_tests", "ColorB*:*PinHole*:ParallelPlates*:SphericalBowl*:Subsurface*:SmoothBoxes*:SealedIn*:OneSidedC*")
WHOLE_BAKE = Suite("bake_tests", "PathTracer*:EndlessWall*:OneSided*:Bake*:Storage*:Diffusion*:SamplingError*:TargetError*")
DIFFUSION = Suite("bake_tests", "Diffusion*")
RENDER, GPU = Suite("render_tests"), Suite("gpu_tests")

# The longest folder that is a prefix of the path is used.
SUITES = {
    "runtime/core/sh/": [SMALL_ORDERS, RUNTIME],
    "runtime/core/light/": [Suite("runtime_tests", "Light*:Sky*:*Cube*:*Image*:LatLong*:OtherLayouts*"), RUNTIME],
    "runtime/core/transfer/": [Suite("runtime_tests", "*Clustered*:*Constants*:CodedRows*:Adjacency*:Evaluate*:Bits*:Edges*:RawTransfer*"), COMPRESS,
                               Suite("gltf_tests")],
    "runtime/domains/": [RUNTIME, Suite("gltf_tests"), RENDER],
    "runtime/core/support/": [Suite("thread_tests"), RUNTIME],
    "runtime/fit/": [Suite("runtime_tests", "Lobe*:*Suns*:*Skies*")],
    "runtime/include/": [RUNTIME, COMPRESS],
    "runtime/image/": [Suite("image_tests")],
    "runtime/load/": [Suite("gltf_tests"), Suite("load_tests")],
    "bake/gltf/": [Suite("gltf_tests")],
    "runtime/render/": [RENDER],
    "runtime/shader/": [RENDER],
    "compress/": [COMPRESS, Suite("compress_tests", "Search*:Sweep*")],
    "bake/": [BAKE, BOUNCES, WHOLE_BAKE],
    "bake/products/lobes/": [Suite("bake_tests", "Pose*:VertexFrames*")],
    "bake/transport/": [BAKE, BOUNCES, DIFFUSION],
    "bake/trace/": [BAKE, BOUNCES],
    "bake/trace_gpu/": [GPU],
    "bake/reference/": [Suite("bake_tests", "PathTracer*:DistantLight*:Storage*"), RENDER],
    "shaders/": [RENDER, GPU],
    "shaders/viewer_": [Suite("viewer_tests")],
    # Only the modules of the package are tested here; Chromium tests the others.
    **{f"runtime/web/src/{name}.js": [Suite("node")] for name in ("PrtkitLoader", "PrtkitModel", "clusteredPca", "sphericalHarmonics", "rotations")},
}


def suites_of(path):
    """Returns the suites of a file in the order of execution; empty for unknown files."""
    folders = [folder for folder in SUITES if path.startswith(folder)]
    return SUITES[max(folders, key=len)] if folders else []
