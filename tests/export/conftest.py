"""What tests of exported units share."""

import sys
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def fmpy():
    found = pytest.importorskip(
        "fmpy", reason="FMPy is not installed (pip install fmpy)"
    )
    scripts = str(Path(sys.executable).parent)  # where FMPy's own CMake is
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{scripts}:/usr/bin:/bin")
        yield found
