"""What a model says of public recordings, made by others, in another condition than trained in.

Usage: recordings.py HOST_SIM CWRU BIOTAC LEGO > docs/measured/recordings.md

HOST_SIM is the program, CWRU a checkout of github.com/srigas/CWRU_Bearing_NumPy (b1179d28),
BIOTAC one of github.com/dexrob/BioTac_slide_20_50 (c19638b0) and LEGO one of
github.com/sethstanton/Lego-Mindstorms-Terrain-Classifier (dd2055bf). Needs numpy and scikit-learn.
"""

import csv
import subprocess
import sys
import tempfile
from functools import reduce
from operator import add
from pathlib import Path

import numpy as np
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

HOST_SIM, CWRU, BIOTAC, LEGO = sys.argv[1:]
TEMPORARY = tempfile.TemporaryDirectory()
DIRECTORY = Path(TEMPORARY.name)
RPM = [1797, 1772, 1750, 1730]
DRIVE_END = [f"{fault}_{mils}_DE12" for fault in ("IR", "B", "OR@6") for mils in (7, 14, 21)]
FAN_END = [f"{fault}_{mils}_FE" for fault in ("IR", "B") for mils in (7, 14, 21)]
FAN_END += ["OR@3_7_FE", "OR@3_14_FE", "OR@6_7_FE"]
DIRECTIONS = ["Forward", "Left", "Right"]
SAMPLES = 2400
"""Of a trial of a bearing, 0.2 s."""
BANDS = 16


class Scale:
    """Codes of a sensor whose range is that of what it is made of, but for outliers."""

    def __init__(self, *parts):
        self.low, self.high = np.percentile(np.concatenate(parts), [0.3, 99.7])

    def codes(self, values):
        share = (values - self.low) / (self.high - self.low)
        return np.clip(np.round(16383 * share), 0, 16383).astype(int)


def write(name, trials):
    """A recording of trials (label, trial, x, y)."""
    path = DIRECTORY / f"{name}.csv"
    with path.open("w") as file:
        file.write("label,trial,x,y\n")
        for label, trial, *codes in trials:
            file.writelines(f"{label},{trial:03},{x},{y}\n" for x, y in zip(*codes))
    return path


class Found:
    """Of a model, trials, named ones, those named rightly first, names, right and stated; of each
    bound and trial whether it was right, and how sure."""

    def __init__(self, counts, bounds):
        self.counts, self.bounds = counts, bounds

    def __add__(self, other):
        bounds = [np.vstack(both) for both in zip(self.bounds, other.bounds)]
        return Found(self.counts + other.counts, bounds)


def judge(train, tests, rate, *options):
    """What is found of each recording in `tests`."""
    model = DIRECTORY / "model"
    data = [part for path in train for part in ("--data", path)]
    asked = [HOST_SIM, "train", "--quiet", *data, "--rate", rate, "--out", model]
    subprocess.run([*map(str, asked), *options], check=True, capture_output=True)
    bounds = trained_bounds(train)
    return [Found(classify(model, test), [bound(test) for bound in bounds]) for test in tests]


def read(path):
    """Of each trial its label, and codes by samples and channels."""
    trials = {}
    with path.open() as file:
        for row in csv.DictReader(file):
            trials.setdefault((row["label"], row["trial"]), []).append((row["x"], row["y"]))
    return [(label, np.array(codes, float)) for (label, _), codes in trials.items()]


def features(codes):
    """Of a whole trial, which no stream has: logarithms of its power in bands, of both channels."""
    apart = codes - codes.mean(axis=0)
    power = np.abs(np.fft.rfft(apart, axis=0)[1:]) ** 2
    edges = np.unique(np.geomspace(1, len(power), BANDS + 1).astype(int)) - 1
    bands = np.add.reduceat(power, edges[:-1], axis=0) / np.diff(edges)[:, None]
    return np.log(bands + 1).ravel()


def trained_bounds(paths):
    """A discriminant and trees that see trials as a whole: of a recording whether each was right, and
    how sure."""
    trials = [trial for path in paths for trial in read(path)]
    of = np.array([features(codes) for _, codes in trials])
    labels = np.array([label for label, _ in trials])
    discriminant = LinearDiscriminantAnalysis(solver="lsqr", shrinkage="auto")
    trees = ExtraTreesClassifier(500, random_state=0, n_jobs=2)
    judges = [make_pipeline(StandardScaler(), discriminant), trees]

    def bound(judge):
        judge.fit(of, labels)

        def said(path):
            trials = read(path)
            sure = judge.predict_proba(np.array([features(codes) for _, codes in trials]))
            named = judge.classes_[sure.argmax(axis=1)]
            right = named == np.array([label for label, _ in trials])
            return np.column_stack([right, sure.max(axis=1)])

        return said

    return [bound(judge) for judge in judges]


