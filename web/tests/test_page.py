"""The page in a browser, used as a person would; run by `cargo xtask page --test`.

WHISKER_PAGE names the file, WHISKER_TRACES a folder with NAME.sha256 of traces that host-sim wrote,
WHISKER_FIGURES where the figures go, WHISKER_PICTURE, if set, where the picture of the README goes.
"""

import base64
import hashlib
import json
import os
import pathlib
import time

import pytest
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

PAGE = pathlib.Path(os.environ["WHISKER_PAGE"]).resolve()
TRACES = pathlib.Path(os.environ["WHISKER_TRACES"])
FIGURES = pathlib.Path(os.environ["WHISKER_FIGURES"])
FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--window-size=1280,1250",
]


def opened(tmp_path, fragment="", *more):
    options = webdriver.ChromeOptions()
    for flag in [*FLAGS, *more, f"--user-data-dir={tmp_path / 'profile'}"]:
        options.add_argument(flag)
    downloads = tmp_path / "downloads"
    downloads.mkdir(exist_ok=True)
    options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))
    driver.get(PAGE.as_uri() + fragment)
    wait(driver, lambda d: d.execute_script("return document.documentElement.dataset.ready"))
    return driver


@pytest.fixture
def page(tmp_path):
    driver = opened(tmp_path)
    yield driver
    logged = [entry for entry in driver.get_log("browser") if entry["level"] != "INFO"]
    driver.quit()
    assert logged == []


def wait(driver, until, seconds=60):
    return WebDriverWait(driver, seconds, 0.05).until(until)


def element(page, name):
    return page.find_element(By.ID, name)


def slide(page, key, value):
    """By hand: the arrow keys of the slider."""
    slider = element(page, key)
    slider.send_keys(Keys.HOME)
    at, step = float(slider.get_attribute("min")), float(slider.get_attribute("step"))
    slider.send_keys(Keys.ARROW_RIGHT * round((value - at) / step))
    assert float(slider.get_attribute("value")) == pytest.approx(value)


def hash_of(page):
    wait(page, lambda d: len(element(d, "hash").text) == 64, 120)
    return element(page, "hash").text


def choose(page, scene):
    Select(element(page, "scene")).select_by_value(scene)


def decisions(page):
    # In one go: the list scrolls on.
    return page.execute_script(
        "return [...document.querySelectorAll('#decisions li')].map((item) => item.textContent)"
    )


def test_a_person_moves_a_slider_swaps_the_texture_and_reads_the_decision(page):
    before = hash_of(page)
    slide(page, "rcp.gain", 0.5)
    wait(page, lambda d: element(d, "hash").text != before)
    assert element(page, "rcp.gain-value").text == "0.5"
    Select(element(page, "speed")).select_by_value("4")
    for texture in ["carpet", "smooth"]:
        tile = page.find_element(By.XPATH, f"//div[@id='textures']/button[.='{texture}']")
        ActionChains(page).move_to_element(tile).perform()
        wait(page, lambda d: tile.get_attribute("aria-pressed") == "true")
        wait(page, lambda d: any(f" s: {texture} (" in said for said in decisions(d)))
    bars = page.execute_script(
        "return [...document.querySelectorAll('#bars output')].map((bar) => Number(bar.value))"
    )
    assert len(bars) == 4 and abs(sum(bars) - 1.0) < 0.01
    picture = os.environ.get("WHISKER_PICTURE")
    if picture:
        # As it is opened, half a minute on.
        ActionChains(page).move_to_element(element(page, "editor")).perform()
        element(page, "own").click()
        wait(page, lambda d: len(element(d, "hash").text) == 64, 120)
        time.sleep(3)
        page.execute_script("document.activeElement.blur(); window.scrollTo(0, 0)")
        time.sleep(1)
        pathlib.Path(picture).write_bytes(base64.b64decode(page.get_screenshot_as_base64()))


def test_hashes_are_those_of_host_sim(page):
    found = {}
    for path in sorted(TRACES.glob("*.sha256")):
        choose(page, path.stem)
        found[path.stem] = hash_of(page)
    assert len(found) >= 3
    assert found == {path.stem: path.read_text().strip() for path in TRACES.glob("*.sha256")}


