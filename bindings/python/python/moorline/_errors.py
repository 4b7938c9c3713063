"""What can go wrong."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Any failure of moorline; its text says what is wrong, where, and what to change.

    Attributes: ``file`` the scene's file, ``place`` in the scene such as ``lines[0].sections[0].length``, ``value`` found there; each None
    where it is not known. ``results``: of a run that ended early, what came before; of statics, the best state found; else None.
    """

    file: str | None = None
    place: str | None = None
    value: str | None = None
    results: Any = None


class InputError(Error, ValueError):
    """The scene, or what was asked, is not allowed."""


class ConvergenceError(Error, ArithmeticError):
    """No equilibrium was found, or a time step could not be taken."""


class Warning(UserWarning):
    """What is allowed, but may not be meant."""
