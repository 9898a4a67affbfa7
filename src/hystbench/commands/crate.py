"""``hystbench crate``: pack results as an RO-Crate, for an archive."""

import platform
import re
from collections.abc import Iterator, Mapping
from importlib import metadata
from mimetypes import MimeTypes
from pathlib import Path
from typing import Any

import click

from hystbench.errors import InputError
from hystbench.files import whole_folder
from hystbench.libraries import library
from hystbench.options import Folder, In, OutFolder, command
from hystbench.written import ENTRIES, LOGS, is_ours
from hystbench.yaml_files import load_yaml

RO_CRATE_VERSION = "1.1"
"""The version that most archives read."""
WORKFLOW = "workflow/Snakefile"
CITATION = "CITATION.cff"
#: What is packed of the project beside the workflow itself.
PACKED_TOO = (
    *("Snakefile", "workflow/rules/*", "workflow/schemas/*", "workflow/report/*"),
    *("requirements.txt", CITATION, "LICENSE"),
)
#: Python's own table: that of the machine takes Snakemake's .smk for a video.
MIME_TYPES = MimeTypes()
#: Nothing checks that the results were made with it.
AS_GIVEN = {"name": "Settings as given"}
_NAME = re.compile(r"[\w.-]+")


@command
def crate(
    results: Folder,
    *,
    out: OutFolder,
    config: In = Path("config.yaml"),
    project: Folder = Path(),
) -> None:
    """Pack what hystbench wrote into RESULTS as an RO-Crate, for an archive.

    OUT is a new folder. It gets these files, the settings in CONFIG as given, the
    workflow and licence of PROJECT, and ro-crate-metadata.json: what each is, who made
    it, with which versions. Needs the package rocrate.
    """
    rocrate = library("rocrate.rocrate", "crate", "crate")
    if out.exists():
        raise InputError(f"{out}: there already; expected the name of a new folder")
    for name in (WORKFLOW, CITATION):
        if not (project / name).is_file():
            raise InputError(f"{project}: no {name}; expected hystbench's own folder")
    made = [path for path in sorted(results.rglob("*")) if is_ours(path)]
    if not made:
        raise InputError(f"{results}: no file in it that hystbench wrote")
    packed = rocrate.ROCrate(version=RO_CRATE_VERSION)
    workflow = _about(packed, project)
    settings = _add(packed, config, "config.yaml", AS_GIVEN)
    top = results.resolve().name
    found = [_add(packed, x, f"{top}/{x.relative_to(results)}") for x in made]
    run = {"name": "Run of the workflow"}
    packed.root_dataset["mentions"] = packed.add_action(
        workflow, "#run", object=[settings], result=found, properties=run
    )
    with whole_folder(out, ()) as fresh:
        packed.write(fresh)
    left = sum(1 for path in results.rglob("*") if _is_others(path, set(made)))
    said = f"; {left} that hystbench did not write stay out" if left else ""
    click.echo(f"{out}: {len(made)} files of {results}{said}")


def _is_others(path: Path, made: set[Path]) -> bool:
    """Tell whether a file is none of hystbench's, nor what it or Snakemake notes."""
    noted = {ENTRIES, LOGS} & set(path.parts) or path.name.startswith(".snakemake")
    return path.is_file() and path not in made and not noted


def _about(packed: Any, project: Path) -> Any:
    """Say what the crate is about, as CITATION.cff does; give the workflow, packed."""
    cited = load_yaml(project / CITATION)
    root, terms = packed.root_dataset, cited["license"]
    root["name"] = f"Results of {cited['title']}"
    root["description"] = (
        f"What the workflow of hystbench {cited['version']} wrote, and settings "
        "as given"
    )
    place = f"https://spdx.org/licenses/{terms}"
    root["license"] = _entity(packed, place, "CreativeWork", name=terms)
    root["keywords"] = cited["keywords"]
    root["author"] = [_author(packed, one) for one in cited["authors"]]
    root["citation"] = [
        _entity(
            packed, f"https://doi.org/{x['doi']}", "ScholarlyArticle", name=x["title"]
        )
        for x in cited["references"]
    ]
    workflow = packed.add_workflow(
        project / WORKFLOW,
        WORKFLOW,
        main=True,
        lang="snakemake",
        lang_version=metadata.version("snakemake"),
        properties={"name": cited["title"], "version": str(cited["version"])},
    )
    for key in ("author", "license"):
        workflow[key] = root[key]
    workflow["softwareRequirements"] = list(_software(packed))
    for pattern in PACKED_TOO:
        for path in sorted(project.glob(pattern)):
            _add(packed, path, str(path.relative_to(project)))
    return workflow


def _add(
    packed: Any, path: Path, place: str, about: Mapping[str, str] | None = None
) -> Any:
    """Add a file, with its size and what sort of file it is."""
    sort = MIME_TYPES.guess_type(path.name)[0]
    said = {**(about or {}), **({"encodingFormat": sort} if sort else {})}
    return packed.add_file(path, place, properties=said, record_size=True)


def _entity(packed: Any, place: str, kind: str, **about: str) -> Any:
    """Add what is no file, by what it is known as."""
    return packed.add_jsonld({"@id": place, "@type": kind, **about})


def _author(packed: Any, one: Mapping[str, str]) -> Any:
    """Add an author of CITATION.cff: a person, or a group by its name."""
    named = [one[key] for key in ("given-names", "family-names") if key in one]
    name = one.get("name", " ".join(named))
    place = one.get("orcid", f"#{name.replace(' ', '-')}")
    return _entity(packed, place, "Person" if named else "Organization", name=name)


def _software(packed: Any) -> Iterator[Any]:
    """Add Python, hystbench and what it needs, in the versions that are here."""
    needed = [x for x in metadata.requires("hystbench") or () if "extra ==" not in x]
    names = [found[0] for found in map(_NAME.match, needed) if found]
    versions = {name: metadata.version(name) for name in ("hystbench", *names)}
    versions["Python"] = platform.python_version()
    for name, version in versions.items():
        about = {"name": name, "version": version}
        yield _entity(packed, f"#{name}", "SoftwareApplication", **about)
