"""Recordings of any kind, prepared for the trainer and the classifier."""

from collections.abc import Mapping
from os import PathLike, fspath
from typing import Any, NamedTuple

import numpy as np

from vibrissa import _core

#: The rate of recordings that do not say theirs, Hz.
USUAL_RATE = 2000


class Prepared(NamedTuple):
    """What the core takes of a recording."""

    name: str
    streams: list[tuple[str, str, int, int, str | None, tuple[float, float] | None]]
    samples: np.ndarray
    contact: np.ndarray | None
    touch: np.ndarray | None


def _column(recording: Any, name: str) -> Any:
    """A column of a structured array, a mapping or a table; None if it has none."""
    names = getattr(getattr(recording, "dtype", None), "names", None)
    if names is None:
        if not hasattr(recording, "keys"):
            raise TypeError(
                f"recording: found {type(recording)}, allowed: a path, or a structured array, a "
                "dictionary or a table that has the columns of a recording"
            )
        names = list(recording.keys())
    if name not in names:
        return None
    values = recording[name]
    if isinstance(values, np.ma.MaskedArray):
        # What is masked is missing.
        return values.astype(object).filled(np.nan)
    return np.asarray(values)


def _is_missing(value: Any) -> bool:
    try:
        return value is None or bool(value != value)
    except TypeError:  # pandas.NA
        return True


def _tokens(name: str, column: str, values: np.ndarray) -> np.ndarray:
    """Labels or trials as text; those that are missing are refused by their row."""
    if values.dtype.kind == "U":
        # As blanks about cells of a file.
        return np.char.strip(values)
    if values.dtype.kind in "iub":
        return values
    for row, value in enumerate(values):
        if _is_missing(value):
            raise ValueError(f"{name}: row {row}: the {column} is missing")
    texts = [value.decode() if isinstance(value, bytes) else str(value) for value in values]
    return np.char.strip(np.asarray(texts, dtype=str))


def _poses(poses: np.ndarray | None, rows: int) -> np.ndarray:
    """The pose of each row as text; where it is missing, that of the row before."""
    if poses is None:
        return np.zeros(rows, dtype=str)
    names = np.asarray([_pose(poses, row) or "" for row in range(rows)], dtype=str)
    last = np.maximum.accumulate(np.where(names == "", 0, np.arange(rows)))
    return names[last]


def _pose(poses: np.ndarray | None, row: int) -> str | None:
    if poses is None or _is_missing(poses[row]):
        return None
    return str(poses[row]).strip() or None


def _stands(
    name: str, of_row: dict[str, np.ndarray | None], row: int
) -> tuple[float, float] | None:
    """Tilt and depth, where both are there."""
    given = {column: values[[row]] for column, values in of_row.items() if values is not None}
    empty = [_is_missing(one) or str(one).strip() == "" for (one,) in given.values()]
    if len(given) < len(of_row) or any(empty):
        return None
    tilt, depth = (float(_numbers(name, column, one, row)[0]) for column, one in given.items())
    return tilt, depth


def _touches(name: str, values: np.ndarray) -> np.ndarray:
    """Numbers of touches, or truths."""
    if values.dtype.kind in "iub":
        wrong = np.flatnonzero((values < 0) | (values > 65535))
    else:
        wrong = [row for row, value in enumerate(values) if not _is_touch(value)]
    for row in wrong[:1]:
        raise ValueError(
            f"{name}: row {row}: touch: found {str(values[row])!r}, "
            "allowed: whole numbers from 0 to 65535"
        )
    return values.astype(np.uint16)


def _is_touch(value: Any) -> bool:
    if isinstance(value, (str, bytes)) or _is_missing(value):
        return False
    return 0 <= value <= 65535 and int(value) == value


def _numbers(name: str, column: str, values: np.ndarray, first: int = 0) -> np.ndarray:
    """As numbers of double precision; what is none is refused by its row."""
    try:
        return np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        for row, value in enumerate(values, first):
            try:
                float(value)
            except (TypeError, ValueError):
                fault = f"{column} is {str(value)!r}, not a finite number"
                raise ValueError(f"{name}: row {row}: {fault}") from None
        raise


