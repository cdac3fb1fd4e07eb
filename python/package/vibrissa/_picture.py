"""A small picture of what whiskers feel, of the numbers of an observation alone."""

import numpy as np

WIDTH, HEIGHT = 240, 160
PAPER, HEAD, HAIR, TOUCH = (250, 250, 247), (205, 200, 192), (55, 55, 60), (200, 70, 0)
#: Length of a whisker, and where the head ends, pixels.
LENGTH, SHOULDER = 95, 14
#: Contact of the largest dot.
DEEP = 0.5

_Y, _X = np.mgrid[:HEIGHT, :WIDTH].astype(np.float64)


def _segment(picture: np.ndarray, a: tuple, b: tuple, width: float, colour: tuple) -> None:
    """A line with round ends: all pixels that are near enough."""
    along = np.subtract(b, a)
    reach = max(float(along @ along), 1e-9)
    part = np.clip(((_X - a[0]) * along[0] + (_Y - a[1]) * along[1]) / reach, 0.0, 1.0)
    away = np.hypot(_X - a[0] - part * along[0], _Y - a[1] - part * along[1])
    picture[away <= width] = colour


def picture(observation: np.ndarray, per_side: int, touching: float) -> np.ndarray:
    """From above, the head pointing up: each whisker at its angle, 90 degrees to the side and more
    to the front, and at its tip a dot that grows with contact while it touches.

    ``observation`` has angle (degrees), x, y and contact of each whisker, the left ones first.
    """
    drawn = np.full((HEIGHT, WIDTH, 3), PAPER, np.uint8)
    middle, top, bottom = WIDTH / 2, 42.0, 150.0
    _segment(drawn, (middle, top), (middle, bottom), SHOULDER, HEAD)
    for n, (angle_deg, _, _, contact) in enumerate(observation.reshape(-1, 4).astype(np.float64)):
        side, place = divmod(n, per_side)
        outwards = -1.0 if side == 0 else 1.0
        along = (place + 0.5) / per_side
        base = (middle + outwards * SHOULDER, top + along * (bottom - top))
        angle = np.radians(angle_deg)
        tip = (
            base[0] + outwards * LENGTH * np.sin(angle),
            base[1] + LENGTH * np.cos(angle),
        )
        _segment(drawn, base, tip, 1.3, HAIR)
        if contact >= touching:
            _segment(drawn, tip, tip, 3.0 + 7.0 * min(contact / DEEP, 1.0), TOUCH)
    return drawn
