"""The bending whisker against MuJoCo: error against time of the same push.

    cargo build --release -p physics --example push
    OPENBLAS_NUM_THREADS=1 python tests/truth/against_mujoco.py target/release/examples/push

writes docs/measured/bending.md and bending.csv in ten minutes (Linux; numpy, scipy, MuJoCo 4).

TRUTH. MuJoCo's own chain of 60 links, a step of 2 us, exact damping: what favours MuJoCo. `rod.py`
is a third program that says how well it holds.
"""
import csv
import os
import subprocess
import sys
from itertools import product
from multiprocessing import get_context
from pathlib import Path

import elastica
import mujoco
import numpy as np
import rod
from chain import model_of, run
from rod import LENGTH, PUSH_S

MOTIONS = {"8°": (8, True), "20°": (20, True), "30°": (30, True), "free": (20, False)}
LINKS = (4, 8, 12, 16, 24, 40)
STEPS = (1e-3, 5e-4, 2.5e-4, 1e-4)
DAMPED_BETTER = (2.5e-4, 1e-4, 5e-5)
MUJOCO = ("MuJoCo, planar", "MuJoCo, two hinges")
INTEGRATORS = ("discrete", "implicitfast")
TICKS = ((1000, 0), (2000, 0), (4000, 0), (8000, 0), (2000, 1), (2000, 2))
FINEST = (64000, 5)
STATIC = (2, 3, 5, 8, 10, 15, 20, 25, 30, 45, 60)
# Of four linear modes that touch with the tip alone, which ours had before, %.
BEFORE_PERCENT = {5: 4.6, 8: 4.9, 10: -3.9, 15: -22, 20: -36, 30: -52}
PAGE = Path(sys.argv[2] if len(sys.argv) > 2 else
            Path(__file__).parents[2] / "docs/measured/bending.md")


def ours(push_deg, push_s, tick_hz, finer, contact, repeats):
    command = [sys.argv[1], push_deg, push_s, tick_hz, finer, "plate" if contact else "free", repeats]
    lines = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                           check=True).stdout.split()
    moments = np.array([float(line.split(",")[1]) for line in lines[1:-1]])
    every = max(1, round(tick_hz / 2000))
    return moments[every - 1::every], float(lines[-1].split(",")[1])


def error(moments, true):
    """Root mean square over the true peak; infinite for a run that breaks off or explodes."""
    every = len(true) // max(1, len(moments))
    if len(moments) * every != len(true):
        return np.inf
    wrong = np.sqrt(np.mean((moments - true[every - 1::every]) ** 2)) / np.max(np.abs(true))
    return wrong if wrong < 1 else np.inf


def truth(links_motion):
    links, motion = links_motion
    push, contact = MOTIONS[motion]
    return run(model_of(links, 1, 2e-6, "Euler", contact, links), push)[0]


def rods(_):
    pushes, contacts = zip(*MOTIONS.values())
    return rod.reference(pushes, contacts)


def measured(motion, true):
    """Rows of one motion, ours between those of MuJoCo: model, size, step, error, time."""
    push, contact = MOTIONS[motion]
    best, rows = {}, []

    def measure_ours():
        for tick_hz, finer in TICKS:
            moments, seconds = ours(push, PUSH_S, tick_hz, finer, contact, 100)
            old = best.get((tick_hz, finer), (0, np.inf))[1]
            best[tick_hz, finer] = error(moments, true), min(seconds, old)

    for links in LINKS:
        measure_ours()
        for damped, steps in ((1, STEPS), (4, DAMPED_BETTER if 8 < links < 40 else ())):
            for axes, integrator, step in product((1, 2), INTEGRATORS, steps):
                model = model_of(links, axes, step, integrator, contact, damped)
                moments, seconds = run(model, push)
                if seconds < 0.5:
                    seconds = min(seconds, *(run(model, push)[1] for _ in range(2)))
                size = f"{links} links, {integrator}, {damped} mode{'s' * (damped > 1)}"
                rows.append((MUJOCO[axes - 1], size, step, error(moments, true), seconds))
    own = [("ours", f"{hz} Hz" + (f", parts {2**finer} times finer" if finer else ""), 1 / hz,
            wrong, seconds) for (hz, finer), (wrong, seconds) in best.items()]
    return own + rows


def fastest(rows, name, wrong):
    return min((row for row in rows if row[0] == name and row[3] <= wrong),
               key=lambda row: row[4], default=None)


def table(head, rows):
    lines = [f"| {' | '.join(row)} |" for row in (head, *rows)]
    lines.insert(1, "|---" * len(head) + "|")
    return "\n".join(lines) + "\n"


def number(value):
    return f"{value:.1e}".replace("e-0", "e-")


def times(ratio):
    return "none is" if ratio == np.inf else f"{ratio:.0f}" if ratio >= 10 else f"{ratio:.1f}"


def of_ours(rows):
    """Each row of ours beside the fastest of MuJoCo that is no worse."""
    for row in (row for row in rows if row[0] == "ours"):
        cells = [row[1], number(row[3]), number(row[4])]
        for name in MUJOCO:
            other = fastest(rows, name, row[3])
            cells.append("none is" if other is None else
                         f"{number(other[4])}: **{times(other[4] / row[4])}** "
                         f"({other[1]}, {1e3 * other[2]:g} ms, rms {number(other[3])})")
        yield cells


def of_mujoco(rows):
    """Rows of MuJoCo than which no faster one is better."""
    for name in MUJOCO:
        for row in sorted((row for row in rows if row[0] == name), key=lambda row: -row[3]):
            if row[3] < np.inf and fastest(rows, name, row[3]) == row:
                own = fastest(rows, "ours", row[3])
                yield [name, row[1], f"{1e3 * row[2]:g} ms", number(row[3]), number(row[4]),
                       "ours is not so exact" if own is None else times(row[4] / own[4])]


