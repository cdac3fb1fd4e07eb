"""H50 by scipy.signal: the rows of butterworth.csv and butterworth_step.csv.

Run beside this file: python3 butter.py
butterworth.csv: coefficients of butter(3, 50) at several tick rates.
butterworth_step.csv: its first 200 outputs to a unit step at 2 kHz.
"""

import numpy as np
from scipy.signal import butter, lfilter

with open("butterworth.csv", "w") as out:
    out.write("tick_hz,b0,b1,b2,b3,a1,a2,a3\n")
    for tick_hz in (250, 500, 1000, 2000, 4000, 8000):
        b, a = butter(3, 50, fs=tick_hz)
        out.write(",".join([str(tick_hz), *(repr(float(c)) for c in [*b, *a[1:]])]) + "\n")

b, a = butter(3, 50, fs=2000)
with open("butterworth_step.csv", "w") as out:
    out.write("output\n")
    for y in lfilter(b, a, np.ones(200)):
        out.write(f"{float(y)!r}\n")