def classify(model, test):
    out = DIRECTORY / "decisions.csv"
    asked = [HOST_SIM, "classify", "--quiet", "--model", model, "--data", test, "--out", out]
    rule = ["--rule", "sequential", "--threshold", "0.99"]
    subprocess.run([*map(str, asked), *rule], check=True, capture_output=True)
    with test.open() as file:
        trials = {(row["label"], row["trial"]) for row in csv.DictReader(file)}
    with out.open() as file:
        names = [row for row in csv.DictReader(file) if row["decision"] != "unknown"]
    first = {}
    for row in names:
        first.setdefault((row["label"], row["trial"]), row["decision"] == row["label"])
    right = sum(row["decision"] == row["label"] for row in names)
    stated = sum(float(row["posterior"]) for row in names)
    return np.array([len(trials), len(first), sum(first.values()), len(names), right, stated])


def share(part, whole):
    return f"{100 * part / whole:.1f}" if whole else "–"


def interval(part, whole):
    """A share with its 95 % interval by Wilson."""
    if not whole:
        return "–"
    z = 1.96
    middle = (part + z**2 / 2) / (whole + z**2)
    half = z * np.sqrt(part * (whole - part) / whole + z**2 / 4) / (whole + z**2)
    low, high = (100 * (middle + sign * half) for sign in (-1, 1))
    return f"{share(part, whole)} ({low:.1f} to {high:.1f})"


def row(name, found):
    trials, named, first, names, right, stated = found.counts
    shares = [interval(named, trials), share(right, names), share(stated, names), interval(first, named)]
    for bound in found.bounds:
        surest = bound[np.argsort(-bound[:, 1], kind="stable")][: int(named)]
        shares.append(f"{share(bound[:, 0].sum(), trials)}, {share(surest[:, 0].sum(), named)}")
    print("|", " | ".join([name, str(int(trials)), *shares]), "|")


