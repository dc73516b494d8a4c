"""What the tests share."""

from pathlib import Path

import pytest

import galpix

PROJECT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def vectors(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the golden vectors of seed 0."""
    folder = tmp_path_factory.mktemp("vectors")
    galpix.write_vectors(folder)
    return folder


@pytest.fixture(scope="session")
def hashes() -> dict:
    """The hashes that the project keeps, by name."""
    lines = (PROJECT / "tests/golden/hashes.txt").read_text().splitlines()
    return {name: digest for digest, name in (line.split(maxsplit=1) for line in lines)}
