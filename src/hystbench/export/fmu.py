"""A model as a source FMU of FMI 3.0, for co-simulation."""

from __future__ import annotations

import hashlib
import uuid
import zipfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

from hystbench import __version__
from hystbench.export import c
from hystbench.export.described import Described

WRAPPER = Path(__file__).with_name("fmi3.c")
#: The files of an archive have no time of their own: the same model, the same bytes.
NO_TIME = (1980, 1, 1, 0, 0, 0)

DESCRIPTION = """\
<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName={title} instantiationToken={token}
    description={about} generationTool={tool}>
  <CoSimulation modelIdentifier={name} canHandleVariableCommunicationStepSize="true"
      fixedInternalStepSize={dt} canGetAndSetFMUState="true"/>
  <UnitDefinitions>
{units}
  </UnitDefinitions>
  <DefaultExperiment startTime="0" stepSize={dt}/>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent"/>
    <Float64 name={input} valueReference="1" causality="input" unit={input_unit}
        variability="discrete" start="0"/>
    <Float64 name={output} valueReference="2" causality="output" unit={output_unit}
        variability="discrete"/>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="2" dependencies=""/>
    <InitialUnknown valueReference="2" dependencies=""/>
  </ModelStructure>
</fmiModelDescription>
"""

BUILD = """\
<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{name}">
    {files}
  </BuildConfiguration>
  <BuildConfiguration modelIdentifier="{name}" platform="x86_64-linux">
    {files}
    <Library name="m" external="true"/>
  </BuildConfiguration>
</fmiBuildDescription>
"""
FILES = """\
<SourceFileSet language="C99">
      <SourceFile name="{name}.c"/>
      <SourceFile name="fmi3.c"/>
      <PreprocessorDefinition name="FMI3_OVERRIDE_FUNCTION_PREFIX" value="1"/>
    </SourceFileSet>"""


def write_fmu(model: Described, path: Path) -> None:
    """Write the archive.

    Its output is known after a step that begins where its input is set: an importer
    sees it one interval later, as of any discrete system.
    """
    files = contents(model)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            entry = zipfile.ZipInfo(name, NO_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text)


def contents(model: Described) -> dict[str, str]:
    """Give the text of each file in the archive."""
    source, header = c.source(model), c.header(model)
    token = str(uuid.UUID(hashlib.sha256((header + source).encode()).hexdigest()[:32]))
    wrapper = WRAPPER.read_text(encoding="utf-8")
    for key, text in {
        "@name@": model.name,
        "@NAME@": model.name.upper(),
        "@token@": token,
    }.items():
        wrapper = wrapper.replace(key, text)
    names = [model.input.name, model.output.name]
    if len({"time", *names}) < 3:
        names = [f"input {names[0]}", f"output {names[1]}"]
    units = dict.fromkeys([model.input.unit, model.output.unit])
    told = " ".join([f"{model.about}.", *model.differences])
    values = {
        "title": model.title,
        "name": model.name,
        "token": token,
        "about": told,
        "tool": f"hystbench {__version__}",
        "dt": repr(model.sampling.dt),
        "input": names[0],
        "output": names[1],
        "input_unit": model.input.unit,
        "output_unit": model.output.unit,
    }
    description = DESCRIPTION.format(
        units="\n".join(f"    <Unit name={quoteattr(unit)}/>" for unit in units),
        **{key: quoteattr(value) for key, value in values.items()},
    )
    return {
        "modelDescription.xml": description,
        "sources/buildDescription.xml": BUILD.format(
            name=model.name, files=FILES.format(name=model.name)
        ),
        f"sources/{model.name}.h": header,
        f"sources/{model.name}.c": source,
        "sources/fmi3.c": wrapper,
    }
