"""Models from recordings, and what they are worth."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from whisker import _core


#: The rate of recordings that do not say theirs, Hz.
USUAL_RATE = 2000


class Share(NamedTuple):
    """A share with its 95 % interval, and of how many."""

    share: float
    low: float
    high: float
    of: int


class Evaluation(NamedTuple):
    """What a model is worth on a recording that it was not trained on.

    Hits, samples and calibration are of decisions that named a class, on labels that the model
    knows; ``strange`` is of labels that it does not know.
    """

    hits: float | None
    """Share of right decisions, mean over the classes presented but those of ``left_out``."""
    samples: float
    """Mean samples of contact of a decision."""
    samples_error: float
    """Its standard error, as if decisions were independent."""
    stated: float
    """Mean posterior of the decisions."""
    found: Share
    """Share of decisions that were right: what ``stated`` should be."""
    refused: Share
    """Share of decisions that said "unknown"."""
    strange: Share
    """The same on labels that the model does not know."""
    undecided: Share
    """Share of streams in which no class was named."""
    calibration: np.ndarray
    """Stated against found, a row a bin."""
    classes: np.ndarray
    """The figures of each class."""
    confusion: str
    """The confusion matrix as text."""
    left_out: list[str]
    """The classes presented of which no decision named a class: they have no share of hits."""


class Why(NamedTuple):
    """Why a decision names no class."""

    reason: str | None
    """"unknown", "pose" or "between"; None where a class is named."""
    among: tuple[str, str] | None
    """The two classes of "between", the likelier one first; otherwise None."""


def why(decision: Any) -> Why:
    """Why a decision names no class: of a row of ``classify`` or of ``Sim.decisions``."""
    leader, is_between, rival = str(decision["among"]).partition("|")
    return Why(str(decision["reason"]) or None, (leader, rival) if is_between else None)


class _Prepared(NamedTuple):
    name: str
    streams: list[tuple[str, str, int, int, str | None]]
    samples: np.ndarray
    contact: np.ndarray | None
    touch: np.ndarray | None


def _column(recording: Any, name: str) -> Any:
    """A column of a structured array, a mapping or a table; None if it has none."""
    names = getattr(getattr(recording, "dtype", None), "names", None)
    if names is None:
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
    if values.dtype.kind in "iubU":
        return values
    for row, value in enumerate(values):
        if _is_missing(value):
            raise ValueError(f"{name}: row {row}: the {column} is missing")
    texts = [value.decode() if isinstance(value, bytes) else str(value) for value in values]
    return np.asarray(texts, dtype=str)


def _pose(poses: np.ndarray | None, row: int) -> str | None:
    if poses is None or _is_missing(poses[row]) or str(poses[row]) == "":
        return None
    return str(poses[row])


def _touches(name: str, values: np.ndarray) -> np.ndarray:
    """Numbers of touches, or truths."""
    for row, value in enumerate(values if values.dtype.kind in "Of" else ()):
        if _is_missing(value) or not 0 <= value <= 65535:
            raise ValueError(
                f"{name}: row {row}: touch: found {value!r}, allowed: whole numbers from 0 to 65535"
            )
    whole = values.astype(np.int64)
    if np.any(whole != values) or np.any((whole < 0) | (whole > 65535)):
        raise ValueError(f"{name}: touch: allowed: whole numbers from 0 to 65535")
    return whole.astype(np.uint16)


def _prepared(name: str, recording: Any, channels: tuple[str, str]) -> _Prepared:
    found = {column: _column(recording, column) for column in ("label", "trial", *channels)}
    missing = [column for column, values in found.items() if values is None]
    if missing:
        raise ValueError(f"{name}: no column {missing[0]!r}; a recording has {', '.join(found)}")
    label, trial, x, y = found.values()
    label, trial = _tokens(name, "label", label), _tokens(name, "trial", trial)
    contact, touch = _column(recording, "contact"), _column(recording, "touch")
    pose = _column(recording, "pose")
    columns = {**found, "contact": contact, "touch": touch, "pose": pose}
    for column, values in columns.items():
        if values is not None and values.shape != label.shape:
            raise ValueError(f"{name}: {column} has the shape {values.shape}, not {label.shape}")
    if touch is not None:
        touch = _touches(name, touch)
    changes = np.flatnonzero((label[1:] != label[:-1]) | (trial[1:] != trial[:-1])) + 1
    ends = [0, *changes.tolist(), len(label)]
    streams = [
        (str(label[a]), str(trial[a]), a, b, _pose(pose, a))
        for a, b in zip(ends, ends[1:])
        if b > a
    ]
    return _Prepared(
        name,
        streams,
        np.ascontiguousarray(np.column_stack([x, y]), dtype=np.float64),
        None if contact is None else np.ascontiguousarray(contact, dtype=np.float64),
        None if touch is None else np.ascontiguousarray(touch),
    )


def _named(recordings: Any) -> list[tuple[str, Any]]:
    if isinstance(recordings, Mapping) and "label" not in recordings:
        return [(str(name), one) for name, one in recordings.items()]
    if isinstance(recordings, (list, tuple)):
        return [(f"recording {n}", one) for n, one in enumerate(recordings, 1)]
    return [("recording", recordings)]


def _own_rate(recording: Any) -> int | None:
    """The rate that a recording knows: what ``record`` returns by its type, a table by ``attrs``."""
    metadata = getattr(getattr(recording, "dtype", None), "metadata", None)
    attributes = metadata or getattr(recording, "attrs", None) or {}
    return attributes.get("tick_hz")


def _rate(named: list[tuple[str, Any]], rate: int | None) -> int:
    """The rate of all; what contradicts it is refused."""
    said = "rate"
    for name, recording in named:
        own = _own_rate(recording)
        if own is None:
            continue
        if rate is not None and own != rate:
            raise ValueError(f"{said}: found {rate}, {name}: tick_hz has {own}")
        said, rate = f"{name}: tick_hz", own
    return USUAL_RATE if rate is None else rate


def train(
    recordings: Any,
    *,
    channels: tuple[str, str] = ("x", "y"),
    tables: str = "joint",
    bins: int | None = None,
    smooth: float | None = None,
    block: int | None = None,
    gate: float | None = None,
    gap: float | None = None,
    expect: str = "bench",
    rate: int | None = None,
) -> _core.Model:
    """Trains a model; its bytes are what a board runs.

    A recording has the columns ``label``, ``trial``, ``x``, ``y`` and, where samples are of the
    air too, ``contact`` and ``touch``, and where the surface was held in several ways, ``pose``: a
    structured array as ``record`` returns it, a dictionary of arrays, or a table of pandas. Where
    all of ``touch`` that is not 0 is the same, each rise begins a touch. Several, as a list or by their names in a dictionary, are
    each held out to tell what is to be expected of another one.

    ``tables`` are "joint" or, as the papers have it, "single"; ``bins``, ``smooth`` (bins),
    ``block`` (samples), ``gate`` (contact from which a sample counts) and ``gap`` (seconds without
    contact that end a touch) and ``expect`` ("same", "bench" or "other": how much may differ
    between training and use) are as the options of ``host-sim train``. ``rate`` is in Hz; the model
    keeps it, and a scene of another ``tick_hz`` refuses it. Arrays of ``record`` and their slices
    know theirs (``dtype.metadata["tick_hz"]``), tables may (``attrs["tick_hz"]``), and another one
    is refused; where nothing says it, it is 2000.

    Warns, by row, of values that stand apart from all others, of trials whose rows do not follow
    each other, and of trials that have samples in common.
    """
    named = _named(recordings)
    return _core.train(
        [_prepared(name, one, channels) for name, one in named],
        channels=channels,
        tables=tables,
        bins=bins,
        smooth=smooth,
        block=block,
        gate=gate,
        gap=gap,
        expect=expect,
        rate=_rate(named, rate),
    )


def classify(
    model: Any,
    recording: Any,
    *,
    channels: tuple[str, str] = ("x", "y"),
    threshold: float = 0.99,
    window: int | None = None,
) -> np.ndarray:
    """The decisions of a model on a recording, with the columns of ``decisions.csv``.

    It decides when a posterior exceeds ``threshold`` or, where ``window`` is given, after so many
    samples. The arithmetic is the board's.
    """
    data = _prepared("recording", recording, channels)
    return _core.classify(model, data, channels=channels, threshold=threshold, window=window)


def evaluate(
    model: Any,
    recording: Any,
    *,
    channels: tuple[str, str] = ("x", "y"),
    threshold: float = 0.99,
) -> Evaluation:
    """What a model is worth on a recording that it was not trained on."""
    data = _prepared("recording", recording, channels)
    found = _core.evaluate(model, data, channels=channels, threshold=threshold)
    shares = ("found", "refused", "strange", "undecided")
    return Evaluation(**{**found, **{name: Share(*found[name]) for name in shares}})
