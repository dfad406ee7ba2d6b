"""A run whose scene cannot be made: its error lists the ports that the process listens on."""
import os
from pathlib import Path

from rockwear.kernels.checks import ParameterError
from rockwear.run.main import main

LISTENS = "0A"


def ports():
    """Ports of the TCP sockets of this process that listen."""
    ours = {os.readlink(entry) for entry in Path("/proc/self/fd").iterdir() if entry.is_symlink()}
    found = []
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/self/net/{table}").read_text(encoding="utf-8").splitlines()[1:]:
            cells = line.split()
            if cells[3] == LISTENS and f"socket:[{cells[9]}]" in ours:
                found.append(int(cells[1].rsplit(":", 1)[1], 16))
    return sorted(found)


def make_scene(values):
    raise ParameterError("ports", ports(), "listed")


main("ports", [], make_scene)
