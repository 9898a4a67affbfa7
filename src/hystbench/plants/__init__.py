"""The package's own model files: the twin, and others like it."""

import os
from pathlib import Path


def packaged_models() -> dict[str, str]:
    """Files of the package's own model files, by name."""
    folder = Path(os.path.relpath(Path(__file__).parent))
    return {file.stem: str(file) for file in sorted(folder.glob("*.yaml"))}


def model_files(name: str) -> list[str]:
    """Files of a model, one of the package's by name or a path, or of a folder."""
    packaged = packaged_models()
    if name in packaged:
        return [packaged[name]]
    plants = Path(os.path.relpath(Path(__file__).parent))
    for folder in (plants / name, Path(name)):
        if folder.is_dir():
            return [str(file) for file in sorted(folder.glob("*.yaml"))]
    return [name]
