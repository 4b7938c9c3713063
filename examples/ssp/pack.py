"""Make an SSP package (System Structure & Parameterization 1.0): of a vessel on two mooring lines,

    pip install pythonfmu
    moorline pack -o moorline.fmu
    pythonfmu build -f examples/osp/vessel.py
    python examples/ssp/pack.py vessel-on-two-lines.ssp examples/ssp moorline.fmu Vessel.fmu

or of a ship and its whole mooring, one FMU each:

    moorline pack examples/spread-moored-ship.json -o mooring.fmu
    pythonfmu build -f examples/osp/ship/ship.py
    python examples/ssp/pack.py moored-ship.ssp examples/ssp/ship mooring.fmu Ship.fmu

The package is read by OMSimulator, FMPy, easySSP and other tools for SSP.
"""

import pathlib
import sys
import zipfile


def pack(out: str, structure: str | pathlib.Path, *fmus: str | pathlib.Path) -> None:
    """Writes the system structure of a folder, its parameter sets and the FMUs into one archive."""
    structure = pathlib.Path(structure)
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(structure / "SystemStructure.ssd", "SystemStructure.ssd")
        for parameters in sorted((structure / "resources").glob("*.ssv")):
            archive.write(parameters, f"resources/{parameters.name}")
        for fmu in map(pathlib.Path, fmus):
            archive.write(fmu, f"resources/{fmu.name}")


if __name__ == "__main__":
    pack(*sys.argv[1:])
