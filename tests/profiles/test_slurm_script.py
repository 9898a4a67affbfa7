"""Slurm's test: where it refuses to begin, and the node that it makes."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[2] / "profiles" / "slurm" / "test"
BASH = shutil.which("bash")
USED = ("awk", "dirname", "nproc", "realpath")


@pytest.fixture
def programs(tmp_path):
    """Folder of all programs that the script finds: none of Slurm's, no apt-get."""
    folder = tmp_path / "programs"
    folder.mkdir()
    for name in USED:
        (folder / name).symlink_to(shutil.which(name))
    return folder


def tells(programs, name, answer):
    """Put a program in the folder that says always the same."""
    path = programs / name
    path.unlink(missing_ok=True)
    path.write_text(f"#!{BASH}\necho {answer}\n")
    path.chmod(0o755)


def started(programs):
    words = [BASH, str(SCRIPTS / "run"), str(programs)]
    environment = {"PATH": str(programs)}
    return subprocess.run(
        words, capture_output=True, text=True, check=False, env=environment
    )


def test_another_user_than_root_is_refused_in_one_line(programs):
    tells(programs, "id", 1000)
    done = started(programs)
    told = "make test-slurm: it installs and starts Slurm, so it must run as root\n"
    assert (done.returncode, done.stdout, done.stderr) == (1, "", told)


@pytest.mark.parametrize(
    ("free_mb", "told"),
    [
        (
            20_000,
            "slurmctld was not found, and neither was apt-get to install it (Debian)",
        ),
        (900, "900 MB of memory to spare, at least 1000 expected"),
    ],
)
def test_no_slurm_no_apt_and_no_memory_are_refused_in_one_line(programs, free_mb, told):
    if Path("/etc/slurm/slurm.conf").exists():
        pytest.skip("this machine has a Slurm of its own, which is refused first")
    tells(programs, "id", 0)
    tells(programs, "awk", free_mb)  # in place of this machine's memory
    done = started(programs)
    told = f"make test-slurm: {told}\n"
    assert (done.returncode, done.stdout, done.stderr) == (1, "", told)


@pytest.mark.parametrize(
    ("processors", "free_mb", "size"),
    [
        (2, 20_000, "2 18000"),  # nine tenths of the memory
        (64, 20_000, "18 18000"),  # and 1000 MB for each CPU
        (4, 1000, "0 900"),
    ],
)
def test_the_node_is_as_large_as_the_machine(
    tmp_path, programs, processors, free_mb, size
):
    meminfo = tmp_path / "meminfo"
    meminfo.write_text(
        f"MemTotal: 99999999 kB\nMemAvailable: {free_mb * 1024} kB\nBuffers: 1 kB\n"
    )
    tells(programs, "nproc", processors)
    script = f'. "{SCRIPTS}/slurm.sh"; node_size 1000 "{meminfo}"'
    done = subprocess.run(
        [BASH, "-c", script],
        capture_output=True,
        text=True,
        check=True,
        env={"PATH": str(programs)},
    )
    assert done.stdout == size + "\n"


def test_the_node_has_no_more_than_this_process_may_use(tmp_path):
    (tmp_path / "meminfo").write_text("MemAvailable: 20000000 kB\n")
    script = f'. "{SCRIPTS}/slurm.sh"; node_size 1 "{tmp_path}/meminfo"'
    one = sorted(os.sched_getaffinity(0))[0]
    done = subprocess.run(
        [BASH, "-c", script],
        capture_output=True,
        text=True,
        check=True,
        preexec_fn=lambda: os.sched_setaffinity(0, {one}),
    )
    assert done.stdout.split()[0] == "1"


@pytest.mark.parametrize("name", ["run", "slurm.sh"])
def test_the_scripts_are_bash(name):
    subprocess.run([BASH, "-n", str(SCRIPTS / name)], check=True)
