# Writes tests/reference/spectrum.csv: magnitudes by NumPy of a block of eight
# samples in a transform of twelve points.
#
#     python3 fit/spectrum.py > tests/reference/spectrum.csv
import numpy

x = [1, -2, 3.5, 0, 4, -1, 0.25, 7]
values = "\n".join(repr(float(v)) for v in numpy.abs(numpy.fft.rfft(x, 12)))
print(values)
