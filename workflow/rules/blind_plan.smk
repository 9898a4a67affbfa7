# The blind contest: `snakemake blind`. Data are made, solved and thrown away chunk by
# chunk. A solver's job has the data as its only input; the truth is in no file until
# the judge, who has the answers as input, makes it anew from the seeds.
import math

from hystbench.challenge.contest.plan import numbers, plan
from hystbench.challenge.spec import LEFT_OUT_GROUP
from hystbench.errors import nearest

CONTEST = config["blind"]
# Machines have a score of their own, beside that of actuators.
OF_MACHINES = CONTEST["set"].startswith("mechanisms")
BLIND = "results/blind-mechanisms" if OF_MACHINES else "results/blind"
PLANT_KERNELS = sorted(map(str, PACKAGE.glob("challenge/kernels/*.so")))
# The set that is judged, with all solvers, and the transfer set, with one.
TRANSFER = "mechanisms-transfer" if OF_MACHINES else "transfer"
BLIND_SOLVERS = {CONTEST["set"]: list(CONTEST["solvers"])}
if CONTEST["transfer_scale"]:
    BLIND_SOLVERS[TRANSFER] = [CONTEST["solver"]]
if OF_MACHINES and CONTEST["left_out_scale"]:
    refuse(
        f"{PLACE}: blind: left_out_scale: {CONTEST['left_out_scale']:g} with the set "
        f"{CONTEST['set']!r}; expected 0, as it belongs to the set of actuators"
    )
if CONTEST["solver"] not in CONTEST["solvers"]:
    refuse(
        f"{PLACE}: blind: solver: {CONTEST['solver']!r}; "
        + nearest(CONTEST["solver"], CONTEST["solvers"])
    )
# Each effect of the set in turn is left out of what a solver may name.
LEFT_OUT = {}
if CONTEST["left_out_scale"]:
    if "left_out" not in CONTEST["solvers"][CONTEST["solver"]]:
        refuse(
            f"{PLACE}: blind: solvers: {CONTEST['solver']}: left_out: missing; expected "
            "the words that keep it from naming {effect}, or left_out_scale: 0"
        )
    LEFT_OUT = {
        f"left-out-{effect}": effect
        for effect in sorted(
            {
                entry.spec.effects[0]
                for entry in plan("left-out", CONTEST["left_out_scale"])
            }
        )
    }
    BLIND_SOLVERS |= {name: [CONTEST["solver"]] for name in LEFT_OUT}


def blind_cases(name):
    """Which cases of a set are held: how many, and of which kinds."""
    if name in LEFT_OUT:
        return {
            "name": "left-out",
            "scale": CONTEST["left_out_scale"],
            "without": [],
            "only": [LEFT_OUT[name]],
            "group": LEFT_OUT_GROUP,
        }
    return {
        "name": name,
        "scale": CONTEST["transfer_scale" if name == TRANSFER else "scale"],
        "without": CONTEST["without"],
        "only": CONTEST["only"],
        # As a setting, so that another group makes all cases anew.
        "group": LEFT_OUT_GROUP,
    }


def blind_chunks(name):
    """Numbers of the chunks of a set."""
    return numbers(len(plan(**blind_cases(name))), CONTEST["chunk"])


def blind_entrants(wildcards):
    """Who enters with a chunk: all, or those whose share reaches it."""
    every = blind_chunks(wildcards.set)
    before = every.index(wildcards.chunk) / len(every)
    return [
        solver
        for solver in BLIND_SOLVERS[wildcards.set]
        if solver == CONTEST["solver"]
        or before < CONTEST["solvers"][solver].get("share", 1)
    ]


def blind_case_settings(wildcards):
    """Which cases a chunk holds."""
    return settings_text(
        {
            "plan": blind_cases(wildcards.set),
            "size": CONTEST["chunk"],
            "chunk": wildcards.chunk,
        }
    )


def blind_solver_settings(wildcards):
    """How a solver is run."""
    about = CONTEST["solvers"][wildcards.solver]
    effect = LEFT_OUT.get(wildcards.set)
    without = about["left_out"] if effect else []
    return settings_text(
        {
            "name": wildcards.solver,
            "command": about["command"]
            + [word.replace("{effect}", effect) for word in without],
            "time_limit_s": about["time_limit_s"],
            "keep": CONTEST["keep"],
        }
    )


def blind_solver_minutes(wildcards):
    """The longest that a solver can take for a chunk, and some minutes beside."""
    limit = CONTEST["solvers"][wildcards.solver]["time_limit_s"]
    return math.ceil(CONTEST["chunk"] * limit / 60) + 10


def blind_solver_code(wildcards):
    """Source of a solver of hystbench's own; of others only the command is known."""
    command = CONTEST["solvers"][wildcards.solver]["command"]
    modules = ["hystbench.commands.jobs.blind_solve"]
    if command[0] == "hystbench":
        called = f"hystbench.commands.{command[1].replace('-', '_')}"
        modules += [called] if called in GRAPH.modules else []
        if command[1] == "rival":
            # Rivals are found by name too, and only here.
            from hystbench.entrants.rivals import rivals

            known = rivals(command[2])
            return code_with([known[x] for x in command[2:3] if x in known], *modules)
        if command[1] == "gap":
            # Effects are found by name, so that no import tells of them.
            modules += sorted(GRAPH.find_descendants("hystbench.gap"))
    return code(*modules)


def blind_data(path):
    """Thrown away when solved, unless the settings keep it."""
    return directory(path) if CONTEST["keep_data"] else temp(directory(path))
