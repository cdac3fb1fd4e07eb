"""The page on an emulated phone, and for everybody: axe, sizes to press, colour schemes."""

import importlib.util
import pathlib

import pytest

AXE = pathlib.Path(importlib.util.find_spec("axe_playwright_python").origin).with_name("axe.min.js")
TO_PRESS = "button, select, summary, input, textarea, a"


def dark(page, scheme):
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    page.cdp("Emulation.setEmulatedMedia", {"features": features})


@pytest.mark.parametrize("width", [360, 1280])
def test_axe_finds_nothing_and_everything_can_be_pressed(browser, width):
    page = browser()
    if width < 1000:
        page.phone(width, 740)
    page.open()
    page.experts()
    page.js(AXE.read_text())
    for scene in ["whisker", "both", "cia", "unknown"]:
        page.choose(scene)
        for scheme in ["light", "dark"]:
            dark(page, scheme)
            found = page.driver.execute_async_script("""
                const done = arguments[0];
                axe.run().then(({violations}) => done(violations.map(({id, nodes}) =>
                    `${id}: ${nodes.map(({target}) => target).join()}`)));""")
            assert found == [], (scene, scheme)
        small = page.js("""
            return [...document.querySelectorAll(arguments[0])].filter((each) => {
                const {width, height} = each.getBoundingClientRect();
                return each.checkVisibility() && (width < 44 || height < 44);
            }).map((each) => each.outerHTML);""", TO_PRESS)
        assert small == [], scene


@pytest.mark.parametrize("width, height", [(360, 640), (412, 915)])
def test_surfaces_beliefs_and_decisions_are_on_one_screen(browser, width, height):
    page = browser().phone(width, height).open()
    page.wait(lambda: len(page.decisions()) >= 3)
    assert page.js("return document.documentElement.scrollWidth") <= width
    page.js("document.getElementById('choose').scrollIntoView()")
    for name in ["textures", "bars", "decisions"]:
        box = page.js("return document.getElementById(arguments[0]).getBoundingClientRect()", name)
        assert 0 <= box["top"] and box["bottom"] <= height, name
    page.js("scrollTo(0, 0)")
    for name in ["whisker", "verdict", "textures"]:
        box = page.js("return document.getElementById(arguments[0]).getBoundingClientRect()", name)
        assert 0 <= box["top"] and box["bottom"] <= height, name
    # Whole lines alone.
    cut = page.js("""
        const list = document.getElementById('decisions').getBoundingClientRect();
        return [...document.querySelectorAll('#decisions li')].filter((item) =>
            item.checkVisibility() && item.getBoundingClientRect().bottom > list.bottom + 0.5).length""")
    assert cut == 0


def test_with_reduced_motion_it_waits(browser):
    page = browser("--force-prefers-reduced-motion").open()
    assert page.text("play") == "Play" and page.text("said") == "press Play"
    colour = "return getComputedStyle(document.body).backgroundColor"
    light = page.js(colour)
    dark(page, "dark")
    assert page.js(colour) != light


def ink(page, canvas):
    """Rows of a canvas in which something is drawn, from the first to the last, as shares."""
    return page.js("""
        const {width, height} = arguments[0], pen = arguments[0].getContext('2d');
        const {data} = pen.getImageData(0, 0, width, height);
        const rows = new Set(), columns = new Set();
        for (let n = 3; n < data.length; n += 4) {
            if (data[n] > 0) { rows.add(Math.floor(n / 4 / width)); columns.add(n / 4 % width | 0); }
        }
        return [Math.min(...rows) / height, Math.max(...rows) / height,
                Math.min(...columns) / width, Math.max(...columns) / width];""", page.element(canvas))


@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_of_the_picture_leaves_it(browser, width):
    page = browser().phone(width, 740, 1).open()
    page.pick("speed", "4")
    for scene in ["whisker", "both", "cia", "biphasic", "free"]:
        page.choose(scene)
        page.js("scrollTo(0, 0)")
        until = page.js("return window.whisker.ticks") + 6000
        page.wait(lambda until=until: page.js("return window.whisker.ticks") > until)
        top, bottom, left, right = ink(page, "whisker")
        assert 0 < top and bottom < 0.999 and 0 < left and right < 0.999, scene


def test_curves_stay_in_their_panels_at_ten_strokes_a_second(browser):
    page = browser().phone(412, 915, 1).open()
    page.js("""
        const slider = document.getElementById('whisking.frequency_hz');
        slider.value = 10;
        slider.oninput();
        document.getElementById('curves').scrollIntoView();""")
    page.wait(lambda: page.js("return window.whisker.ticks") > 6000)
    page.element("play").click()
    # Titles stand between the panels; where they end, there is nothing down to the next panel.
    rows = page.js("""
        const canvas = document.getElementById('strips'), pen = canvas.getContext('2d');
        const height = canvas.height, rows = [];
        const {data} = pen.getImageData(canvas.width * 0.8, 0, canvas.width * 0.15, height);
        const width = data.length / 4 / height;
        for (let row = 0; row < height; row++) {
            rows.push(data.subarray(4 * row * width, 4 * (row + 1) * width).some((value) => value > 0));
        }
        return rows;""")
    gaps = [n for n in range(1, len(rows)) if rows[n - 1] and not rows[n]]
    assert len(gaps) >= 3
