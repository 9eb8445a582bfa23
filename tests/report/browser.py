"""A headless Chromium for tests of reports, with no network except the loopback interface.

As a script: browser.py PAGE PICTURE [WIDTH HEIGHT [JAVASCRIPT]] takes a picture of a page, after
running JavaScript in it.
"""

import json
import pathlib
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service


# Software rendering for WebGL.
GRAPHICS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


class Browser:
    def __init__(self, webgl=True):
        self.profile = tempfile.TemporaryDirectory()
        options = Options()
        options.binary_location = "/usr/bin/chromium"
        for argument in (
            "--headless=new",
            "--no-sandbox",
            *(GRAPHICS if webgl else ["--disable-3d-apis"]),
            "--disable-dev-shm-usage",
            "--hide-scrollbars",
            "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
            "--user-data-dir=" + self.profile.name,
        ):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.requests = []

    def close(self):
        self.driver.quit()
        self.profile.cleanup()

    def open(self, page, width=1440, height=1000, dark=False):
        """Opens a file, or a page of a server on the loopback interface, on a screen of that size; a
        narrow one emulates a phone."""
        served = str(page).startswith("http://")
        call = self.driver.execute_cdp_cmd
        phone = width < 600
        call(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": phone},
        )
        call("Emulation.setTouchEmulationEnabled", {"enabled": phone})
        scheme = "dark" if dark else "light"
        call(
            "Emulation.setEmulatedMedia",
            {"features": [{"name": "prefers-color-scheme", "value": scheme}]},
        )
        call("Network.enable", {})
        call(
            "Network.emulateNetworkConditions",
            {"offline": not served, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1},
        )
        self.driver.get_log("browser")
        self.driver.get(page if served else pathlib.Path(page).resolve().as_uri())
        self.settle()

    def settle(self):
        """Waits for pending observers: two frames and a short delay."""
        time.sleep(0.1)
        self.driver.execute_async_script(
            "const done = arguments[0];"
            "requestAnimationFrame(() => requestAnimationFrame(() => done()));"
        )

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def picture(self, file):
        self.driver.save_screenshot(str(file))

    def console_errors(self):
        """Messages of the console since the last page was opened."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def loaded(self):
        """Every address requested since the last call, except those that the page's policy blocked."""
        urls = {}
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            params = message["params"]
            if message["method"] == "Network.requestWillBeSent":
                urls[params["requestId"]] = params["request"]["url"]
            elif message["method"] == "Network.loadingFailed" and params.get("blockedReason") == "csp":
                urls.pop(params["requestId"], None)
        return list(urls.values())


def main():
    page, picture = sys.argv[1:3]
    size = [int(number) for number in sys.argv[3:5]]
    browser = Browser()
    try:
        browser.open(page, *size)
        if len(sys.argv) > 5:
            browser.run(sys.argv[5])
            browser.settle()
        browser.picture(picture)
    finally:
        browser.close()


if __name__ == "__main__":
    main()
