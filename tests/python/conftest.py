import pathlib
import signal

import pytest

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios"

# A shell ignores SIGINT in commands that run in its background, and processes inherit this setting.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def scenarios():
    return SCENARIOS
