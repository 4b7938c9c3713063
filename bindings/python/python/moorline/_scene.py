"""Scenes as Python gives them."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from typing import Any, NamedTuple, Union

from moorline._errors import InputError, Warning
from moorline._moorline import Source

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any], None]
"""A scene: a dict with the keys of a scene file, the path of such a file or of a CABLE file, or None for the built-in case."""


def _plain(value: Any) -> Any:
    """What NumPy has made, as JSON knows it."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError


class Parts(NamedTuple):
    """A scene that can travel: a file, or text with the folder that its paths are relative to; neither is the built-in case."""

    path: str | None
    text: str | None
    directory: str


def parts(scene: Scene) -> Parts:
    """A scene, not read yet."""
    if isinstance(scene, Mapping):
        return Parts(None, _text("scene", dict(scene)), ".")
    if scene is not None and not isinstance(scene, (str, os.PathLike)):
        raise InputError(f"a scene is a dict, the path of a file or None, not {type(scene).__name__}")
    return Parts(None if scene is None else os.fspath(scene), None, ".")


def sourced(scene: Parts, changes: Mapping[str, Any] | None = None) -> Source:
    """A scene with changes, not read yet."""
    return Source(scene.path, scene.text, scene.directory, [f"{place}={_text(place, value)}" for place, value in (changes or {}).items()])


def source(scene: Scene, changes: Mapping[str, Any] | None = None) -> Source:
    """The same of a scene as a user gives it."""
    return sourced(parts(scene), changes)


def _text(place: str, value: Any) -> str:
    try:
        return json.dumps(value, default=_plain)
    except (TypeError, ValueError) as error:
        raise InputError(f"{place}: the value cannot be written as JSON: {error}") from None


def warn(texts: list[str]) -> None:
    """Warns whoever called the function that calls this."""
    for text in texts:
        warnings.warn(text, Warning, stacklevel=3)
