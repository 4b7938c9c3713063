"""Makes the wheel: maturin's build backend, with the FMU's library put into the package first, so that `moorline.pack` needs no compiler.

cargo makes that library whenever it makes the Rust library that the extension is built on; here it is asked where. It is asked for the extension,
so that what it builds is what maturin asks for next, and the solver is built once.
"""

import json
import os
import shutil
import subprocess
from pathlib import Path

import maturin
from maturin import (  # noqa: F401 (the rest of the interface is maturin's)
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

HERE = Path(__file__).resolve().parent.parent
FOLDERS = {".so": ("linux64", "moorline.so"), ".dll": ("win64", "moorline.dll"), ".dylib": ("darwin64", "moorline.dylib")}


def place_library() -> None:
    """Builds the FMU's library and copies it into the package."""
    command = ["cargo", "build", "--release", "--locked", "--manifest-path", str(HERE / "Cargo.toml"), "--package", "moorline-python"]
    # The extension finds Python when Python loads it.
    environment = os.environ | {"PYO3_BUILD_EXTENSION_MODULE": "1"}
    command += ["--message-format", "json-render-diagnostics"]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True, env=environment)
    files = [
        Path(file)
        for message in map(json.loads, done.stdout.splitlines())
        if message.get("reason") == "compiler-artifact" and message["target"]["name"] == "moorline"
        for file in message["filenames"]
    ]
    libraries = [file for file in files if file.suffix in FOLDERS]
    if not libraries:
        raise SystemExit("cargo has made no shared library of moorline")
    shutil.rmtree(HERE / "python/moorline/binaries", ignore_errors=True)
    for file in libraries:
        folder, name = FOLDERS[file.suffix]
        place = HERE / "python/moorline/binaries" / folder
        os.makedirs(place, exist_ok=True)
        shutil.copyfile(file, place / name)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    place_library()
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    place_library()
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory, config_settings=None):
    return maturin.build_sdist(sdist_directory, config_settings)
