"""Commands of the workflow's jobs, in processes that have imported what they use.

A job's import of its libraries is most of what a small run takes. A server forks
itself for each ``hystbench`` that bash is to start. Programs that import by themselves
are started by test_strangers.py, and by the tests of the command line.
"""

from __future__ import annotations

import atexit
import json
import os
import shutil
import signal
import socket
import sys
import tempfile
from collections.abc import Callable
from multiprocessing.context import ForkServerContext
from pathlib import Path

#: What bash starts: it hands over what a program gets, and waits for the status.
CLIENT = """\
#!{python} -SE
import json, os, socket, sys

with socket.socket(socket.AF_UNIX) as server:
    server.connect({address!r})
    given = json.dumps([os.getcwd(), sys.argv[1:], dict(os.environ)]).encode()
    socket.send_fds(server, [b"%20d" % len(given)], [0, 1, 2])
    server.sendall(given)
    status = server.recv(1)
sys.exit(status[0] if status else "hystbench: the process was ended")
"""
#: Bash reads it before a command; a function comes before what is on the path.
FOR_BASH = 'hystbench() {{ {client} "$@"; }}\n'


def serve(address: str, prepare: Callable[[], None]) -> None:
    """Answer each client by a process of its own, until it is told to end."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for them
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(address)
        listening.listen(64)
        while True:
            client, _ = listening.accept()
            with client:
                if os.fork() == 0:
                    listening.close()
                    answer(client, prepare)


def answer(client: socket.socket, prepare: Callable[[], None]) -> None:
    """Take the place of a program, and end with its status."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    status = 1
    try:
        head, streams, _, _ = socket.recv_fds(client, 20, 3)
        with client.makefile("rb") as given:
            folder, words, environment = json.loads(given.read(int(head)))
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
            os.close(stream)
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(environment)
        prepare()
        sys.argv = ["hystbench", *words]
        from hystbench import cli

        status = cli.run()
    finally:
        if sys.exc_info()[0] is not None:
            sys.excepthook(*sys.exc_info())
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        client.send(bytes([status]))
        os._exit(status)


def started(forking: ForkServerContext, prepare: Callable[[], None]) -> Path:
    """Start a server; give the file that bash is to read."""
    folder = Path(tempfile.mkdtemp(prefix="hystbench-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    address, client = folder / "socket", folder / "hystbench"
    client.write_text(CLIENT.format(python=sys.executable, address=str(address)))
    client.chmod(0o700)
    (folder / "bash").write_text(FOR_BASH.format(client=client))
    # No daemon, as a solver's job has processes of its own; it ends with the tests.
    server = forking.Process(target=serve, args=(str(address), prepare))
    atexit.register(server.terminate)
    server.start()
    while not address.exists():
        server.join(0.01)
        assert server.is_alive()
    return folder / "bash"