def bearings(name, faults):
    """Trained at each load by every other trial, tested at all by the others."""

    def load(rpm, fault):
        file = np.load(f"{CWRU}/Data/{rpm} RPM/{rpm}_{fault}.npz")
        return [file[channel].ravel() for channel in ("DE", "FE")]

    signals = {(rpm, fault): load(rpm, fault) for rpm in RPM for fault in faults}
    scales = [Scale(*(signals[RPM[0], fault][n] for fault in faults)) for n in (0, 1)]

    def trials(rpm, part):
        for fault in faults:
            channels = [scale.codes(of) for scale, of in zip(scales, signals[rpm, fault])]
            for n in range(part, min(map(len, channels)) // SAMPLES, 2):
                yield fault, n, *(of[n * SAMPLES : (n + 1) * SAMPLES] for of in channels)

    def renamed(fault, part):
        of_fault = (trial for trial in trials(RPM[0], part) if trial[0] == fault)
        for at, (_, *trial) in enumerate(of_fault):
            yield f"name {at % 3}", *trial

    paths = [[write(f"{rpm}-{part}", trials(rpm, part)) for part in (0, 1)] for rpm in RPM]
    apart = [[] for _ in RPM]
    for trained, (train, _) in enumerate(paths):
        for tested, found in enumerate(judge([train], [test for _, test in paths], 12_000)):
            apart[abs(trained - tested)].append(found)
    for n, found in enumerate(apart):
        row(f"bearings, {name}: {n} loads apart", reduce(add, found))
    others = [judge([train for train, of in paths if of != test], [test], 12_000)[0] for _, test in paths]
    row(f"bearings, {name}: trained at the three others", reduce(add, others))
    # Each fault of the first load: its trials, by turns, under three names.
    alike = []
    for fault in faults:
        train, test = (write(f"placebo-{part}", renamed(fault, part)) for part in (0, 1))
        alike += judge([train], [test], 12_000)
    row(f"bearings, {name}: placebo, one fault under three names", reduce(add, alike))


def slides(materials):
    """Of a slide its vibration and static pressure; a row has 22 and one of them, 10 ms."""
    for material in materials:
        for n in range(1, 51):
            path = f"{BIOTAC}/raw_data/mat{material}/mat{material}_{n}_bio.csv"
            table = np.genfromtxt(path, delimiter=",", skip_header=1, usecols=range(26))
            yield material, n, table[:, 4:], table[:, 3]


def fingertip(materials, tests, train, *options):
    """Trained on the first two seconds of the slides of these numbers; a test is a name, numbers of
    slides and the row from which on it takes as much."""
    of = list(slides(materials))
    scales = [Scale(*(slide[channel][:200].ravel() for slide in of)) for channel in (2, 3)]

    def trials(wanted, start):
        for material, n, vibration, pressure in of:
            if n in wanted and len(pressure) >= start + 200:
                x = scales[0].codes(vibration[start : start + 200].ravel())
                y = np.repeat(scales[1].codes(pressure[start : start + 200]), 22)
                yield f"material {material}", n, x, y

    trained = write("train", trials(train, 0))
    paths = [write(f"test {n}", trials(*test[1:])) for n, test in enumerate(tests)]
    span = f"{materials[0]} to {materials[-1]}"
    for (name, *_), found in zip(tests, judge([trained], paths, 2200, *options)):
        row(f"fingertip, materials {span}: {name}", found)


def grounds():
    """Trained in each direction by every other run, tested in all by the others."""

    def runs(direction, ground):
        """Rows of a hundred numbers in brackets; the runs stand one below the other."""
        path = Path(LEGO, "SecondRound", direction, f"{ground}.txt")
        rows = [line.strip("[] \n").split(",") for line in path.open() if line.startswith("[")]
        return np.array(rows, float).reshape(-1, 100, 14)

    names = ("Carpet", "Cardboard", "Stones", "Rice", "Wood")
    of = {way: {ground: runs(way, ground) for ground in names} for way in DIRECTIONS}
    # The vertical acceleration, and the rate of pitching.
    first = of[DIRECTIONS[0]].values()
    scales = [(channel, Scale(*(runs[:, :, channel].ravel() for runs in first))) for channel in (8, 9)]

    def trials(way, part):
        for ground, runs in of[way].items():
            for n in range(part, len(runs), 2):
                yield ground, n, *(scale.codes(runs[n, :, channel]) for channel, scale in scales)

    paths = [[write(f"{way}-{part}", trials(way, part)) for part in (0, 1)] for way in DIRECTIONS]
    same, another = [], []
    for trained, (train, _) in enumerate(paths):
        for tested, found in enumerate(judge([train], [test for _, test in paths], 3)):
            (same if tested == trained else another).append(found)
    others = [judge([train for train, of in paths if of != test], [test], 3)[0] for _, test in paths]
    row("robot on five grounds: the same direction", reduce(add, same))
    row("robot on five grounds: another direction", reduce(add, another))
    row("robot on five grounds: trained in the two others", reduce(add, others))


def main():
    print(
        """# Public recordings

<!-- Made by studies/recordings.py; do not edit by hand. -->

Recordings that others made, in another condition than trained in, by default settings and at a
threshold of 0.99. Bearings have nine faults; accelerations at the drive and fan end are x and y
(Case Western Reserve University, by github.com/srigas/CWRU_Bearing_NumPy). A fingertip slides over
materials; vibration is x and static pressure y, which falls as it slides (R. Gao et al., by
github.com/dexrob/BioTac_slide_20_50). A robot of Lego drives over five grounds; its vertical
acceleration is x and its rate of pitching y, three samples a second
(github.com/sethstanton/Lego-Mindstorms-Terrain-Classifier, which was not looked at before the rule
was chosen). Each trial is one touch that lasts. *Named* is of trials, *right* and *stated* of all
names, *first* of the first name of each trial, in brackets 95 % intervals. Upper bounds are a linear
discriminant and 500 trees that see each trial as a whole, by its power in bands: right of all trials,
which they must name, and of as many of their surest ones as are named. Made by `python3
studies/recordings.py HOST_SIM CWRU BIOTAC LEGO`, with the program and the three repositories.

| condition | trials | named, % | right, % | stated, % | first right, % | discriminant | trees |
|---|---|---|---|---|---|---|---|"""
    )
    bearings("drive end", DRIVE_END)
    bearings("fan end", FAN_END)
    first, second = range(1, 26), range(26, 51)
    tests = [
        ("a later series", second, 0),
        ("later and lighter", second, 200),
        ("later and lighter still", second, 400),
    ]
    for materials in (range(1, 9), range(9, 17)):
        fingertip(materials, tests, first)
    odd, even = range(1, 51, 2), range(2, 51, 2)
    for materials in (range(1, 5), range(17, 21)):
        fingertip(materials, [("the same contact", odd, 0)], even)
        same = [("the same contact, `--expect same`", odd, 0)]
        fingertip(materials, same, even, "--expect", "same")
    grounds()


main()
