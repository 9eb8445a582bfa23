"""Shared by the tests of pages: calls of the program, its results as inputs, and a browser.

A test file is started as FILE PROGRAM PICTURES [inputs | I/N] [unittest's options]. `inputs` makes the results that the
tests of this file open and keeps them beside the pictures; I/N runs the Ith of N parts of the tests on a copy of them.
Without either, the tests make their own inputs.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from browser import Browser

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
PICTURES = pathlib.Path(sys.argv[2]).resolve()
WHAT = sys.argv[3] if len(sys.argv) > 3 and re.fullmatch(r"inputs|\d+/\d+", sys.argv[3]) else None
INPUTS = PICTURES.with_name(PICTURES.name + "_inputs") / pathlib.Path(sys.argv[0]).stem


def run_program(folder, *arguments, code=0):
    """Runs the program in a folder and returns what it prints. Fails on another exit code; None allows all."""
    done = subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if code is not None and done.returncode != code:
        raise RuntimeError(f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def has_video():
    return "video off" not in run_program(".", "--version")


class PageTest(unittest.TestCase):
    """Tests of pages in `root`, a folder of this class alone."""

    webgl = True

    @classmethod
    def make_inputs(cls):
        """Writes into `root` what the tests open."""
        raise NotImplementedError

    @classmethod
    def setUpClass(cls):
        PICTURES.mkdir(parents=True, exist_ok=True)
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name) / "root"
        if WHAT:
            shutil.copytree(INPUTS, cls.root)
        else:
            cls.root.mkdir()
            cls.make_inputs()
        cls.browser = Browser(webgl=cls.webgl)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    @classmethod
    def trackbed(cls, *arguments, code=0):
        return run_program(cls.root, *arguments, code=code)

    def open(self, page, **screen):
        self.browser.open(self.root / page, **screen)

    def tearDown(self):
        self.assertEqual(self.browser.console_errors(), [])


class PartLoader(unittest.TestLoader):
    """Keeps every Nth test of each class, beginning with the Ith."""

    def __init__(self, part):
        super().__init__()
        self.first, self.step = (int(number) for number in part.split("/"))

    def getTestCaseNames(self, testCaseClass):
        return super().getTestCaseNames(testCaseClass)[self.first - 1 :: self.step]


def run_tests(test_class):
    """Makes the inputs or runs the tests, as the command line requests."""
    if WHAT == "inputs":
        shutil.rmtree(INPUTS, ignore_errors=True)
        INPUTS.mkdir(parents=True)
        test_class.root = INPUTS
        test_class.make_inputs()
        return
    unittest.main(
        argv=[sys.argv[0], *sys.argv[4 if WHAT else 3 :]],
        testLoader=PartLoader(WHAT) if WHAT else unittest.defaultTestLoader,
        verbosity=2,
    )
