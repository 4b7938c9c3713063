"""Make an SSP package (System Structure & Parameterization 1.0) of a vessel on two mooring lines.

    pip install pythonfmu
    moorline pack -o moorline.fmu
    pythonfmu build -f examples/osp/vessel.py
    python examples/ssp/pack.py moorline.fmu Vessel.fmu vessel-on-two-lines.ssp

The package is read by OMSimulator, FMPy, easySSP and other tools for SSP.
"""

import pathlib
import sys
import zipfile

HERE = pathlib.Path(__file__).parent


def pack(line: str, vessel: str, out: str) -> None:
    """Writes the system structure, its parameter sets and the two FMUs into one archive."""
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(HERE / "SystemStructure.ssd", "SystemStructure.ssd")
        for parameters in sorted((HERE / "resources").glob("*.ssv")):
            archive.write(parameters, f"resources/{parameters.name}")
        archive.write(line, "resources/moorline.fmu")
        archive.write(vessel, "resources/Vessel.fmu")


if __name__ == "__main__":
    pack(*sys.argv[1:4])
