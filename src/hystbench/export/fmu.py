"""A model as a source FMU for co-simulation, of FMI 2.0 or 3.0."""

from __future__ import annotations

import hashlib
import uuid
import zipfile
from pathlib import Path
from typing import Literal
from xml.sax.saxutils import quoteattr

from hystbench import __version__
from hystbench.export import c
from hystbench.export.described import Described

#: The major version of FMI, and by its name.
Version = Literal[2, 3]
VERSIONS: dict[str, Version] = {"2": 2, "3": 3}
#: What the functions of every version call.
SHARED = Path(__file__).with_name("hb_unit.h")
#: The files of an archive have no time of their own: the same model, the same bytes.
NO_TIME = (1980, 1, 1, 0, 0, 0)

DESCRIPTIONS: dict[Version, str] = {
    2: """\
<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName={title} guid={token}
    description={about} generationTool={tool}>
  <CoSimulation modelIdentifier={name} canHandleVariableCommunicationStepSize="true"
      canGetAndSetFMUstate="true" canNotUseMemoryManagementFunctions="true">
    <SourceFiles>
      <File name={source}/>
      <File name="fmi2.c"/>
    </SourceFiles>
  </CoSimulation>
  <UnitDefinitions>
{units}
  </UnitDefinitions>
  <DefaultExperiment startTime="0" stepSize={dt}/>
  <ModelVariables>
    <ScalarVariable name="time" valueReference="0" causality="independent"
        variability="continuous">
      <Real/>
    </ScalarVariable>
    <ScalarVariable name={input} valueReference="1" causality="input"
        variability="discrete">
      <Real unit={input_unit} start="0"/>
    </ScalarVariable>
    <ScalarVariable name={output} valueReference="2" causality="output"
        variability="discrete">
      <Real unit={output_unit}/>
    </ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs>
      <Unknown index="3" dependencies=""/>
    </Outputs>
    <InitialUnknowns>
      <Unknown index="3" dependencies=""/>
    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
""",
    3: """\
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
""",
}

#: How the sources are built; later releases of FMI 2.0 have this file of FMI 3.0 too.
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
      <SourceFile name="fmi{fmi}.c"/>
      <PreprocessorDefinition name="FMI{fmi}_OVERRIDE_FUNCTION_PREFIX" value="1"/>
    </SourceFileSet>"""


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
    description = DESCRIPTIONS[fmi].format(
        units="\n".join(f"    <Unit name={quoteattr(unit)}/>" for unit in units),
        **{key: quoteattr(value) for key, value in values.items()},
    )
    return {
        "modelDescription.xml": description,
        "sources/buildDescription.xml": BUILD.format(
            name=model.name, files=FILES.format(name=model.name, fmi=fmi)
        ),
        f"sources/{model.name}.h": header,
        f"sources/{model.name}.c": source,
        **{
            f"sources/{path.name}": _filled(path, model.name, token)
            for path in (SHARED, SHARED.with_name(f"fmi{fmi}.c"))
        },
    }


def _filled(path: Path, name: str, token: str) -> str:
    """Read C that is the same for all models but for these words."""
    text = path.read_text(encoding="utf-8")
    for key, word in {"@name@": name, "@NAME@": name.upper(), "@token@": token}.items():
        text = text.replace(key, word)
    return text
