"""A case of any family from its spec: an actuator or a machine."""

from hystbench.challenge.case import Case, make_case
from hystbench.challenge.machine_case import make_machine_case
from hystbench.challenge.plant.inside import MACHINES
from hystbench.challenge.spec import CaseSpec


def make(spec: CaseSpec) -> Case:
    """Make a case; the same spec gives the same numbers."""
    return make_machine_case(spec) if spec.family in MACHINES else make_case(spec)