def prepared(name: str, recording: Any, channels: tuple[str, str]) -> Prepared:
    if len(channels) != 2:
        raise ValueError(f"channels: found {channels!r}, two are needed")
    if channels[0] == channels[1]:
        raise ValueError(f"channels: both are {channels[0]!r}, two are needed")
    found = {column: _column(recording, column) for column in ("label", "trial", *channels)}
    missing = [column for column, values in found.items() if values is None]
    if missing:
        raise ValueError(f"{name}: no column {missing[0]!r}; a recording has {', '.join(found)}")
    label, trial, *_ = found.values()
    if label.ndim != 1:
        raise ValueError(f"{name}: label has the shape {label.shape}, allowed: one row a sample")
    label, trial = _tokens(name, "label", label), _tokens(name, "trial", trial)
    contact, touch = _column(recording, "contact"), _column(recording, "touch")
    pose = _column(recording, "pose")
    stands = {column: _column(recording, column) for column in ("tilt_deg", "depth_deg")}
    columns = {**found, "contact": contact, "touch": touch, "pose": pose, **stands}
    for column, values in columns.items():
        if values is not None and values.shape != label.shape:
            raise ValueError(f"{name}: {column} has the shape {values.shape}, not {label.shape}")
    if touch is not None:
        touch = _touches(name, touch)
    named = _poses(pose, len(label))
    differ = [column[1:] != column[:-1] for column in (label, trial, named)]
    changes = np.flatnonzero(np.any(differ, axis=0)) + 1
    ends = [0, *changes.tolist(), len(label)]
    streams = [
        (str(label[a]), str(trial[a]), a, b, _pose(pose, a), _stands(name, stands, a))
        for a, b in zip(ends, ends[1:])
        if b > a
    ]
    return Prepared(
        name,
        streams,
        np.column_stack([_numbers(name, column, found[column]) for column in channels]),
        None if contact is None else _numbers(name, "contact", contact),
        None if touch is None else np.ascontiguousarray(touch),
    )


def named(recordings: Any, channels: tuple[str, str]) -> list[tuple[str, Any]]:
    """Recordings with their names: one or several, read where they are paths."""
    if isinstance(recordings, Mapping) and "label" not in recordings:
        if not any(isinstance(one, (str, PathLike)) or _is_table(one) for one in recordings.values()):
            raise ValueError("recording: no column 'label', and no recordings by their names")
        all_of_them = [(str(name), one) for name, one in recordings.items()]
    elif isinstance(recordings, (list, tuple)):
        all_of_them = [(_name(one, f"recording {n}"), one) for n, one in enumerate(recordings, 1)]
    else:
        all_of_them = [(_name(recordings, "recording"), recordings)]
    if not all_of_them:
        raise ValueError("recordings: found none, allowed: one or more")
    return [
        (name, _core.read(one, channels=channels) if isinstance(one, (str, PathLike)) else one)
        for name, one in all_of_them
    ]


def _is_table(recording: Any) -> bool:
    names = getattr(getattr(recording, "dtype", None), "names", None)
    return names is not None or hasattr(recording, "keys")


def _name(recording: Any, otherwise: str) -> str:
    return fspath(recording) if isinstance(recording, (str, PathLike)) else otherwise


def _own_rate(recording: Any) -> int | None:
    """The rate that a recording knows: what ``record`` returns by its type, a table by ``attrs``."""
    metadata = getattr(getattr(recording, "dtype", None), "metadata", None)
    attributes = metadata or getattr(recording, "attrs", None) or {}
    rate = attributes.get("tick_hz")
    if rate is not None and (not isinstance(rate, (int, np.integer)) or rate < 1):
        raise ValueError(f"tick_hz: found {rate!r}, allowed: a whole number above 0")
    return rate


def rate_of(named: list[tuple[str, Any]], rate: int | None) -> int:
    """The rate of all; what contradicts it is refused, and what leaves it open where another says
    that it is not the usual one."""
    own_rates = {name: _own_rate(recording) for name, recording in named}
    silent = [name for name, own in own_rates.items() if own is None]
    others = [name for name, own in own_rates.items() if own not in (None, USUAL_RATE)]
    if rate is None and silent and others:
        raise ValueError(
            f"{others[0]}: tick_hz is {own_rates[others[0]]}, {silent[0]}: tick_hz is not said; "
            "say what both have by rate"
        )
    said = said_rate(named, rate)
    return USUAL_RATE if said is None else said


def said_rate(named: list[tuple[str, Any]], rate: int | None = None) -> int | None:
    """The rate that is said, by all who say one; what contradicts it is refused."""
    said = "rate"
    for name, recording in named:
        own = _own_rate(recording)
        if own is None:
            continue
        if rate is not None and own != rate:
            raise ValueError(f"{said}: found {rate}, {name}: tick_hz has {own}")
        said, rate = f"{name}: tick_hz", own
    return rate
