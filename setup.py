"""The compiled loops, plain C in two libraries; all else is in pyproject.toml."""

import os
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

# What the loops may not assume is that no NaN or infinity ever comes: that is how
# they see divergence. So neither -ffast-math nor -ffinite-math-only, and nothing
# linked with them, which would flush denormals in the whole process.
FLAGS = [
    *("-O3", "-march=native", "-std=gnu11", "-fPIC", "-fvisibility=hidden"),
    *("-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math"),
    *("-fno-signed-zeros", "-Wall", "-Wno-psabi"),
]


class BuildKernels(build_ext):
    """Build a library for ctypes: no Python headers, no flags of Python's own build."""

    def get_ext_filename(self, fullname: str) -> str:
        """Name the library plainly: it does not depend on the version of Python."""
        return str(Path(*fullname.split("."))) + ".so"

    def build_extensions(self) -> None:
        """Compile and link with the flags above alone."""
        words = (os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc").split()
        self.compiler.set_executables(
            compiler_so=[*words, *FLAGS], linker_so=[*words, "-shared"]
        )
        alone = self.compiler.compile

        def beside(sources: list[str], **given: Any) -> list[str]:
            """Compile files on all cores."""
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                made = pool.map(lambda source: alone([source], **given), sources)
                return [item for each in made for item in each]

        self.compiler.compile = beside
        super().build_extensions()


HERE = "src/hystbench/kernels"
SOURCES = [
    "curve.c",
    "drive.c",
    "envelope.c",
    "hardening.c",
    "inverse.c",
    "jiles_atherton.c",
    "largest.c",
    "lms.c",
    "play.c",
    "preisach.c",
    "state_space.c",
    "store.c",
    "structure.c",
    "volterra.c",
]

PLANT = "src/hystbench/challenge/kernels"
PLANT_SOURCES = [
    "diffusion.c",
    "hysteresis.c",
    "joints.c",
    "machine.c",
    "oscillator.c",
]

setup(
    ext_modules=[
        Extension(
            "hystbench.kernels._kernels",
            sources=[f"{HERE}/{name}" for name in SOURCES],
            depends=[
                f"{HERE}/{name}"
                for name in ("lanes.h", "tangent.h", "forces.c", "joint.c")
            ],
        ),
        # The hiding plant's own: it shares no code with the library above.
        Extension(
            "hystbench.challenge.kernels._plant",
            sources=[f"{PLANT}/{name}" for name in PLANT_SOURCES],
        ),
    ],
    cmdclass={"build_ext": BuildKernels},
)