def statics():
    for row in elastica.Press().follow(STATIC):
        push, true = row["push_deg"], row["moment_x_nm"]
        moments = ours(push, 20, 2000, 0, True, 1)[0]
        wrong = 100 * (moments[len(moments) // 2 - 1] / true - 1)
        old = BEFORE_PERCENT.get(push)
        yield [f"{push:g}°", f"{row['contact_m'] / LENGTH:.3f}", f"{true:.3e}", f"{wrong:+.2f} %",
               "" if old is None else f"{old:+g} %"]


def goals(all_rows):
    """Of ours at 2 kHz with the usual parts."""
    for motion in ("8°", "20°", "30°"):
        rows = all_rows[motion]
        own = next(row for row in rows if row[:2] == ("ours", "2000 Hz"))
        other = fastest(rows, "MuJoCo, two hinges", own[3])
        ratio = np.inf if other is None else other[4] / own[4]
        for what, value, goal, met in (
                ("seconds a simulated second", number(own[4]), "2e-3", own[4] <= 2e-3),
                ("rms of the base moment", number(own[3]), "3e-3", own[3] <= 3e-3),
                ("MuJoCo with two hinges that is no worse, times as long", times(ratio), "100", ratio >= 100),
                ("24 whiskers on two cores, simulated seconds a second", f"{2 / 24 / own[4]:.0f}",
                 "10", 2 / 24 / own[4] >= 10)):
            yield [motion, what, value, goal, "met" if met else "**missed**"]


def page(all_rows, truths, coarser, third):
    finest = {motion: ours(*((push, PUSH_S) + FINEST), contact, 1)[0]
              for motion, (push, contact) in MOTIONS.items()}
    agree = [[motion, number(error(coarser[motion], truths[motion])),
              number(error(third[motion], truths[motion])),
              number(error(finest[motion], truths[motion]))] for motion in MOTIONS]
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                if line.startswith("model name")), "unknown")
    parts = [f"""# Bending: error against time, ours and MuJoCo's

<!-- Generated by `tests/truth/against_mujoco.py`; do not edit by hand. -->

BIOTACT's middle whisker is swung from 2° before a hard, frictionless plate of 30° slant to 8, 20 or
30° beyond first touch and back, once, as a cosine of 2 Hz; *free* is 20° without the plate. Errors
are those of the base moment, root mean square over the peak, every 0.5 ms or tick. Times are
seconds of one core a simulated second of the loop of steps alone, the least of repeats, all in one
run: MuJoCo {mujoco.__version__}, numpy {np.__version__}, {cpu}.

    cargo build --release -p physics --example push
    OPENBLAS_NUM_THREADS=1 python tests/truth/against_mujoco.py target/release/examples/push

How the chains of hinges are made, damped and set is said in `tests/truth/chain.py`; *1 mode* and *4
modes* have the right damping in so many. MuJoCo's integrator *discrete*, since version 3.13, has springs
and contact implicit and holds steps of 1 ms. Every row is in `bending.csv`.

## Goals

Ours at 2 kHz, with the parts of a tick that it takes by itself.
""",
        table(["motion", "what", "found", "goal", ""], goals(all_rows)),
        """
## Where the truth is from

MuJoCo's chain of 60 links, one hinge a link, a step of 2 µs, damping exact in every mode. It favours
MuJoCo. What it is worth: the same with 40 links; an exact rod of 16 modes, another program
(`tests/truth/rod.py`). Ours at 64 kHz in 32 parts a tick shows what no tick mends. An error that is
not well above the first two columns is not known better than that.
""",
        table(["motion", "40 links", "rod", "ours, finest"], agree)]
    for motion, rows in all_rows.items():
        parts += [f"\n## {motion}\n\nOurs, and the fastest of MuJoCo that is no worse: time, settings, "
                  "rms, and in bold how many times as long it takes.\n",
                  table(["ours", "rms", "s/s", "planar", "two hinges a link"], of_ours(rows)),
                  "\nMuJoCo's rows than which no faster one is better, and how many times as long as "
                  "the fastest of ours that is no worse.\n",
                  table(["model", "links", "step", "rms", "s/s", "times ours"], of_mujoco(rows))]
    parts += ["""
## At which push which model ends

Pushed slowly (20 s), at 2 kHz; the truth is an exact elastica (`tests/truth/elastica.py`). *Before*:
four linear modes that touch with the tip alone, as published then. From 60° on nothing but the
plane of the push keeps the shaft from falling sideways.
""", table(["push", "touches at, of the length", "base moment, N m", "ours", "before"], statics())]
    PAGE.write_text("\n".join(parts))
    with open(PAGE.with_suffix(".csv"), "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["motion", "model", "size", "step_s", "rms", "seconds"])
        for motion, rows in all_rows.items():
            for *what, wrong, seconds in rows:
                out.writerow([motion, *what, f"{wrong:.3g}", f"{seconds:.3g}"])


def main():
    jobs = [(links, motion) for motion in MOTIONS for links in (60, 40)]
    with get_context("fork").Pool() as pool:
        third = pool.map_async(rods, [0])
        found = dict(zip(jobs, pool.map(truth, jobs, chunksize=1)))
        third = dict(zip(MOTIONS, third.get()[0]))
    truths, coarser = ({motion: found[links, motion] for motion in MOTIONS} for links in (60, 40))
    # Only one core for all that is timed.
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    all_rows = {motion: measured(motion, truths[motion]) for motion in MOTIONS}
    page(all_rows, truths, coarser, third)


if __name__ == "__main__":
    mujoco.set_mju_user_warning(lambda text: None)  # What explodes is seen in its error.
    main()
