"""A browser with the page, for the tests beside this; run by `cargo xtask page --test`.

WHISKER_PAGE names the file, WHISKER_TRACES a folder with NAME.sha256 of traces that host-sim wrote,
WHISKER_FIGURES where the figures go, WHISKER_PICTURE, if set, where the picture of the README goes.
"""

import os
import pathlib

import pytest
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

PAGE = pathlib.Path(os.environ["WHISKER_PAGE"]).resolve()
FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--window-size=1280,1250",
]


def pytest_configure(config):
    config.addinivalue_line("markers", "alone: counts frames, so that no other browser may run")


class Browser:
    """One Chromium, and what a person does in it."""

    def __init__(self, folder, *flags):
        options = webdriver.ChromeOptions()
        for flag in [*FLAGS, *flags, f"--user-data-dir={folder / 'profile'}"]:
            options.add_argument(flag)
        self.downloads = folder / "downloads"
        self.downloads.mkdir(parents=True)
        preferences = {"download.default_directory": str(self.downloads)}
        options.add_experimental_option("prefs", preferences)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))
        self.js, self.cdp = self.driver.execute_script, self.driver.execute_cdp_cmd

    def open(self, fragment=""):
        self.driver.get("about:blank")
        self.driver.get(PAGE.as_uri() + fragment)
        self.wait(lambda: self.js("return document.documentElement.dataset.ready"))
        return self

    def phone(self, width, height, ratio=2):
        metrics = {"width": width, "height": height, "deviceScaleFactor": ratio, "mobile": True}
        self.cdp("Emulation.setDeviceMetricsOverride", metrics)
        return self

    def wait(self, until, seconds=60):
        return WebDriverWait(self.driver, seconds, 0.05).until(lambda _: until())

    def element(self, name):
        return self.driver.find_element(By.ID, name)

    def text(self, name):
        return self.element(name).text

    def tile(self, surface):
        return self.driver.find_element(By.CSS_SELECTOR, f"[data-surface='{surface}']")

    def experts(self):
        if not self.js("return document.getElementById('experts').open"):
            self.driver.find_element(By.CSS_SELECTOR, "#experts summary").click()

    def choose(self, scene):
        self.experts()
        Select(self.element("scene")).select_by_value(scene)

    def pick(self, menu, value):
        Select(self.element(menu)).select_by_value(value)

    def hash(self):
        self.experts()
        self.wait(lambda: len(self.text("hash")) == 64, 120)
        return self.text("hash")

    def decisions(self):
        # In one go: the list scrolls on.
        return self.js(
            "return [...document.querySelectorAll('#decisions li')].map((item) => item.textContent)"
        )

    def frames_a_second(self, seconds=2):
        """Of three tries the best: another program may take the processor for a moment."""
        count = """
            const done = arguments[1], {frames} = window.whisker, begun = performance.now();
            setTimeout(() => done(1000 * (window.whisker.frames - frames)
                / (performance.now() - begun)), 1000 * arguments[0]);"""
        return max(self.driver.execute_async_script(count, seconds) for _ in range(3))

    def complaints(self):
        """What it logged since the last call, but for what it thinks of tests that read pictures."""
        entries = self.driver.get_log("browser")
        return [e for e in entries if e["level"] != "INFO" and e["source"] != "rendering"]


@pytest.fixture
def browser(tmp_path):
    """Makes browsers, and closes them; none may have complained."""
    opened = []

    def make(*flags):
        opened.append(Browser(tmp_path / str(len(opened)), *flags))
        return opened[-1]

    yield make
    complaints = [line for each in opened for line in each.complaints()]
    for each in opened:
        each.driver.quit()
    assert complaints == []


@pytest.fixture
def page(browser):
    return browser().open()
