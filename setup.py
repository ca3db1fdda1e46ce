"""Builds the module in C++ of the Python package with CMake; pyproject.toml has all else."""

import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """Configures and builds the target prt_python."""

    def build_extension(self, ext):
        folder = pathlib.Path(self.build_temp).resolve()
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "CMAKE_UNITY_BUILD": "ON",
            "CMAKE_UNITY_BUILD_BATCH_SIZE": "16",
            "PRTKIT_PYTHON": "ON",
            "PRTKIT_PROGRAM": "OFF",
            "PRTKIT_EXAMPLES": "OFF",
            "PRTKIT_TESTS": "OFF",
            "Python_EXECUTABLE": sys.executable,
        }
        try:
            import pybind11

            options["pybind11_DIR"] = pybind11.get_cmake_dir()
        except ImportError:
            pass  # CMake finds the package of the system
        definitions = [f"-D{name}={value}" for name, value in options.items()]
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *definitions], check=True)
        subprocess.run(["cmake", "--build", folder, "--target", "prt_python"], check=True)
        (built,) = (folder / "python" / "prtkit").glob("_prtkit*.so")
        target.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["strip", "-o", target, built], check=True)


version = re.search(r"project\(prtkit VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
setup(version=version, ext_modules=[Extension("prtkit._prtkit", [])], cmdclass={"build_ext": CMakeBuild})
