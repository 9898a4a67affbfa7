"""A model as a source FMU for co-simulation, of FMI 2.0 or 3.0."""

import hashlib
import uuid
import zipfile
from pathlib import Path
from typing import Literal
from xml.sax.saxutils import quoteattr

from hystbench import __version__
from hystbench.export import c
from hystbench.export.described import Described
from hystbench.export.names import filled

#: The major version of FMI, and by its name.
Version = Literal[2, 3]
VERSIONS: dict[str, Version] = {"2": 2, "3": 3}
#: What the functions of every version call.
SHARED = "hb_unit.h"
#: The files of an archive have no time of their own: the same model, the same bytes.
NO_TIME = (1980, 1, 1, 0, 0, 0)


def write_fmu(model: Described, path: Path, fmi: Version = 3) -> None:
    """Write the archive.

    Its output is known after a step that begins where its input is set: an importer
    sees it one interval later, as of any discrete system.
    """
    files = contents(model, fmi)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            entry = zipfile.ZipInfo(name, NO_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text)


def contents(model: Described, fmi: Version = 3) -> dict[str, str]:
    """Give the text of each file in the archive, by its path there."""
    source, header = c.source(model), c.header(model)
    token = str(uuid.UUID(hashlib.sha256((header + source).encode()).hexdigest()[:32]))
    names = [model.input.name, model.output.name]
    if len({"time", *names}) < 3:
        names = [f"input {names[0]}", f"output {names[1]}"]
    units = dict.fromkeys([model.input.unit, model.output.unit])
    told = " ".join([f"{model.about}.", *model.differences])
    values = {
        "title": model.title,
        "name": model.name,
        "source": f"{model.name}.c",
        "token": token,
        "about": told,
        "tool": f"hystbench {__version__}",
        "dt": repr(model.sampling.dt),
        "input": names[0],
        "output": names[1],
        "input_unit": model.input.unit,
        "output_unit": model.output.unit,
    }
    own = {"name": model.name, "NAME": model.name.upper(), "token": token}
    description = filled(
        f"fmi{fmi}.xml",
        units="\n".join(f"    <Unit name={quoteattr(unit)}/>" for unit in units),
        **{key: quoteattr(value) for key, value in values.items()},
    )
    return {
        "modelDescription.xml": description,
        # Later releases of FMI 2.0 have this file of FMI 3.0 too.
        "sources/buildDescription.xml": filled(
            "buildDescription.xml", name=model.name, fmi=str(fmi)
        ),
        f"sources/{model.name}.h": header,
        f"sources/{model.name}.c": source,
        **{f"sources/{file}": filled(file, **own) for file in (SHARED, f"fmi{fmi}.c")},
    }
