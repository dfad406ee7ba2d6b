"""What all tests share."""
import os

import pytest

LONGEST = ("test_tooth_cycles", "test_steady_cut", "test_cutting_3d", "test_temperatures", "test_laboratory",
           "test_combinations", "test_facets", "test_campaign_worn", "test_arc_window", "test_absorbing",
           "test_two_disc", "test_hard_cases")
"""Modules that a worker is to begin first, so that none is left to one of them at the end."""


def pytest_collection_modifyitems(items):
    """Longest modules first, the others in their order."""
    items.sort(key=lambda item: next((k for k, name in enumerate(LONGEST) if name in item.nodeid), len(LONGEST)))


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):
    """Packings are made once a session, by one worker for all, and the user's own cache stays as it is."""
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent
    os.environ["ROCKWEAR_CACHE"] = str(folder / "cache")


@pytest.fixture(scope="session", autouse=True)
def bytecode():
    """Modules are compiled once, and not by each of many hundred processes: 0.3 s of each."""
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
