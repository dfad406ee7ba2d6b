"""What all tests share."""
import os

import pytest


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):
    """Packings are made once a session, and the user's own cache stays as it is."""
    os.environ["ROCKWEAR_CACHE"] = str(tmp_path_factory.mktemp("cache"))
