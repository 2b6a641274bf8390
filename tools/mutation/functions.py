"""Functions that a change of a module touches, and their replacement in a process that runs."""

from __future__ import annotations

import gc
import inspect
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from types import CodeType, FunctionType

Change = tuple[CodeType, CodeType]
"""Code of a function before and after."""


def changed_functions(before: str, after: str, filename: str) -> list[Change] | None:
    """Return the functions that two texts of a module have differently.

    Returns
    -------
    None if something else differs too: what runs when the module is imported.
    """
    old, new = (compile(text, filename, "exec", dont_inherit=True) for text in (before, after))
    changes = list(_changes(old, new))
    return changes if all(_is_function(code) for code, _ in changes) else None


def replace(changes: Sequence[Change]) -> None:
    """Give the functions of this process their changed code; those not yet imported are left.

    A function that another one has returned already, such as a closure of a table, is changed too.
    """
    # A weak proxy of what is gone has no class that `isinstance` could ask for.
    functions = [each for each in gc.get_objects() if type(each) is FunctionType]
    for old, new in _with_inner(changes):
        for function in functions:
            if _place(function.__code__) == _place(old):
                function.__code__ = new


def _with_inner(changes: Sequence[Change]) -> Iterator[Change]:
    """Yield changes, and those of the functions within that have the same variables of others."""
    for old, new in changes:
        yield old, new
        pairs = zip(_inner(old), _inner(new), strict=False)
        yield from _with_inner([(a, b) for a, b in pairs if a.co_freevars == b.co_freevars])


def _changes(old: CodeType, new: CodeType) -> Iterator[Change]:
    """Yield the outermost codes that differ."""
    if _is_function(old):
        if _content(old) != _content(new):
            yield old, new
        return
    if _own_content(old) != _own_content(new):
        yield old, new
    for inner_old, inner_new in zip_longest(_inner(old), _inner(new)):
        yield from _changes(inner_old, inner_new)


def _is_function(code: CodeType) -> bool:
    """Return whether code is that of a function which outlives the import of its module."""
    is_comprehension = code.co_name.startswith("<") and code.co_name != "<lambda>"
    return bool(code.co_flags & inspect.CO_OPTIMIZED) and not is_comprehension


def _inner(code: CodeType) -> list[CodeType]:
    return [value for value in code.co_consts if isinstance(value, CodeType)]


def _own_content(code: CodeType) -> tuple[object, ...]:
    """Return what code does, apart from the code within it and from its lines and columns."""
    values = [repr(value) for value in code.co_consts if not isinstance(value, CodeType)]
    return code.co_code, values, code.co_names, code.co_varnames, code.co_freevars


def _content(code: CodeType) -> tuple[object, ...]:
    return *_own_content(code), *(_content(inner) for inner in _inner(code))


def _place(code: CodeType) -> tuple[str, str, int]:
    return code.co_filename, code.co_qualname, code.co_firstlineno
