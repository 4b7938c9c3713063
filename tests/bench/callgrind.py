"""Instructions of the time loop, counted by valgrind's callgrind."""

import re
import shutil
import sys
import tempfile
from pathlib import Path

from measure import Run

#: All that happens between two output times; statics and output stay outside.
COUNTED = "*Simulation>::go"


def ready():
    """Ends the program where nothing can be counted."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is missing (Debian: apt-get install valgrind)")
    flags = re.search(r"^flags\s*:(.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)
    if flags is None or not {"avx2", "fma"} <= set(flags.group(1).split()):
        sys.exit("this machine has no AVX2 and FMA: its count would be that of another kernel")


def count(scene, **solver):
    """A run under callgrind: its summary and its instructions."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "callgrind.out")
        tool = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={file}", f"--toggle-collect={COUNTED}"]
        run = Run(scene, wrapper=tool, **solver)
        found = re.search(r"Collected : (\d+)", run.said)
    if found is None or int(found.group(1)) == 0:
        sys.exit(f"callgrind counted nothing in {COUNTED}: does the build have symbols?\n{run.said}")
    return run.summary, int(found.group(1))
