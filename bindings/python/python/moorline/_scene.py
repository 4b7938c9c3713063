"""Scenes as Python gives them."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from typing import Any, Union

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


def source(scene: Scene, changes: Mapping[str, Any] | None = None) -> Source:
    """A scene with changes, not read yet."""
    sets = [f"{place}={_text(place, value)}" for place, value in (changes or {}).items()]
    if isinstance(scene, Mapping):
        return Source(None, _text("scene", dict(scene)), ".", sets)
    if scene is not None and not isinstance(scene, (str, os.PathLike)):
        raise InputError(f"a scene is a dict, the path of a file or None, not {type(scene).__name__}")
    return Source(scene, None, ".", sets)


def _text(place: str, value: Any) -> str:
    try:
        return json.dumps(value, default=_plain)
    except (TypeError, ValueError) as error:
        raise InputError(f"{place}: the value cannot be written as JSON: {error}") from None


def warn(texts: list[str]) -> None:
    """Warns whoever called the function that calls this."""
    for text in texts:
        warnings.warn(text, Warning, stacklevel=3)
