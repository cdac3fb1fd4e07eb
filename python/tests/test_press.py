"""A pressed whisker: the numbers of ``host-sim press``."""

import numpy as np
import pytest

import vibrissa

MIDDLE = {
    "length_m": 0.112,
    "hub_m": 2.282e-3,
    "taper": 8.0,
    "youngs_pa": 1.394e9,
    "follicle_nm_rad": 0.2,
}


def test_a_row_a_push():
    rows = vibrissa.press("biotact-middle", push_deg=[20, 0, 5])
    assert list(rows.dtype.names) == list(vibrissa.columns("press"))
    assert list(rows["push_deg"]) == [20, 0, 5]
    # As an independent solution has it.
    assert rows["moment_x_nm"] == pytest.approx([2.62846e-3, 0, 4.77759e-4], rel=1e-5)
    assert rows["normal_n"] == pytest.approx([3.30995e-2, 0, 4.96280e-3], rel=1e-5)
    assert rows["contact_m"] == pytest.approx([0.100228, 0.112, 0.112], rel=1e-5)
    assert rows["place_m"][0] < rows["place_m"][2] < 0
    assert not rows["moment_y_nm"].any() and not rows["friction_n"].any()


def test_a_shaft_may_be_its_numbers_and_the_plate_be_tilted_and_rough():
    how = {"push_deg": np.array([5.0, 25.0]), "slant_deg": 40, "tilt_deg": 20, "friction": 0.2}
    named, own = (vibrissa.press(shaft, **how) for shaft in ("biotact-middle", MIDDLE))
    for name in named.dtype.names:
        assert own[name] == pytest.approx(named[name], rel=1e-8)
    assert np.all(named["moment_y_nm"] > 0)
    assert named["friction_n"] == pytest.approx(0.2 * named["normal_n"])
    assert vibrissa.press(MIDDLE, push_deg=5.0).shape == (1,)


@pytest.mark.parametrize(
    ("shaft", "how", "message"),
    [
        ({**MIDDLE, "length_m": -1}, {}, "length_m: found -1, allowed: 0.001 to 1"),
        ({**MIDDLE, "width_m": 1}, {}, 'shaft: found "width_m", allowed: length_m'),
        ({"length_m": 0.1}, {}, "hub_m: found none"),
        ("own", {}, "shaft: found .*biotact-middle"),
        ("xy-table", {"slant_deg": -5}, "slant_deg: found -5, allowed: 0 to 80"),
        ("biotact-middle", {"slant_deg": 60, "push_deg": 60}, "push_deg: .*0 to 50.31"),
    ],
)
def test_what_is_wrong_is_said(shaft, how, message):
    with pytest.raises(ValueError, match=message):
        vibrissa.press(shaft, **{"push_deg": 5, **how})
