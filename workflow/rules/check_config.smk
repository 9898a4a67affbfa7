# config.yaml, before Snakemake reads it: of a key that stands twice it would keep the
# later one in silence. Files of --configfile are merged by now, and looked at all the same.
import sys

from hystbench.errors import InputError
from hystbench.yaml_files import load_yaml


def refuse(error):
    """Tell a mistake of the user's in one line, with the status of one."""
    print(f"hystbench: {error}", file=sys.stderr)
    sys.exit(2)


try:
    for file in dict.fromkeys(["config.yaml", *(workflow.overwrite_configfiles or [])]):
        load_yaml(file)
except InputError as error:
    refuse(error)