def test_the_download_is_the_trace_of_the_hash_and_the_link_is_the_scene(page, tmp_path):
    choose(page, "cia")
    slide(page, "cia.gain", 0.3)
    wanted = hash_of(page)
    element(page, "download").click()
    trace = tmp_path / "downloads" / "trace.csv"
    wait(page, lambda d: trace.exists() and not list(trace.parent.glob("*.crdownload")))
    assert hashlib.sha256(trace.read_bytes()).hexdigest() == wanted
    element(page, "link").click()
    wait(page, lambda d: "#" in d.current_url)
    (tmp_path / "other").mkdir()
    other = opened(tmp_path / "other", "#" + page.current_url.split("#")[1])
    assert hash_of(other) == wanted
    other.quit()


def test_the_editor_says_what_is_wrong_and_both_sides_are_drawn(page):
    choose(page, "cia")
    editor = element(page, "editor")
    text = editor.get_attribute("value")
    editor.send_keys(Keys.CONTROL, "a")
    editor.send_keys(text.replace("tick_hz    = 2000", "tick_hz    = 20"))
    wait(page, lambda d: "tick_hz: found 20" in element(d, "problems").text)
    line = text.splitlines().index("tick_hz    = 2000") + 1
    assert f"line {line}" in element(page, "problems").text
    element(page, "download").click()
    assert "tick_hz: found 20" in element(page, "problems").text
    editor.send_keys(Keys.CONTROL, "a")
    editor.send_keys(text)
    wait(page, lambda d: element(d, "problems").text == "")


def test_sliders_that_a_scene_has_no_use_for_are_grey(page):
    def usable():
        sliders = page.find_elements(By.CSS_SELECTOR, "#sliders input")
        return {slider.get_attribute("id") for slider in sliders if slider.is_enabled()}

    every = {"whisking.gain", "whisking.frequency_hz", "rcp.gain", "cia.gain"}
    every |= {"plant.friction", "classifier.threshold"}
    assert usable() == every
    choose(page, "cia")
    assert usable() == every - {"plant.friction", "classifier.threshold"}
    choose(page, "passive")
    assert usable() == set()


def test_keys_play_and_step(page):
    body = page.find_element(By.TAG_NAME, "body")
    body.send_keys(" ")
    assert element(page, "play").text == "Play"
    body.send_keys(Keys.ARROW_RIGHT)
    body.send_keys(" ")
    assert element(page, "play").text == "Pause"


def test_with_reduced_motion_it_waits_and_a_phone_has_one_column(tmp_path):
    driver = opened(tmp_path, "", "--force-prefers-reduced-motion")
    assert element(driver, "play").text == "Play"
    metrics = {"width": 375, "height": 720, "deviceScaleFactor": 2, "mobile": True}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    dark = {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    light = driver.execute_script("return getComputedStyle(document.body).backgroundColor")
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", dark)
    now = driver.execute_script("return getComputedStyle(document.body).backgroundColor")
    assert now != light
    width = driver.execute_script("return document.documentElement.scrollWidth")
    assert width <= 375
    driver.quit()


def test_first_frame_and_frames_a_second(page):
    first = page.execute_script("return window.whisker.firstFrame")
    hash_of(page)
    before, begun = page.execute_script("return {...window.whisker}"), time.perf_counter()
    time.sleep(5)
    after, passed = page.execute_script("return {...window.whisker}"), time.perf_counter() - begun
    frames = (after["frames"] - before["frames"]) / passed
    tick_us = 1000 * (after["coreMs"] - before["coreMs"]) / (after["ticks"] - before["ticks"])
    figures = {
        "bytes": PAGE.stat().st_size,
        "first_frame_s": first / 1000,
        "frames_s": frames,
        "tick_us": tick_us,
    }
    FIGURES.write_text(json.dumps(figures))
    assert figures["bytes"] <= 1_500_000
    assert after["ticks"] > before["ticks"]
