"""Models from recordings, and what they are worth."""

from typing import Annotated, Any, NamedTuple, TypeVar, get_args

import numpy as np

from vibrissa import _core
from vibrissa._recordings import named, prepared, rate_of, said_rate

_Fields = TypeVar("_Fields", bound=type)


def _documented(fields: _Fields) -> _Fields:
    """Gives each field what stands beside its type as its docstring."""
    for name, kind in fields.__annotations__.items():
        getattr(fields, name).__doc__ = get_args(kind)[1]
    return fields


@_documented
class Share(NamedTuple):
    """A share, its 95 % interval, and of how many it is."""

    share: Annotated[float, "The share, 0 to 1; not a number of none."]
    low: Annotated[float, "The lower end of its 95 % interval, as `low` is everywhere."]
    high: Annotated[float, "The upper end of its 95 % interval, as `high` is everywhere."]
    of: Annotated[int, "Of how many it is."]


@_documented
class Evaluation(NamedTuple):
    """What a model is worth on recordings that it was not trained on.

    Hits, samples and calibration are of decisions that named a class, on labels that the model
    knows; ``strange`` is of labels that it does not know.
    """

    hits: Annotated[
        float | None,
        "Share of right decisions, mean over the classes presented but those of `left_out`.",
    ]
    samples: Annotated[float, "Mean samples of contact of a decision."]
    samples_error: Annotated[float, "Standard error of `samples`, as if decisions were independent."]
    stated: Annotated[float, "Mean posterior of the decisions."]
    found: Annotated[Share, "Share of decisions that were right: what `stated` should be."]
    refused: Annotated[Share, 'Share of decisions that said "unknown".']
    strange: Annotated[Share, "The same share on labels that the model does not know."]
    undecided: Annotated[Share, "Share of streams in which no class was named."]
    calibration: Annotated[
        np.ndarray,
        "A row for each range of the stated posterior, `stated_from` to `stated_to`: the mean "
        "`stated`, the share `found` right, its 95 % interval `low` to `high`, and `decisions`.",
    ]
    classes: Annotated[
        np.ndarray,
        "A row for each class that was presented: `name`, streams `presented`, `decisions` that "
        "named a class, their share of `hits` and mean `samples`, and the shares `refused` and "
        "`undecided`.",
    ]
    confusion: Annotated[
        np.ndarray,
        "How many decisions on a label (row) named which class (column), both in the order of "
        "`labels`.",
    ]
    labels: Annotated[
        list[str],
        "Rows and columns of `confusion`: the model's classes, then presented labels that it does "
        'not know, and "unknown".',
    ]
    left_out: Annotated[
        list[str],
        "The classes presented of which no decision named a class: they have no share of hits.",
    ]


@_documented
class Why(NamedTuple):
    """Why a decision names no class."""

    reason: Annotated[str | None, '"unknown", "pose" or "between"; None where a class is named.']
    among: Annotated[
        tuple[str, str] | None,
        'The two classes of "between", the likelier one first; otherwise None.',
    ]


def why(decision: Any) -> Why:
    """Why a decision names no class: of a row of ``classify`` or of ``Sim.decisions``."""
    leader, is_between, rival = str(decision["among"]).partition("|")
    return Why(str(decision["reason"]) or None, (leader, rival) if is_between else None)


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

    A recording is a path, as of a file that ``read`` reads, or has the columns ``label``, ``trial``, ``x``, ``y`` and, where samples are of the
    air too, ``contact`` and ``touch``, where the surface was held in several ways, ``pose``, and where
    it is known how, ``tilt_deg`` and ``depth_deg``, which the model then learns to estimate: a
    structured array as ``record`` returns it, a dictionary of arrays, or a table of pandas. Where
    all of ``touch`` that is not 0 is the same, each rise begins a touch. Several, as a list or by
    their names in a dictionary, are each held out to tell what is to be expected of another one.

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
    given = named(recordings, channels)
    return _core.train(
        [prepared(name, one, channels) for name, one in given],
        channels=channels,
        tables=tables,
        bins=bins,
        smooth=smooth,
        block=block,
        gate=gate,
        gap=gap,
        expect=expect,
        rate=rate_of(given, rate),
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
    model, recording = _model_first(model, recording)
    all_of_them = named([recording], channels)
    (data,) = (prepared(*given, channels) for given in all_of_them)
    rate = said_rate(all_of_them)
    return _core.classify(
        model, data, channels=channels, threshold=threshold, window=window, rate=rate
    )


def evaluate(
    model: Any,
    recordings: Any,
    *,
    channels: tuple[str, str] = ("x", "y"),
    threshold: float = 0.99,
) -> Evaluation:
    """What a model is worth on recordings that it was not trained on: one or several, as ``train``
    takes them. Recordings and model may also stand in the other order."""
    model, recordings = _model_first(model, recordings)
    given = named(recordings, channels)
    data = [prepared(name, one, channels) for name, one in given]
    rate = said_rate(given)
    found = _core.evaluate(model, data, channels=channels, threshold=threshold, rate=rate)
    for name in ("found", "refused", "strange", "undecided"):
        found[name] = Share(*found[name])
    names = ("stated_from", "stated_to", "stated", "found", "low", "high")
    columns = [*((name, "f8") for name in names), ("decisions", "i8")]
    bins = [(*stated, *share) for *stated, share in found["calibration"]]
    found["calibration"] = np.array(bins, columns)
    rows = [(*counts, *shares) for counts, shares in found["classes"]]
    width = max((len(row[0]) for row in rows), default=1)
    columns = [("name", f"U{width + width % 2}"), ("presented", "i8"), ("decisions", "i8")]
    names = ("hits", "samples", "refused", "undecided")
    found["classes"] = np.array(rows, [*columns, *((name, "f8") for name in names)])
    labels = found["labels"] = list(dict.fromkeys(found["labels"]))
    found["confusion"] = np.zeros((len(labels), len(labels)), np.int64)
    for label, decision in found.pop("decided"):
        found["confusion"][labels.index(label), labels.index(decision)] += 1
    return Evaluation(**found)


def _model_first(model: Any, recordings: Any) -> tuple[Any, Any]:
    """Both, in the order in which they are meant: a model cannot be taken for a recording."""
    if _core.is_model(recordings) and not _core.is_model(model):
        return recordings, model
    return model, recordings
